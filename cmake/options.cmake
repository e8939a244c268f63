# What every target of the project is built with.
option(PENDULAR_TESTS "Build the tests" ON)
option(PENDULAR_PYTHON "Build the Python module" ON)
option(PENDULAR_BENCH "Build the benchmarks" OFF)
set(PENDULAR_SANITIZE "" CACHE STRING "\"address\" (with undefined behaviour), \"thread\", or none")
option(PENDULAR_FUZZ "The targets of libFuzzer; needs clang and PENDULAR_SANITIZE=address" OFF)

if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

find_program(CCACHE ccache)
if(CCACHE)
  # ccache sees through precompiled headers only where it is told so; paths below the checkout are hashed as relative ones, so
  # that checkouts in different folders share what was compiled.
  set(launcher ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR}
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
                       $<$<STREQUAL:${PENDULAR_SANITIZE},>:-Werror>  # what a sanitizer adds makes warnings of its own
                       # GCC 12 warns falsely of std::string (its bugs 105329, 105651), and no longer hides
                       # what lies in a precompiled header of the system.
                       $<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds;-Wno-restrict;-Wno-stringop-overflow;-Wno-stringop-overread>
                       # Results must not depend on how a compiler contracts a*b+c.
                       -ffp-contract=off
                       # No one reads errno after a root, which otherwise is not taken of a whole register.
                       -fno-math-errno
                       # The compiler looks for garbage from 0.5 GB on, not from 0.13 GB: 3 to 12 % of its time.
                       $<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=524288>
                       # Libraries are position-independent; their own calls are still inlined.
                       -fno-semantic-interposition)
# Results must not depend on a machine's caches: by their sizes Eigen cuts products of matrices into sums.
target_compile_definitions(pendular_flags INTERFACE EIGEN_NO_CPUID EIGEN_DEFAULT_L1_CACHE_SIZE=32768
                           EIGEN_DEFAULT_L2_CACHE_SIZE=1048576 EIGEN_DEFAULT_L3_CACHE_SIZE=33554432)
# For sources in which nothing takes long: a quarter to two fifths less to compile.
set(PENDULAR_QUICK_TO_COMPILE $<$<CONFIG:Release>:-O1>)
# Debian's ITK knows GCC alone and refuses other compilers: what its headers would have learnt of them.
target_compile_definitions(pendular_flags INTERFACE $<$<CXX_COMPILER_ID:Clang>:ITK_COMPILER_DETECTION_H;
  ITK_COMPILER_CXX_STATIC_ASSERT=1;ITK_CONSTEXPR=constexpr;ITK_NOEXCEPT=noexcept>)
if(PENDULAR_SANITIZE STREQUAL "address")
  set(sanitizers address,undefined)
elseif(PENDULAR_SANITIZE)
  set(sanitizers ${PENDULAR_SANITIZE})
endif()
if(PENDULAR_SANITIZE)
  # Findings end a program by their options at run time (scripts/sanitize): only so can one be suppressed by name.
  add_compile_options(-fsanitize=${sanitizers} -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${sanitizers})
endif()
if(PENDULAR_FUZZ)
  add_compile_options(-fsanitize=fuzzer-no-link)
endif()
