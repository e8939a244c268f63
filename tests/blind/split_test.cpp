#include "blind/split.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "places.h"
#include "scratch.h"
#include "small_split.h"

namespace pendular::blind {
namespace {

using pendular::test::ScratchFolder;

/// The small split with one text replaced by another, and what is said of it.
std::string refusal(const std::string& what, const std::string& by) {
  ScratchFolder folder;
  const fs::path samples = fs::path(pendular::test::source_folder()) / "samples/blind";
  fs::copy(samples / "small_sample.toml", folder / "small_sample.toml");
  std::string text = read_text(samples / "small.toml");
  const auto at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  text.replace(at, what.size(), by);
  write_text(folder / "split.toml", text);
  try {
    read_split(folder / "split.toml", std::nullopt);
  } catch (const BadInput& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST(Split, ReadsEveryCommittedFile) {
  for (const char* name :
       {"development2", "development4", "development5", "sealed2", "sealed4", "sealed5", "sealed", "small"}) {
    const Split split = read_split(
        fs::path(pendular::test::source_folder()) / "samples/blind" / (std::string(name) + ".toml"), {});
    EXPECT_EQ(split.name, name);
    double sum = 0.0;
    for (double share : split.shares) sum += share;
    EXPECT_NEAR(sum, 1.0, 1e-12);
  }
}

TEST(Split, DevelopmentAndSealedShareNoPackingAndNoSeed) {
  const fs::path samples = fs::path(pendular::test::source_folder()) / "samples/blind";
  const Split development = read_split(samples / "development2.toml", {});
  const Split sealed = read_split(samples / "sealed2.toml", {});
  EXPECT_NE(development.seed, sealed.seed);
  for (const auto& a : development.packings)
    for (const auto& b : sealed.packings) EXPECT_NE(a.seed, b.seed);
}

TEST(Split, RefusesWhatItCannotUse) {
  EXPECT_NE(refusal("cases = 3", "case = 3").find("\"cases\""), std::string::npos);
  EXPECT_NE(refusal("cases = 3", "cases = 2.5").find("cases"), std::string::npos);
  EXPECT_NE(refusal("cases = 3", "cases = 0").find("split.cases"), std::string::npos);
  EXPECT_NE(refusal("outside = 1", "outsid = 1").find("\"outside\""), std::string::npos);
  EXPECT_NE(refusal("outside = 1", "outside = -1").find("outside"), std::string::npos);
  EXPECT_NE(refusal("[test]", "[observed]\nscans = 1\n[test]").find("\"scan\""), std::string::npos);
  EXPECT_NE(refusal("[test]", "[observed]\nscan = 0\n[test]").find("no share above 0"), std::string::npos);
  EXPECT_NE(refusal("unload_at = 0.01", "unload_at = 0.03").find("unload_at"), std::string::npos);
  EXPECT_NE(refusal("\"contact.friction\"", "\"contact.fricton\"").find("\"contact.friction\""),
            std::string::npos);
  EXPECT_NE(refusal("cases = 3", "cases = 3\nengines = [\"yadde\"]").find("\"yade\""), std::string::npos);
  EXPECT_NE(refusal("cases = 3", "cases = 3\nengines = []").find("at least one engine"), std::string::npos);
  EXPECT_NE(refusal("height_um = 900\n", "").find("height_um is missing"), std::string::npos);
  EXPECT_NE(refusal("[test]", "[seen_from]\nplaten_tlt = 0.1\n[test]").find("\"platen_tilt\""),
            std::string::npos);
  EXPECT_NE(refusal("[test]", "[seen_from]\nplaten_tilt = 9.0\n[test]").find("expected 0 to 2"),
            std::string::npos);
  EXPECT_NE(refusal("small_sample.toml", "none.toml").find("none.toml"), std::string::npos);
}

TEST(Split, AnotherSeedIsAnotherSplit) {
  const fs::path file = fs::path(pendular::test::source_folder()) / "samples/blind/small.toml";
  EXPECT_EQ(read_split(file, {}).content, read_split(file, {}).content);
  EXPECT_NE(read_split(file, {}).content, read_split(file, 6).content);
}

}  // namespace pendular::blind
