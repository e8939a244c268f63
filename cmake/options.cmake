# What every target of the project is built with.
option(PENDULAR_TESTS "Build the tests" ON)
option(PENDULAR_PYTHON "Build the Python module" OFF)
option(PENDULAR_BENCH "Build the benchmarks" OFF)
option(PENDULAR_SANITIZE "Address and undefined-behaviour sanitizers" OFF)
option(PENDULAR_FUZZ "The targets of libFuzzer, under sanitizers; needs clang" OFF)

if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

find_program(CCACHE ccache)
if(CCACHE)
  # ccache sees through precompiled headers only where it is told so.
  set(launcher ${CMAKE_COMMAND} -E env
    CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime ${CCACHE})
  set(CMAKE_C_COMPILER_LAUNCHER ${launcher})
  set(CMAKE_CXX_COMPILER_LAUNCHER ${launcher})
endif()

# Shared objects that programs load where they need them.
include(GNUInstallDirs)
set(PENDULAR_MODULES ${PROJECT_BINARY_DIR}/modules)
set(CMAKE_BUILD_RPATH ${PENDULAR_MODULES})
set(CMAKE_INSTALL_RPATH $ORIGIN/../${CMAKE_INSTALL_LIBDIR}/pendular)

add_library(pendular_flags INTERFACE)
target_compile_options(pendular_flags INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
                       $<$<NOT:$<BOOL:${PENDULAR_FUZZ}>>:-Werror>  # another compiler's warnings do not end that build
                       # GCC 12 warns falsely of std::string (its bugs 105329, 105651), and no longer hides
                       # what lies in a precompiled header of the system.
                       $<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds;-Wno-restrict;-Wno-stringop-overflow;-Wno-stringop-overread>
                       # Results must not depend on how a compiler contracts a*b+c.
                       -ffp-contract=off
                       # Libraries are position-independent; their own calls are still inlined.
                       -fno-semantic-interposition)
if(PENDULAR_SANITIZE)
  add_compile_options(-fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
  add_link_options(-fsanitize=address,undefined)
endif()
if(PENDULAR_FUZZ)
  add_compile_options(-fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=undefined)
  add_link_options(-fsanitize=address,undefined)
endif()
