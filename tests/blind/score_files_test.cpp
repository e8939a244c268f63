#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "base/csv.h"
#include "places.h"
#include "program.h"
#include "seven_cases.h"

namespace pendular::blind {

using nlohmann::json;

class ScoreFiles : public seven_cases::Score {};

/// How many sealed cases the README states.
static int cases_in_readme(const fs::path& project) {
  const std::string page = read_text(project / "README.md"), before = "withheld cause in the named set | ";
  std::istringstream row(page.substr(page.find(before) + before.size()));
  int named = 0, cases = 0;
  std::string of;
  row >> named >> of >> cases;
  return cases;
}

TEST_F(ScoreFiles, WritesATableThatCanBeReadBack) {
  const auto all = verdicts(open_seals(folder / "split"), reports);
  write_scores(folder / "score", all, score(all, false), {"0.1.0", "pendular blind score", 1, {}});
  const CsvTable table =
      read_csv(folder / "score/cases.csv", {"case", "stratum", "p_answer", "exact", "status", "failure"});
  ASSERT_EQ(table.rows(), 7u);
  EXPECT_NEAR(table.numbers("p_answer")[1], 0.3, 1e-9);
  EXPECT_EQ(table.texts("status")[6], "failed");
  EXPECT_EQ(table.texts("failure")[6], "no diagnosis.json");
  const json written = json::parse(read_text(folder / "score/score.json"));
  EXPECT_EQ(written["all"]["exact"]["hits"], 3);
  EXPECT_EQ(written["kept_by_stratum"]["none"]["reliability"].size(), 5u);
  EXPECT_EQ(written["all_by_class"]["cases"], 7);
  const std::string page = read_text(folder / "score/score.md");
  EXPECT_NE(page.find("3 of 7, 43 %"), std::string::npos);
  for (const char* heading : {"By name and by class", "Promised and reached", "Reliability"})
    EXPECT_NE(page.find(std::string("\n## ") + heading + "\n"), std::string::npos) << heading;
}

TEST_F(ScoreFiles, ItsTablesGoIntoTheDocumentation) {
  const auto all = verdicts(open_seals(folder / "split"), reports);
  write_scores(folder / "score", all, score(all, false), {"0.1.0", "pendular blind score", 1, {}});
  fs::create_directory(folder / "docs");
  for (const char* name : {"README.md", "docs/blind.md", "docs/blind-scores.csv"})
    fs::copy_file(fs::path(pendular::test::source_folder()) / name, folder / name);
  const auto written = [&](const std::string& scores) {
    return pendular::test::shell(
        folder.path(), pendular::test::source_folder() + "/scripts/blind-docs --project . " + scores);
  };
  ASSERT_EQ(written("--version v1 'Small split=score' score").status, 0);
  const std::string page = read_text(folder / "docs/blind.md");
  const auto at = [&](const std::string& words) { return page.find(words); };
  EXPECT_LT(at("<!-- figures"), at("### Small split\n"));
  EXPECT_LT(at("### Small split\n"), at("7 cases, 1 without a diagnosis"));
  EXPECT_LT(at("#### By name and by class\n"), at("#### Reliability\n"));
  EXPECT_LT(at("#### Reliability\n"), at("### score\n"));
  EXPECT_LT(at("### score\n"), at("<!-- end of figures -->\n"));
  EXPECT_LT(at("<!-- end of figures -->\n"), at("## Making\n"));
  EXPECT_EQ(at("All scores"), std::string::npos);
  EXPECT_LT(at("| | score, 7 cases |"), at("<!-- end of all scores"));
  const std::string kept = read_text(folder / "docs/blind-scores.csv");
  EXPECT_NE(kept.find("Small split,v1,0,all_in_set,,4,7\n"), std::string::npos) << kept;
  const int earlier = cases_in_readme(pendular::test::source_folder());
  EXPECT_EQ(cases_in_readme(folder.path()), earlier + 14);                 // of both scores
  ASSERT_EQ(written("--version v1 'Small split=score' score").status, 0);  // again: the same page
  EXPECT_EQ(read_text(folder / "docs/blind.md"), page);
  EXPECT_EQ(read_text(folder / "docs/blind-scores.csv"), kept);
  ASSERT_EQ(written("").status, 0);  // without scores: the table of all is made again
  EXPECT_EQ(read_text(folder / "docs/blind.md"), page);

  EXPECT_EQ(written("score").status, 2);
  const auto missing = written("--version v1 nowhere");
  EXPECT_EQ(missing.status, 3);
  EXPECT_NE(missing.errors.find("nowhere/score.md"), std::string::npos);
  EXPECT_EQ(read_text(folder / "docs/blind.md"), page);
  write_text(folder / "docs/blind.md", "no marks\n");
  EXPECT_EQ(written("--version v1 score").status, 3);
}

}  // namespace pendular::blind
