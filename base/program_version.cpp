#include "base/provenance.h"
#include "program_version_text.h"  // written by every build (describe_version.cmake)

namespace pendular {

std::string program_version() {
  return PENDULAR_VERSION;
}

}  // namespace pendular
