#pragma once

#include <string>

namespace pendular::test {

/// The checkout that the tests were built from.
std::string source_folder();

/// The program of the same build.
std::string program();

}  // namespace pendular::test
