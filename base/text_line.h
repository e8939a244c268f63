#pragma once

#include <string>
#include <string_view>

namespace pendular {

/// Text of any origin as one line of UTF-8: control characters (of bytes and of Unicode, also those that turn
/// the direction of writing) and bytes that are no UTF-8 become '?', line breaks spaces.
std::string printable(std::string_view text);

/// The same for a terminal: of more than 600 bytes the middle is left out.
std::string text_line(std::string_view text);

}  // namespace pendular
