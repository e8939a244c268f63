// Test programs keep freed memory as the program does: a tenth of the time of all tests.
#include "base/own_process.h"

namespace {

[[maybe_unused]] const bool kept = [] {
  pendular::keep_freed_memory();
  return true;
}();

}  // namespace
