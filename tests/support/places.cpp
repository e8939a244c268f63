// The only file of the tests that knows where this checkout lies: the objects of all others are the same in
// every checkout, so that a compiler cache can give them.
#include "places.h"

namespace pendular::test {

std::string source_folder() {
  return PENDULAR_SOURCE_DIR;
}

std::string program() {
  return PENDULAR_PROGRAM;
}

}  // namespace pendular::test
