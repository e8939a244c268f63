#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "base/files.h"
#include "program.h"
#include "scratch.h"
#include "small_sample.h"

namespace pendular {
namespace {

using test::content;
using test::ScratchFolder;
using test::shell;

TEST(Modulus, WritesTheSameBytesForAnyNumberOfThreads) {
  ScratchFolder folder;
  write_text(folder / "s.toml", test::small_sample());
  ASSERT_EQ(shell(folder.path(), "$P pack --generate --sample s.toml -o p.vtp").status, 0);
  const auto one = shell(folder.path(), "$P modulus p.vtp --sample s.toml --threads 1 -o one.json");
  ASSERT_EQ(one.status, 0) << one.errors;
  ASSERT_EQ(shell(folder.path(), "$P modulus p.vtp --sample s.toml --threads 2 -o two.json").status, 0);
  EXPECT_EQ(content(folder / "one.json"), content(folder / "two.json"));
  const auto json = nlohmann::json::parse(content(folder / "one.json"));
  EXPECT_GT(json["linear_modulus_pa"].get<double>(), 1.5e6) << "stiffer than the polymer alone";
  EXPECT_LT(json["linear_modulus_pa"].get<double>(), 40.0 * 1.5e6);
  EXPECT_GT(json["contacts"]["beads_on_bottom_platen"].get<int>(), 2);
  EXPECT_EQ(json["holds"].get<bool>(), json["reasons"].empty());
  EXPECT_EQ(json["provenance"]["inputs"].size(), 2u);
}

TEST(Modulus, StrainMustBeAStrain) {
  ScratchFolder folder;
  write_text(folder / "s.toml", test::small_sample());
  ASSERT_EQ(shell(folder.path(), "$P pack --generate --sample s.toml -o p.vtp").status, 0);
  EXPECT_EQ(shell(folder.path(), "$P modulus p.vtp --sample s.toml --strain 3 -o m.json").status, 2);
  EXPECT_FALSE(fs::exists(folder / "m.json"));
}

}  // namespace
}  // namespace pendular
