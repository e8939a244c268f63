#pragma once

#include <map>
#include <string>

namespace pendular::blind {

/// The scripts of blind/yade, by the names of their files.
const std::map<std::string, std::string>& yade_scripts();

}  // namespace pendular::blind
