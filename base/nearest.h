#pragma once

#include <string>
#include <vector>

namespace pendular {

/// The name closest to what was typed, by Levenshtein's edit distance. At least one name.
const std::string& nearest_name(const std::string& typed, const std::vector<std::string>& names);

}  // namespace pendular
