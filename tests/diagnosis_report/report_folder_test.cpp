#include "diagnosis_report/report_folder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "base/csv.h"
#include "base/error.h"
#include "documented.h"
#include "planted_diagnosis.h"
#include "scratch.h"

namespace pendular {
namespace {

using diagnosis_report::write_report_folder;

std::set<std::string> names_in(const fs::path& folder, const std::string& extension) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == extension) names.insert(entry.path().stem().string());
  return names;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

/// Pictures are within the page; links lead to files beside it that are there.
void expect_refers_to_nothing_outside(const std::string& html, const fs::path& folder) {
  EXPECT_EQ(html.find("<script"), std::string::npos);
  EXPECT_NE(html.find("default-src 'none'"), std::string::npos);
  EXPECT_FALSE(std::regex_search(html, std::regex("src=(?!\"data:image/)")));
  const std::regex link("href=\"([^\"]*)\"");
  for (std::sregex_iterator at(html.begin(), html.end(), link), end; at != end; ++at)
    EXPECT_TRUE(fs::is_regular_file(folder / (*at)[1].str())) << (*at)[1];
  EXPECT_EQ(html.find("<link"), std::string::npos);
  EXPECT_EQ(html.find("url("), std::string::npos);
  EXPECT_EQ(html.find("@import"), std::string::npos);
}

void expect_bands_hold_the_mean(const fs::path& path, const std::string& name) {
  const CsvTable table = read_csv(path, {"measured_stress_pa", name + "_low", name + "_mean", name + "_high",
                                         name + "_mean_less_measured", "strain"});
  const auto measured = table.numbers("measured_stress_pa"), strain = table.numbers("strain");
  const auto low = table.numbers(name + "_low", true), mean = table.numbers(name + "_mean", true),
             high = table.numbers(name + "_high", true),
             less = table.numbers(name + "_mean_less_measured", true);
  ASSERT_GT(table.rows(), 100u);
  for (std::size_t k = 0; k < table.rows(); ++k) {
    if (k > 0) {
      EXPECT_GT(strain[k], strain[k - 1]);
    }
    EXPECT_LE(low[k], mean[k]);
    EXPECT_LE(mean[k], high[k]);
    EXPECT_NEAR(less[k], mean[k] - measured[k], 1e-6);
  }
}

TEST(ReportFolder, HasAFigureWithItsDataForEverythingThatIsKnown) {
  const test::ScratchFolder scratch;
  const auto diagnosis = test::planted_diagnosis();
  write_report_folder(scratch.path(), diagnosis);

  const std::set<std::string> figures = names_in(scratch.path(), ".png"),
                              tables = names_in(scratch.path(), ".csv");
  EXPECT_EQ(figures, (std::set<std::string>{"gap_map", "gap", "overlay_1_A", "overlay_2_B", "overlay_3_Z",
                                            "overlay_4_scan", "hypotheses", "magnitude_missing_bridges",
                                            "magnitude_bridge_diameter_spread", "signatures", "separation",
                                            "pulls", "goodness", "shrinkage", "next_experiments"}));
  for (const auto& name : figures) EXPECT_TRUE(tables.contains(name)) << name;
  EXPECT_EQ(names_in(scratch.path(), ".pdf"), figures);
  EXPECT_EQ(names_in(scratch.path(), ".svg"), figures);
  for (const char* name : {"overlay_1_A_runs", "gap_shares", "noise_budget", "excluded", "ledger"})
    EXPECT_TRUE(tables.contains(name)) << name;

  const auto rows = [&](const std::string& name, const std::vector<std::string>& columns) {
    return read_csv(scratch / (name + ".csv"), columns).rows();
  };
  EXPECT_EQ(rows("gap", {"observation", "feature", "strain_from", "z", "share"}), diagnosis.gap.rows.size());
  EXPECT_EQ(rows("hypotheses", {"id", "probability", "magnitude_2"}), diagnosis.explanations.size());
  EXPECT_EQ(rows("noise_budget", {"ensemble", "measurement", "model", "believed"}), diagnosis.noise.size());
  EXPECT_EQ(rows("signatures", {"effect", "A: linear_modulus", "scan: wandering"}), diagnosis.effects.size());
  EXPECT_EQ(rows("excluded", {"id", "reason"}), 1u);
  EXPECT_EQ(rows("gap_map", {"observation", "linear_modulus"}), 4u);
  EXPECT_EQ(rows("shrinkage", {"data", "before", "after", "fraction"}), 4u);
  const CsvTable ledger = read_csv(scratch / "ledger.csv", {"run", "status", "message"});
  ASSERT_EQ(ledger.rows(), diagnosis.ledger.size());
  EXPECT_EQ(ledger.texts("status")[0], "failed");
  for (const char* name : {"simulated", "repaired"})
    expect_bands_hold_the_mean(scratch / "overlay_1_A.csv", name);

  const std::string html = read_text(scratch / "report.html");
  EXPECT_EQ(count(html, "<img "), figures.size());
  EXPECT_NE(html.find(diagnosis.verdict.substr(0, 40)), std::string::npos);
  EXPECT_NE(html.find("30 in all, of which 1 failed"), std::string::npos);
  expect_refers_to_nothing_outside(html, scratch.path());
  EXPECT_LT(html.size(), 3u << 20);
  EXPECT_TRUE(nlohmann::json::accept(read_text(scratch / "diagnosis.json")));
}

TEST(ReportFolder, TablesHaveTheColumnsOfThePage) {
  const test::ScratchFolder scratch;
  write_report_folder(scratch.path(), test::planted_diagnosis());
  for (auto row : test::documented_rows("Tables of a report")) {
    std::string name = row.front();
    if (const auto at = name.find("EFFECT"); at != std::string::npos)
      name.replace(at, 6, "bridge_diameter_spread");
    row.erase(row.begin());
    EXPECT_EQ(test::columns_of(scratch / name), row) << name;
  }
}

TEST(ReportFolder, OfADiagnosisThatFoundNothingSaysSo) {
  const test::ScratchFolder scratch;
  write_report_folder(scratch / "a", test::quiet_diagnosis());
  EXPECT_EQ(names_in(scratch / "a", ".png"),
            (std::set<std::string>{"gap_map", "gap", "overlay_1_A", "hypotheses", "goodness"}));
  const std::string html = read_text(scratch / "a" / "report.html");
  EXPECT_NE(html.find("No test was simulated with an effect added."), std::string::npos);
  EXPECT_NE(html.find("None is excluded."), std::string::npos);
  expect_refers_to_nothing_outside(html, scratch / "a");

  write_report_folder(scratch / "b", test::quiet_diagnosis());
  EXPECT_EQ(sha256_of(scratch / "a"), sha256_of(scratch / "b"));
}

TEST(ReportFolder, NeedsNoDisplayForChartsAndKeepsTheNumbersWithoutGnuplot) {
  const test::ScratchFolder scratch;
  const char* display = std::getenv("DISPLAY");
  const std::string path = std::getenv("PATH"), former = display != nullptr ? display : "";
  ::unsetenv("DISPLAY");
  fs::create_directory(scratch / "bin");
  fs::create_symlink("/usr/bin/gnuplot", scratch / "bin/gnuplot");
  ::setenv("PATH", (scratch / "bin").c_str(), 1);
  EXPECT_NO_THROW(write_report_folder(scratch / "a", test::quiet_diagnosis()));
  fs::remove(scratch / "bin/gnuplot");
  EXPECT_THROW(write_report_folder(scratch / "b", test::quiet_diagnosis()), ComputationFailed);
  ::setenv("PATH", path.c_str(), 1);
  if (!former.empty()) ::setenv("DISPLAY", former.c_str(), 1);
  EXPECT_TRUE(fs::exists(scratch / "b/diagnosis.json"));
  EXPECT_TRUE(fs::exists(scratch / "b/gap.csv"));
  EXPECT_FALSE(fs::exists(scratch / "b/report.html"));
}

TEST(ReportFolder, NothingAtAllIsAReportToo) {
  const test::ScratchFolder scratch;
  write_report_folder(scratch.path(), diagnosis::Diagnosis{});
  EXPECT_TRUE(names_in(scratch.path(), ".png").empty());
  EXPECT_NE(read_text(scratch / "report.html").find("No features could be compared."), std::string::npos);
}

TEST(ReportFolder, EscapesEveryTextAndNamesFilesSafely) {
  const test::ScratchFolder scratch;
  const std::string nasty = "../<b title=\"x\">R&D, 'n' #1</b>\nnext";
  const auto diagnosis = test::named_throughout(nasty);
  write_report_folder(scratch / "out", diagnosis);
  const std::string html = read_text(scratch / "out" / "report.html");
  EXPECT_EQ(html.find("<b "), std::string::npos);
  EXPECT_EQ(html.find("R&D"), std::string::npos);
  EXPECT_NE(html.find("R&amp;D"), std::string::npos);
  expect_refers_to_nothing_outside(html, scratch / "out");
  for (const auto& entry : fs::directory_iterator(scratch / "out"))
    EXPECT_TRUE(std::regex_match(entry.path().filename().string(),
                                 std::regex("[A-Za-z0-9_-]+\\.(png|pdf|svg|csv|html|json)")))
        << entry.path();
  const auto report = nlohmann::json::parse(read_text(scratch / "out" / "diagnosis.json"));
  EXPECT_EQ(report["verdict"], nasty);
  EXPECT_TRUE(report["gap"][0]["z"].is_null());
  EXPECT_EQ(read_csv(scratch / "out" / "gap.csv", {"observation", "z"}).rows(), diagnosis.gap.rows.size());
  EXPECT_EQ(read_csv(scratch / "out" / "ledger.csv", {"run", "message"}).rows(), diagnosis.ledger.size());
}

}  // namespace
}  // namespace pendular
