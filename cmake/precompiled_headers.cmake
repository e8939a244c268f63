# Headers of the standard library, Eigen and {fmt} take two thirds of the time to compile a usual file; they are compiled
# once for all libraries, and once more, with GoogleTest, for all test programs. Off: CMAKE_DISABLE_PRECOMPILE_HEADERS,
# which shows a file that forgets an include of its own.
set(PENDULAR_COMMON_HEADERS <algorithm> <array> <cmath> <cstdint> <filesystem> <fstream> <functional> <map> <memory>
  <numeric> <optional> <set> <span> <sstream> <string> <string_view> <utility> <variant> <vector>
  <Eigen/Dense> <fmt/format.h> <fmt/ranges.h>)

file(WRITE ${PROJECT_BINARY_DIR}/precompiled/library.cpp "")
file(WRITE ${PROJECT_BINARY_DIR}/precompiled/program.cpp "int main() {}\n")

add_library(pendular_precompiled STATIC ${PROJECT_BINARY_DIR}/precompiled/library.cpp)
target_link_libraries(pendular_precompiled PRIVATE pendular_flags Eigen3::Eigen fmt::fmt)
set_target_properties(pendular_precompiled PROPERTIES POSITION_INDEPENDENT_CODE ON)
target_precompile_headers(pendular_precompiled PRIVATE ${PENDULAR_COMMON_HEADERS})

if(PENDULAR_TESTS)
  find_package(GTest REQUIRED)
  add_executable(pendular_tests_precompiled EXCLUDE_FROM_ALL ${PROJECT_BINARY_DIR}/precompiled/program.cpp)
  target_link_libraries(pendular_tests_precompiled PRIVATE pendular_flags Eigen3::Eigen fmt::fmt GTest::gtest)
  target_compile_options(pendular_tests_precompiled PRIVATE ${PENDULAR_QUICK_TO_COMPILE})
  target_precompile_headers(pendular_tests_precompiled PRIVATE ${PENDULAR_COMMON_HEADERS} <gtest/gtest.h>)
endif()
