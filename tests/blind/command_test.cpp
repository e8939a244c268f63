#include <gtest/gtest.h>

#include <algorithm>

#include "blind/case_folder.h"
#include "places.h"
#include "program.h"
#include "scratch.h"
#include "small_split.h"

namespace pendular::blind {
namespace {

using pendular::test::Outcome;
using pendular::test::ScratchFolder;
using test::files_in;

const std::string kSplit = "'" + pendular::test::source_folder() + "/samples/blind/small.toml'";

Outcome run(const ScratchFolder& folder, const std::string& command) {
  return pendular::test::shell(folder.path(), "$P blind " + command);
}

void replace(const fs::path& path, const std::string& what, const std::string& by) {
  std::string text = read_text(path);
  const auto at = text.find(what);
  ASSERT_NE(at, std::string::npos);
  write_text(path, text.replace(at, what.size(), by));
}

/// A report that is sure of one explanation.
void report(const fs::path& folder, const std::string& id) {
  make_folder(folder);
  write_text(folder / "diagnosis.json", "{\"hypotheses\": [{\"id\": \"" + id +
                                            "\", \"probability\": 1.0}], \"ambiguity_set\": [\"" + id +
                                            "\"], \"shrinkage\": {}}");
}

}  // namespace

TEST(BlindCommand, DryRunTellsAndMakesNothing) {
  ScratchFolder folder;
  const Outcome told = run(folder, "make " + kSplit + " -o out --dry-run");
  EXPECT_EQ(told.status, 0) << told.errors;
  EXPECT_NE(told.errors.find("3 cases on 1 packing,"), std::string::npos) << told.errors;
  EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST(BlindCommand, MakesThePackingThatIsAskedFor) {
  ScratchFolder folder;
  const std::string split = "'" + pendular::test::source_folder() + "/samples/blind/sealed2.toml'";
  const Outcome all = run(folder, "make " + split + " -o out --dry-run"),
                one = run(folder, "make " + split + " -o out --dry-run --packing 4");
  EXPECT_NE(all.errors.find("300 cases on 6 packings"), std::string::npos) << all.errors;
  EXPECT_NE(one.errors.find("50 cases on 1 packing,"), std::string::npos) << one.errors;
  const Outcome none = run(folder, "make " + split + " -o out --packing 7");
  EXPECT_EQ(none.status, 2);
  EXPECT_NE(none.errors.find("--packing: found 7, expected at most 6"), std::string::npos) << none.errors;
  const Outcome made = run(folder, "make " + kSplit + " -o out --packing 1");
  ASSERT_EQ(made.status, 0) << made.errors;
  EXPECT_EQ(files_in(folder / "out").count("cases/case_003/seal.txt"), 1u);
  const std::string seals = read_text(folder / "out/seals.csv");
  EXPECT_EQ(std::count(seals.begin(), seals.end(), '\n'), 4);
}

TEST(BlindCommand, GoesOnWithTheSameBytesAndScores) {
  ScratchFolder folder;
  const Outcome made = run(folder, "make " + kSplit + " -o out");
  ASSERT_EQ(made.status, 0) << made.errors;
  const auto before = files_in(folder / "out");
  EXPECT_TRUE(before.contains("seals.csv"));
  EXPECT_TRUE(before.contains("cases/case_002/experiment.toml"));

  fs::remove_all(folder / "out/cases/case_002");
  fs::remove(folder / "out/sealed/case_003.json");
  const auto kept = fs::last_write_time(folder / "out/cases/case_001/A.csv");
  ASSERT_EQ(run(folder, "make " + kSplit + " -o out --threads 1").status, 0);
  EXPECT_EQ(files_in(folder / "out"), before);
  EXPECT_EQ(fs::last_write_time(folder / "out/cases/case_001/A.csv"), kept);

  const Outcome other = run(folder, "make " + kSplit + " -o out --seed 6");
  EXPECT_EQ(other.status, 3) << other.errors;

  for (const char* name : {"case_001", "case_002", "case_003"}) report(folder / "reports" / name, "none");
  const Outcome scored = run(folder, "score out reports -o score");
  ASSERT_EQ(scored.status, 0) << scored.errors;
  for (const char* name : {"cases.csv", "score.json", "score.md"})
    EXPECT_TRUE(fs::exists(folder / "score" / name));

  replace(folder / "out/sealed/case_002.json", "\"law\": \"paper\"", "\"law\": \"raper\"");
  const Outcome damaged = run(folder, "score out reports -o again");
  EXPECT_EQ(damaged.status, 3);
  EXPECT_NE(damaged.errors.find("case_002.json"), std::string::npos) << damaged.errors;
  EXPECT_FALSE(fs::exists(folder / "again"));
}

TEST(BlindCommand, DiagnosesAnewWhereAReportIsCutOff) {
  ScratchFolder folder;
  for (const char* name : {"case_001", "case_002"}) {
    make_folder(folder / "out/cases" / name);
    write_text(folder / "out/cases" / name / "experiment.toml",
               "");  // cannot be diagnosed, which takes no time
    report(folder / "reports" / name, "none");
  }
  write_text(folder / "reports/case_001/report.html", "written last");
  const Outcome found = run(folder, "diagnose out -o reports");
  EXPECT_EQ(found.status, 4);
  EXPECT_NE(found.errors.find("1 cases could not be diagnosed; case_002"), std::string::npos) << found.errors;
}

TEST(BlindCommand, WritesThroughNoLink) {
  for (const char* inner : {"cases", "sealed", "work"}) {
    ScratchFolder folder;
    make_folder(folder / "elsewhere");
    make_folder(folder / "out");
    fs::create_directory_symlink(folder / "elsewhere", folder / "out" / inner);
    const Outcome made = run(folder, "make " + kSplit + " -o out");
    EXPECT_EQ(made.status, 3) << made.errors;
    EXPECT_NE(made.errors.find(std::string("out/") + inner + ": is a link"), std::string::npos)
        << made.errors;
    EXPECT_TRUE(fs::is_empty(folder / "elsewhere"));
  }
}

TEST(BlindCommand, SaysWhatIsMissing) {
  ScratchFolder folder;
  EXPECT_EQ(run(folder, "score nowhere reports -o score").status, 3);
  EXPECT_EQ(run(folder, "diagnose nowhere -o reports").status, 3);
  EXPECT_EQ(run(folder, "make none.toml -o out").status, 3);
  EXPECT_EQ(run(folder, "").status, 2);
}

}  // namespace pendular::blind
