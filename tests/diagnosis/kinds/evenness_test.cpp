#include "diagnosis/kinds/evenness.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "base/random.h"
#include "diagnosis/inference/correction.h"
#include "observations.h"

namespace pendular::diagnosis {
namespace {

using test::observation;

constexpr std::size_t kPairsOfNetwork = 800;

/// Pairs anywhere in a cylinder, in any direction.
Columns places(std::uint64_t seed) {
  Columns columns;
  for (std::uint64_t k = 0; columns["cosine"].size() < kPairsOfNetwork; ++k) {
    const double x = random_uniform(seed, 4 * k) - 0.5, y = random_uniform(seed, 4 * k + 1) - 0.5;
    if (std::hypot(x, y) > 0.5) continue;
    columns["across_x"].push_back(x), columns["across_y"].push_back(y);
    columns["along_z"].push_back(random_uniform(seed, 4 * k + 2) - 0.5);
    columns["cosine"].push_back(random_uniform(seed, 4 * k + 3));
  }
  return columns;
}

/// Whether pairs are joined, with a probability that depends on where they are.
std::vector<double> joined(const Columns& where, std::uint64_t seed,
                           const std::function<double(std::size_t)>& probability) {
  std::vector<double> found;
  for (std::size_t k = 0; k < where.at("cosine").size(); ++k)
    found.push_back(random_uniform(seed, k) < probability(k) ? 1.0 : 0.0);
  return found;
}

// A test's own law: of networks without a preference as many are below p as p says.
TEST(Evenness, OfChanceAloneIsUniform) {
  constexpr int kNetworks = 1000;
  for (const double share : {0.95, 0.7}) {
    int below_20 = 0, below_2 = 0;
    for (std::uint64_t n = 0; n < kNetworks; ++n) {
      const Columns where = places(2 * n);
      const double p = evenness(where, joined(where, 2 * n + 1, [&](std::size_t) { return share; }), 0.0);
      below_20 += p < 0.2, below_2 += p < 0.02;
    }
    EXPECT_NEAR(below_20, 200, 50) << share;  // four standard deviations
    EXPECT_NEAR(below_2, 20, 18) << share;
  }
}

TEST(Evenness, ALayerACrackAndADirectionAreNoChance) {
  const Columns where = places(1);
  const auto& z = where.at("along_z");
  const auto& x = where.at("across_x");
  const auto& cosine = where.at("cosine");
  const auto p = [&](const std::function<double(std::size_t)>& probability) {
    return evenness(where, joined(where, 2, probability), 0.01);
  };
  EXPECT_LT(p([&](std::size_t k) { return z[k] < -0.2 ? 0.7 : 0.95; }), 1e-4);
  EXPECT_LT(p([&](std::size_t k) { return std::fabs(z[k] - 0.5 * x[k]) < 0.05 ? 0.2 : 1.0; }), 1e-4);
  EXPECT_LT(p([&](std::size_t k) { return 1.0 - 0.35 * cosine[k] * cosine[k]; }), 1e-4);
}

TEST(Evenness, OfFewPairsSaysNothing) {
  const Columns where = places(1);
  std::vector<double> values(kPairsOfNetwork, 1.0);
  for (std::size_t k = 0; k < 19; ++k) values[k] = 0.0;
  EXPECT_EQ(evenness(where, values, 0.0), 1.0);
  for (std::size_t k = 20; k < kPairsOfNetwork; ++k) values[k] = std::nan("");
  EXPECT_EQ(evenness(where, values, 0.0), 1.0);
  EXPECT_EQ(evenness(where, std::vector<double>(kPairsOfNetwork, 74.0), 0.0), 1.0);
}

// What a scan's own artefacts may come to: certain, and of no account.
TEST(Evenness, SmallDifferencesAreTolerated) {
  const Columns where = places(1);
  std::vector<double> necks;
  for (std::size_t k = 0; k < kPairsOfNetwork; ++k)
    necks.push_back(74.0 + 3.0 * where.at("along_z")[k] + 1.0 * random_normal(3, k));
  EXPECT_LT(evenness(where, necks, 0.5), 1e-12);
  EXPECT_EQ(evenness(where, necks, 1.5), 1.0);
}

Observation network(double strain, const std::string& use) {
  Columns columns = places(1);
  const auto& z = columns.at("along_z");
  columns["joined"] = joined(columns, 2, [](std::size_t) { return 0.9; });
  for (std::size_t k = 0; k < kPairsOfNetwork; ++k) {
    columns["bead_i"].push_back(2.0 * static_cast<double>(k)),
        columns["bead_j"].push_back(2.0 * static_cast<double>(k) + 1.0);
    columns["bridge_diameter_um"].push_back(columns["joined"][k] *
                                            (74.0 + 8.0 * z[k] + 6.0 * random_normal(3, k)));
  }
  Observation found = observation(kinds::bridges(), "network", columns);
  found.numbers["strain"] = strain, found.words["use"] = use;
  return found;
}

// Necks that are thicker at the top: no effect of the library has them. Under load bridges break where they
// are loaded, and what is simulated as measured is no longer to be explained.
TEST(Evenness, IsAskedOfBridgesAtRestThatAreCompared) {
  const Observation rest = network(0.0, "compare");
  const Unlike found = rest.kind->unlike(rest);
  EXPECT_LT(found.by_chance, 1e-4);
  EXPECT_NE(found.what.find("necks"), std::string::npos) << found.what;
  const Observation loaded = network(0.02, "compare"), simulated = network(0.0, "simulate");
  EXPECT_EQ(loaded.kind->unlike(loaded).by_chance, 1.0);
  EXPECT_EQ(simulated.kind->unlike(simulated).by_chance, 1.0);
}

TEST(Evenness, OddsByItselfLeaveTheOthersTheirProportions) {
  std::vector<Hypothesis> said(3);
  said[0].id = "missing_bridges", said[1].id = kNone, said[2].id = kUnknown;
  for (auto& h : said) h.log_prior = std::log(0.2);
  said[0].log_evidence = 3.0;
  Correction correction;
  const auto before = corrected(said, correction);
  correction.odds_by_itself = 19.0;
  const auto after = corrected(said, correction);
  const auto of = [](const std::vector<Hypothesis>& all, const char* id) {
    return said_of(all, id)->probability;
  };
  const double odds = of(before, kUnknown) / (1.0 - of(before, kUnknown));
  EXPECT_NEAR(of(after, kUnknown) / (1.0 - of(after, kUnknown)), odds + 19.0, 1e-9);
  EXPECT_NEAR(of(after, "missing_bridges") / of(after, kNone),
              of(before, "missing_bridges") / of(before, kNone), 1e-9);
  EXPECT_STREQ(after.front().id.c_str(), kUnknown);
}

}  // namespace
}  // namespace pendular::diagnosis
