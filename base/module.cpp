#include "base/module.h"

#include <dlfcn.h>

#include "base/error.h"

namespace pendular {

const void* module_symbol(const char* file, const char* name) {
  void* library = ::dlopen(file, RTLD_NOW | RTLD_LOCAL);
  void* found = library == nullptr ? nullptr : ::dlsym(library, name);
  if (found == nullptr) throw ComputationFailed(::dlerror());
  return found;
}

}  // namespace pendular
