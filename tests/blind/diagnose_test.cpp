#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "base/csv.h"
#include "blind/case_folder.h"
#include "effects/list.h"
#include "places.h"
#include "program.h"
#include "scratch.h"
#include "small_split.h"

namespace pendular::blind {
namespace {

using nlohmann::json;
using pendular::test::content;
using pendular::test::Outcome;
using pendular::test::ScratchFolder;

/// Leaves out an observation of an experiment.
void leave_out(const fs::path& experiment, const std::string& observation) {
  const std::string begin = "\n[[observation]]";
  std::string text = read_text(experiment);
  const auto from = text.rfind(begin, text.find("name = \"" + observation + "\""));
  ASSERT_NE(from, std::string::npos);
  write_text(experiment, text.erase(from, text.find(begin, from + 1) - from));
}

/// The smallest cases, opened where their truth is not; one magnitude per effect and the taller specimen
/// alone, to be quick.
class DiagnoseCommand : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    root = new fs::path(fs::temp_directory_path() / fmt::format("pendular.diagnose.{}", ::getpid()));
    make_folder(*root);
    const Outcome made = pendular::test::shell(
        *root, "$P blind make '" + pendular::test::source_folder() + "/samples/blind/small.toml' -o split");
    ASSERT_EQ(made.status, 0) << made.errors;
    fs::remove_all(*root / "split/sealed");
    leave_out(*root / "split/cases/case_001/experiment.toml", "B");
  }
  static void TearDownTestSuite() {
    fs::remove_all(*root);
    delete root;
  }

  static Outcome diagnose(const std::string& how) {
    return pendular::test::shell(*root, "$P diagnose split/cases/case_001/experiment.toml --levels 1 " + how);
  }
  static std::size_t runs_kept() {
    std::size_t count = 0;
    for (const auto& entry : fs::directory_iterator(*root / "store/runs"))
      count += entry.path().extension() != ".part";
    return count;
  }

  static fs::path* root;
};
fs::path* DiagnoseCommand::root = nullptr;

}  // namespace

TEST_F(DiagnoseCommand, TellsItsCostAndMakesNothing) {
  const Outcome told = diagnose("-o nothing --dry-run");
  EXPECT_EQ(told.status, 0) << told.errors;
  EXPECT_NE(told.errors.find("runs to learn the effects from"), std::string::npos) << told.errors;
  EXPECT_FALSE(fs::exists(*root / "nothing"));
}

TEST_F(DiagnoseCommand, GoesOnAfterBeingStoppedAndNeedsNoTruth) {
  const Outcome stopped = pendular::test::shell(
      *root,
      "timeout -s INT 2 $P diagnose split/cases/case_001/experiment.toml --levels 1 -o first --store store");
  EXPECT_EQ(stopped.status, 124) << stopped.errors;  // timeout's own
  EXPECT_FALSE(fs::exists(*root / "first/diagnosis.json"));

  const Outcome whole = diagnose("-o first --store store");
  ASSERT_EQ(whole.status, 0) << whole.errors;
  const json found = json::parse(content(*root / "first/diagnosis.json"));
  double sum = 0.0;
  std::set<std::string> named;
  for (const auto& hypothesis : found["hypotheses"]) {
    sum += hypothesis["probability"].get<double>();
    named.insert(hypothesis["id"]);
  }
  EXPECT_NEAR(sum, 1.0, 1e-6);
  EXPECT_TRUE(named.contains("none") && named.contains("unknown"));
  for (const auto& effect : effects::all_effects()) EXPECT_TRUE(named.contains(effect.id)) << effect.id;
  EXPECT_EQ(read_csv(*root / "first/ledger.csv", {"run", "status"}).rows(), found["runs"].get<std::size_t>());
  EXPECT_TRUE(fs::exists(*root / "first/report.html"));

  const std::size_t kept = runs_kept();
  const Outcome again = diagnose("-o second --store store --threads 1");
  ASSERT_EQ(again.status, 0) << again.errors;
  EXPECT_EQ(runs_kept(), kept);
  for (const char* file : {"diagnosis.json", "gap.csv", "hypotheses.csv", "report.html"})
    EXPECT_EQ(content(*root / "second" / file), content(*root / "first" / file)) << file;
}

TEST_F(DiagnoseCommand, RefusesUnknownEffectsAndBeadsOfAnotherSpecimen) {
  const Outcome unknown = diagnose("-o refused --leave-out missing_bridge");
  EXPECT_EQ(unknown.status, 3);
  EXPECT_NE(unknown.errors.find("missing_bridges"), std::string::npos) << unknown.errors;

  fs::copy(*root / "split/cases/case_002", *root / "other", fs::copy_options::recursive);
  std::string text = read_text(*root / "other/sample.toml");
  const std::string height = "height_um = ";
  text.replace(text.find(height), height.size(), height + "1");  // 900 becomes 1900
  write_text(*root / "other/sample.toml", text);
  const Outcome other = pendular::test::shell(*root, "$P diagnose other/experiment.toml -o refused");
  EXPECT_EQ(other.status, 3);
  EXPECT_NE(other.errors.find("another specimen"), std::string::npos) << other.errors;
}

}  // namespace pendular::blind
