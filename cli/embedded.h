#pragma once

#include <string_view>

namespace pendular::cli {

/// samples/demo.toml, as it was when the program was built.
std::string_view demo_sample();

}  // namespace pendular::cli
