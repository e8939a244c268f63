#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/csv.h"
#include "base/files.h"
#include "base/random.h"
#include "packing/tables.h"
#include "packing/vtp.h"
#include "program.h"
#include "sample_file.h"
#include "scratch.h"

namespace pendular {
namespace {

using test::content;
using test::ScratchFolder;
using test::shell;

constexpr double kSigma = 0.1e-6;

std::string sample(const std::string& diameters) {
  return test::sample_file("[beads]\n" + diameters +
                           "[bridges]\nnormal_stiffness_n_per_m = 5760\ntangential_stiffness_n_per_m = 325\n"
                           "[specimen]\ndiameter_um = 1500\nheight_um = 1500\nvolume_fraction = 0.57\n"
                           "[compression]\nmax_strain = 0.03\nframes = 0\n");
}

/// Centres and diameters with the errors that are stated, as a tomogram gives them.
std::vector<Bead> measured(std::vector<Bead> beads) {
  for (std::size_t k = 0; k < beads.size(); ++k) {
    for (int axis = 0; axis < 3; ++axis)
      beads[k].centre[axis] += kSigma * random_normal(5, 4 * k + static_cast<std::size_t>(axis));
    beads[k].diameter += kSigma * random_normal(5, 4 * k + 3);
    beads[k].sigma_centre = beads[k].sigma_diameter = kSigma;
  }
  return beads;
}

/// A generated specimen, truth.vtp, and the table of it that a tomogram gives, beads.csv.
class MeasuredChain : public testing::Test {
 protected:
  MeasuredChain() {
    write_text(folder / "auto.toml", sample(""));
    for (const std::string word : {"measured", "drawn"})
      write_text(folder / (word + ".toml"), sample("diameters = \"" + word + "\"\n"));
    said("pack --generate --sample measured.toml -o truth.vtp");
    write_beads(folder / "beads.csv", measured(read_packing(folder / "truth.vtp").beads), {});
  }

  /// What the program says of a command that succeeds.
  std::string said(const std::string& command) const {
    const auto done = shell(folder.path(), "$P " + command);
    EXPECT_EQ(done.status, 0) << done.errors;
    return done.errors;
  }

  nlohmann::json json(const std::string& name) const { return nlohmann::json::parse(content(folder / name)); }

  struct Response {
    double modulus, early_stress;  ///< the latter at 0.5 % of strain, Pa
  };

  /// Of a packing, compressed as that sample says.
  Response response(const std::string& packing, const std::string& word) const {
    const std::string run = packing + "." + word;
    said("compress " + packing + " --sample " + word + ".toml -o " + run);
    const auto result = json(run + "/result.json");
    EXPECT_EQ(result["diameters"], word == "drawn" ? "drawn" : "measured");
    const CsvTable curve = read_csv(folder / run / "curve.csv", {"strain", "stress_pa"});
    const auto strain = curve.numbers("strain"), stress = curve.numbers("stress_pa");
    const auto row = std::lower_bound(strain.begin(), strain.end(), 0.005) - strain.begin();
    return {result["linear_modulus_pa"]["value"], stress.at(static_cast<std::size_t>(row))};
  }

  ScratchFolder folder;
};

TEST_F(MeasuredChain, RespondsAsTheSpecimenDoes) {
  const Response truth = response("truth.vtp", "measured");
  said("pack beads.csv --sample auto.toml -o default.vtp");
  const Response found = response("default.vtp", "auto");
  EXPECT_NEAR(found.modulus, truth.modulus, 0.03 * truth.modulus);
  EXPECT_NEAR(found.early_stress, truth.early_stress, 0.07 * truth.early_stress);

  said("pack beads.csv --sample drawn.toml -o as_measured.vtp");
  EXPECT_LT(response("as_measured.vtp", "drawn").modulus, 0.5 * truth.modulus) << "the paper's drawing";
  EXPECT_LT(response("as_measured.vtp", "measured").early_stress, 0.9 * truth.early_stress)
      << "contacts left open by errors: a toe that the specimen has not";
}

TEST_F(MeasuredChain, SaysHowDiametersAreUsed) {
  EXPECT_NE(said("pack beads.csv --sample auto.toml -o a.vtp").find("diameters as measured"),
            std::string::npos);
  EXPECT_EQ(json("a.json")["diameters"], "measured");
  EXPECT_GT(json("a.json")["closed_contacts"]["pairs"], 200);
  EXPECT_LT(json("a.json")["closed_contacts"]["rms_over_stated_errors"], 1.0);

  EXPECT_NE(
      said("pack beads.csv --sample drawn.toml -o d.vtp").find("drawn when compressed: the sample asks"),
      std::string::npos);
  EXPECT_EQ(json("d.json")["diameters"], "drawn");
  EXPECT_FALSE(json("d.json").contains("closed_contacts"));

  EXPECT_NE(said("modulus d.vtp --sample auto.toml -o m.json").find("expected their contacts closed"),
            std::string::npos);
  EXPECT_EQ(json("m.json")["diameters"], "measured");

  said("convert truth.vtp exact.csv");
  EXPECT_NE(said("pack exact.csv --sample auto.toml -o e.vtp").find("drawn when compressed: no errors"),
            std::string::npos);
  EXPECT_NE(said("pack exact.csv --sample measured.toml -o m.vtp").find("diameters as they are"),
            std::string::npos);
}

}  // namespace
}  // namespace pendular
