#pragma once

namespace pendular {

/// What a shared object of the program's own exports under a name. It is loaded when it is first asked for:
/// it holds what needs libraries that take longer to load than most commands take. The run path of the
/// programs finds it (cmake/options.cmake). ComputationFailed where it is not there.
const void* module_symbol(const char* file, const char* name);

}  // namespace pendular
