#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "blind/case_folder.h"
#include "blind/score_files.h"
#include "scratch.h"

namespace pendular::blind::seven_cases {

using nlohmann::json;
using pendular::test::ScratchFolder;

/// A sealed case with its hash, as `blind make` leaves it.
inline std::string seal(const fs::path& root, const std::string& name, const std::string& stratum,
                        const std::string& answer, const json& effects, const std::string& mechanism = "",
                        const json& more = json::object()) {
  json truth = {{"case", name},
                {"stratum", stratum},
                {"answer", answer},
                {"law", "paper"},
                {"effects", effects},
                {"packing", 1},
                {"observed", "second_specimen"}};
  truth["beliefs"]["contact.friction"] = {{"off_by_sigmas", -2.0}};
  if (!mechanism.empty()) truth["mechanism"] = {{"id", mechanism}, {"theta", 0.5}};
  truth.update(more);
  make_folder(root / "sealed");
  write_text(root / "sealed" / (name + ".json"), truth.dump());
  return name + "," + sha256_of(root / "sealed" / (name + ".json")) + "\n";
}

inline json claim(const std::string& id, double probability, double magnitude = 0.0, double low = 0.0,
                  double high = 0.0) {
  return {{"id", id}, {"probability", probability}, {"magnitude", magnitude}, {"interval_90", {low, high}}};
}

inline void report(const fs::path& folder, const json& hypotheses, const json& set, double withheld = 0.0,
                   double retuned = 0.0) {
  json diagnosis = {{"hypotheses", hypotheses}, {"ambiguity_set", set}};
  diagnosis["shrinkage"]["withheld"] = {{"before", 2.0}, {"fraction", withheld}};
  diagnosis["shrinkage"]["controls"] = {{"modulus_retuned", retuned}, {"wrong_effect", 0.1}};
  make_folder(folder);
  write_text(folder / "diagnosis.json", diagnosis.dump());
}

/// Adds to the report of a case.
inline void add_to_report(const fs::path& folder, const json& more) {
  json diagnosis = json::parse(read_text(folder / "diagnosis.json"));
  diagnosis.update(more);
  write_text(folder / "diagnosis.json", diagnosis.dump());
}

/// Seven cases of which all scores can be computed by hand.
class Score : public ::testing::Test {
 protected:
  void SetUp() override {
    const fs::path root = folder / "split";
    const json friction = {{{"id", "bead_friction"}, {"theta", 0.2}}};
    const json missing = {{{"id", "missing_bridges"}, {"theta", 0.1}}};
    const json both = {{{"id", "missing_bridges"}, {"theta", 0.1}},
                       {{"id", "bead_friction"}, {"theta", 0.2}}};
    std::string seals = "case,sha256\n";
    seals += seal(root, "c1", "library", "missing_bridges", missing);
    seals += seal(root, "c2", "library", "bead_friction", friction);
    seals += seal(root, "c3", "none", "none", json::array());
    seals += seal(root, "c4", "none", "none", json::array());
    seals += seal(root, "c5", "outside", "unknown", json::array(), "crack");
    seals += seal(root, "c6", "outside", "unknown", json::array(), "grit");
    seals += seal(root, "c7", "pair", "missing_bridges+bead_friction", both);
    write_text(root / "seals.csv", seals);
    // Right, alone in its set, θ off by a tenth and inside its interval.
    report(reports / "c1", {claim("missing_bridges", 0.8, 0.11, 0.08, 0.14), claim("none", 0.2)},
           {"missing_bridges"}, 0.8, 0.3);
    // In the set but not first; θ off by half and outside its interval.
    report(reports / "c2",
           {claim("none", 0.6), claim("bead_friction", 0.3, 0.1, 0.05, 0.15), claim("unknown", 0.1)},
           {"none", "bead_friction"}, 0.4, 0.2);
    report(reports / "c3", {claim("none", 0.9), claim("unknown", 0.1)}, {"none"});
    report(reports / "c4", {claim("platen_tilt", 0.95), claim("none", 0.05)}, {"platen_tilt"});
    report(reports / "c5", {claim("unknown", 0.7), claim("none", 0.3)}, {"unknown", "none"});
    report(reports / "c6", {claim("platen_tilt", 0.92), claim("unknown", 0.08)}, {"platen_tilt"});
    // c7 has no report.
  }
  Scores scores() { return score(verdicts(open_seals(folder / "split"), reports), without_truth(reports)); }

  ScratchFolder folder;
  fs::path reports = folder / "reports";
};

}  // namespace pendular::blind::seven_cases
