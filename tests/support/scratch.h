#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <optional>
#include <string>

#include "places.h"

namespace pendular::test {

/// A folder of the test's own that goes with it.
class ScratchFolder {
 public:
  ScratchFolder() {
    const auto& tests = *::testing::UnitTest::GetInstance();
    const auto* test = tests.current_test_info();  // none while a suite is set up
    const std::string name = folder_name(tests.current_test_suite()->name(), test ? test->name() : "");
    path_ = std::filesystem::temp_directory_path() / name;
    std::filesystem::create_directories(path_);
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  static std::string folder_name(const std::string& suite, const std::string& test) {
    std::string name = "pendular." + suite + "." + test + "." + std::to_string(::getpid());
    for (char& c : name)
      if (c == '/') c = '_';  // of parameterised tests
    return name;
  }
  std::filesystem::path path_;
};

/// A file of the shared trial data, beside the checkout; nothing where the data is absent.
inline std::optional<std::filesystem::path> shared_data(const std::string& name) {
  const auto path = std::filesystem::path(source_folder()) / ".." / "shared" / "data" / name;
  if (!std::filesystem::exists(path)) return std::nullopt;
  return path;
}

}  // namespace pendular::test
