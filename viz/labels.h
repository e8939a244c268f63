#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace pendular::viz {

/// Number of characters of a UTF-8 text.
std::size_t characters(const std::string& text);

/// The text, its middle replaced by "..." where it has more characters than `most`.
std::string shortened(const std::string& text, std::size_t most);

/// The text in lines of at most `most` characters, broken between words where it can be; of more than
/// `lines` lines the last one ends with "...".
std::string wrapped(const std::string& text, std::size_t most, std::size_t lines);

/// Width that the longest label takes in a type of this size: an upper estimate from the number of
/// characters, in the unit of `size`.
double label_width(std::span<const std::string> labels, double size);

}  // namespace pendular::viz
