#include "planted_diagnosis.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/random.h"
#include "diagnosis/kinds/kind.h"

namespace pendular::test {
namespace {

using diagnosis::Columns;
using diagnosis::Diagnosis;
using diagnosis::Kind;
using diagnosis::Scale;
namespace kinds = diagnosis::kinds;

const std::vector<std::pair<std::string, std::string>> kEffects = {{"bridge_gap_spread", "\u00b5m"},
                                                                   {"bridge_diameter_spread", "\u00b5m"},
                                                                   {"missing_bridges", "fraction"},
                                                                   {"bridge_bending", "multiple"},
                                                                   {"polymer_nonlinearity", "per strain"},
                                                                   {"polymer_viscoelasticity", "fraction"},
                                                                   {"bond_damage", "share"},
                                                                   {"interface_strength", "relative"},
                                                                   {"residual_stress", "strain"},
                                                                   {"bead_friction", "\u0394\u00b5"},
                                                                   {"platen_friction", "\u0394\u00b5"},
                                                                   {"platen_tilt", "degrees"},
                                                                   {"platen_roughness", "\u00b5m"},
                                                                   {"machine_compliance", "\u00b5m/N"},
                                                                   {"funicular_bridges", "share"},
                                                                   {"position_error", "\u00b5m"},
                                                                   {"diameter_bias", "\u00b5m"},
                                                                   {"voxel_scale", "relative"},
                                                                   {"loading_rate", "ratio"}};

double draw(std::uint64_t seed, std::size_t counter) {
  return random_normal(seed, counter);
}

/// A compression test of modulus E (Pa): toe, linear part, peak at 5 %, softening, an unloading at 3 %.
Columns compression(double modulus, std::uint64_t seed, bool measured) {
  Columns columns;
  auto &strain = columns["strain"], &stress = columns["stress_pa"];
  const auto stress_at = [&](double e) {
    const double linear = modulus * std::max(0.0, e - 0.004 + 0.002 * std::exp(-e / 0.003));
    const double peak = modulus * 0.04;
    return e < 0.05 ? peak * std::tanh(linear / peak) : peak * 0.8 * std::exp(-(e - 0.05) / 0.06);
  };
  const auto add = [&](double e, double s) {
    strain.push_back(e);
    stress.push_back(s + 0.004 * modulus * 0.04 * draw(seed, strain.size()));
  };
  for (double e = 0.0; e < 0.03; e += 0.0004) add(e, stress_at(e));
  const double top = stress_at(0.03);
  for (double e = 0.03; e > 0.014; e -= 0.0004) add(e, top * (e - 0.013) / 0.017);
  for (double e = 0.014; e < 0.03; e += 0.0004) add(e, top * std::pow((e - 0.013) / 0.017, 0.9));
  for (double e = 0.03; e < 0.08; e += 0.0004) add(e, stress_at(e));
  if (measured) columns["stress_sigma_pa"] = std::vector<double>(strain.size(), 0.01 * modulus * 0.04);
  return columns;
}

Columns displacements(double share, std::uint64_t seed) {
  Columns columns;
  for (const double strain : {0.01, 0.02})
    for (std::size_t bead = 0; bead < 150; ++bead) {
      const double z = 2000.0 * random_uniform(7, bead);
      columns["strain"].push_back(strain);
      columns["bead_id"].push_back(static_cast<double>(bead));
      for (const char* name : {"x_um", "y_um", "ux_um", "uy_um"}) columns[name].push_back(0.0);
      columns["z_um"].push_back(z);
      columns["uz_um"].push_back(-share * strain * z + 1.5 * draw(seed, bead));
    }
  return columns;
}

std::vector<Columns> runs(int count, const std::function<Columns(std::uint64_t)>& make) {
  std::vector<Columns> all;
  for (int k = 0; k < count; ++k) all.push_back(make(static_cast<std::uint64_t>(k) + 10));
  return all;
}

/// Factor by which a realisation departs from the mean.
double spread(std::uint64_t seed) {
  return 1.0 + 0.04 * draw(seed, 0);
}

void add_compression(Diagnosis& d, const std::string& name, double modulus) {
  d.overlays.push_back(
      {name, &kinds::compression(), compression(modulus, 1, true),
       runs(5, [=](auto seed) { return compression(1.9 * modulus * spread(seed), seed, false); }),
       runs(4, [=](auto seed) { return compression(1.05 * modulus * spread(seed), seed, false); })});
}

void add_row(Diagnosis& d, const std::string& observation, const std::string& name, Scale scale, bool ratio,
             double from, double to) {
  diagnosis::GapRow row;
  const std::size_t k = d.gap.rows.size();
  row.observed = {observation, name, scale, ratio, ratio ? 1.2e7 : 0.01, from, to};
  row.sigma = ratio ? 0.08 : 0.002;
  row.z = 5.0 * draw(3, k);
  row.difference = row.z * row.sigma;
  row.simulated = ratio ? row.observed.value * std::exp(row.difference) : row.observed.value + row.difference;
  row.significant = std::fabs(row.z) > 2.9;
  d.gap.rows.push_back(row);
  d.noise.push_back({0.5 * row.sigma, 0.4 * row.sigma, 0.1 * row.sigma, 0.7 * row.sigma});
}

void add_curve_rows(Diagnosis& d, const std::string& name) {
  add_row(d, name, "toe_strain", Scale::aggregate, false, 0.0, 0.004);
  add_row(d, name, "toe_roundness", Scale::aggregate, true, 0.0, 0.004);
  add_row(d, name, "early_modulus", Scale::aggregate, true, 0.004, 0.01);
  add_row(d, name, "linear_modulus", Scale::aggregate, true, 0.005, 0.03);
  add_row(d, name, "linear_limit", Scale::aggregate, false, 0.005, 0.035);
  add_row(d, name, "unloading_modulus", Scale::aggregate, true, 0.014, 0.03);
  add_row(d, name, "residual_strain", Scale::aggregate, false, 0.014, 0.03);
  add_row(d, name, "loop_area", Scale::aggregate, true, 0.014, 0.03);
  add_row(d, name, "peak_strain", Scale::aggregate, false, 0.035, 0.05);
  add_row(d, name, "peak_stress", Scale::aggregate, true, 0.035, 0.05);
  add_row(d, name, "softening", Scale::aggregate, true, 0.05, 0.07);
}

/// Shares of the gap, signatures and distances that go with the rows there are.
void finish_gap(Diagnosis& d) {
  double total = 0.0;
  for (const auto& row : d.gap.rows) total += row.z * row.z;
  for (auto& row : d.gap.rows) row.share = row.z * row.z / total;
  d.gap.distance = std::sqrt(total / static_cast<double>(d.gap.rows.size()));
  d.gap.excess = std::sqrt(std::max(0.0, d.gap.distance * d.gap.distance - 1.0));
  d.gap.noise_floor = 0.08;
  d.gap.threshold = 2.9;
  const auto effects = static_cast<Eigen::Index>(d.effects.size()),
             features = static_cast<Eigen::Index>(d.gap.rows.size());
  d.signatures.resize(effects, features);
  d.separation.resize(effects, effects + 1);
  for (Eigen::Index i = 0; i < effects; ++i) {
    for (Eigen::Index j = 0; j < features; ++j)
      d.signatures(i, j) = 6.0 * draw(5, static_cast<std::size_t>(i * features + j));
    for (Eigen::Index j = 0; j <= effects; ++j)
      d.separation(i, j) = i == j ? 0.0 : std::pow(4.0 * draw(6, static_cast<std::size_t>(i * 50 + j)), 2);
  }
}

void add_explanations(Diagnosis& d) {
  const auto explain = [&](const std::string& id, double probability) {
    diagnosis::Explanation e;
    e.id = id, e.probability = probability;
    e.reduced_chi_squared = 0.8 + 10.0 * (1.0 - probability) * random_uniform(9, d.explanations.size());
    d.explanations.push_back(e);
  };
  explain("missing_bridges", 0.62);
  explain("bridge_diameter_spread", 0.21);
  explain("unknown", 0.05);
  explain("missing_bridges+platen_tilt", 0.04);
  double rest = 0.08;
  for (const auto& [id, unit] : kEffects) {
    if (id == "missing_bridges" || id == "bridge_diameter_spread") continue;
    explain(id, 0.25 * rest);
    rest -= 0.25 * rest;
  }
  for (std::size_t a = 0; a < 5; ++a)
    for (std::size_t b = a + 1; b < 5; ++b) explain(kEffects[a].first + "+" + kEffects[b].first, 1e-6);
  explain("none", 0.0);
  double sum = 0.0;
  for (const auto& e : d.explanations) sum += e.probability;
  d.explanations.back().probability = 1.0 - sum;
  for (auto& e : d.explanations) {
    if (e.id == "none" || e.id == "unknown") continue;
    const auto count = static_cast<std::size_t>(1 + std::count(e.id.begin(), e.id.end(), '+'));
    for (std::size_t k = 0; k < count; ++k) {
      e.magnitudes.push_back({0.12 + 0.1 * static_cast<double>(k), {0.08, 0.16}});
      e.units.push_back(k == 0 ? "fraction" : "degrees");
    }
  }
  auto& excluded = d.explanations[5];
  excluded.excluded = true;
  excluded.reason = "makes the simulation stiffer, which is too stiff already";
}

void add_rest(Diagnosis& d) {
  d.ambiguity_set = {"missing_bridges", "bridge_diameter_spread"};
  d.set_probability = 0.83;
  d.p_value = 0.41;
  std::vector<std::string> observations;
  for (const auto& overlay : d.overlays) observations.push_back(overlay.observation);
  for (std::size_t k = 0; k < observations.size(); ++k) {
    const double at = 0.12 + 0.02 * draw(11, k);
    d.groups.push_back({"missing_bridges", observations[k], {at, {at - 0.05, at + 0.05}}});
    d.groups.push_back({"bridge_diameter_spread", observations[k], {90 * at, {80 * at, 110 * at}}});
  }
  for (const char* key : {"bridges.youngs_modulus_pa", "contact.friction", "specimen.diameter_um"})
    d.pulls.push_back({key, 1.0, draw(12, d.pulls.size()), 0.7, 2.0 * random_uniform(13, d.pulls.size())});
  d.fitted = {4.2, 0.6, 0.86, {0.8, 0.91}, {observations[0]}};
  d.withheld = {3.6, 0.93, 0.74, {0.61, 0.83}, {observations.begin() + 1, observations.end()}};
  d.retuned = 0.22, d.wrong = -0.08, d.wrong_effect = "platen_tilt";
  d.next.now = {200, 3.2, 1.4, 0.2, {}};
  d.next.experiments = {
      {"twenty single bridges, pulled and sheared",
       "their stiffness over diameter tells the spread of diameters from missing bridges",
       0.5,
       {200, 1.4, 0.4, 0.8, {}},
       1.0},
      {"a second specimen of twice the height, with the same polymer and the same bead batch, compressed "
       "at a tenth of the speed with three unloadings",
       "compliance falls with height",
       2.0,
       {200, 2.5, 1.1, 0.3, {}},
       0.3},
      {"a second scan at 2 % of platen strain", "the displacement of every bead", 1.5, {}, 0.0, 120}};
  for (int k = 0; k < 30; ++k)
    d.ledger.push_back({"0123456789abcdef" + std::to_string(k), k < 6 ? "baseline" : "missing_bridges 0.1",
                        k == 7 ? "failed" : "done", k == 7 ? "diverged at 2.1 % strain" : "", 0});
  d.provenance = {"0.1.0", "pendular diagnose experiment.toml", 1, {{"experiment.toml", "ab12"}}};
}

void add_coordination(Diagnosis& d) {
  d.overlays.push_back({"Z",
                        &kinds::coordination(),
                        {{"z", {5.1}}, {"z_sigma", {0.1}}},
                        runs(5,
                             [](auto seed) {
                               return Columns{{"z", {6.4 * spread(seed)}}};
                             }),
                        runs(4, [](auto seed) {
                          return Columns{{"z", {5.3 * spread(seed)}}};
                        })});
  add_row(d, "Z", "coordination", Scale::network, true, 0.0, 0.0);
}

void add_displacements(Diagnosis& d) {
  d.overlays.push_back({"scan",
                        &kinds::displacements(),
                        displacements(0.85, 2),
                        runs(5, [](auto seed) { return displacements(spread(seed), seed); }),
                        {}});
  for (const char* name : {"deviatoric_share", "tilt_share", "wandering"})
    add_row(d, "scan", name, Scale::network, false, 0.0, 0.02);
}

Columns line(const std::string& x, const std::string& y, const std::string& sd, std::vector<double> at,
             double factor) {
  Columns columns{{x, at}};
  for (const double v : at) columns[y].push_back(factor * v), columns[sd].push_back(0.05 * factor * v);
  return columns;
}

Columns sample(const std::string& name, double mean, double sd, std::uint64_t seed) {
  Columns columns;
  for (std::size_t k = 0; k < 40; ++k) columns[name].push_back(mean + sd * draw(seed, k));
  return columns;
}

Diagnosis with_effects() {
  Diagnosis d;
  d.experiment = "two heights, one polymer";
  d.verdict =
      "The simulation is 1.9 times too stiff; the noise floor is 8 %. Most of the gap is the linear modulus. "
      "Missing bridges or a spread of bridge diameters, 0.83 together, cannot be told apart here; adding "
      "missing bridges closes 74 % (61 to 83 %) of the gap on withheld data, retuning the polymer's modulus "
      "22 "
      "%. Next: twenty single bridges, 91 % to decide.";
  d.warnings = {"observation \"B\": stress_sigma_pa is zero and counts as not given"};
  for (const auto& [id, unit] : kEffects) d.effects.push_back(id);
  add_compression(d, "A", 1.2e7);
  add_curve_rows(d, "A");
  add_compression(d, "B", 0.6e7);
  add_curve_rows(d, "B");
  add_coordination(d);
  add_displacements(d);
  return d;
}

void finish(Diagnosis& d) {
  finish_gap(d);
  add_explanations(d);
  add_rest(d);
}

}  // namespace

Diagnosis planted_diagnosis() {
  Diagnosis d = with_effects();
  finish(d);
  return d;
}

Diagnosis crowded_diagnosis() {
  Diagnosis d = with_effects();
  add_compression(d, "a taller specimen of the second batch, slowly", 1e7);
  add_curve_rows(d, "a taller specimen of the second batch, slowly");
  const auto add = [&](const std::string& name, const Kind& kind,
                       const std::function<Columns(double, std::uint64_t)>& make) {
    d.overlays.push_back({name, &kind, make(1.0, 1),
                          runs(24, [&](auto seed) { return make(1.3 * spread(seed), seed); }),
                          runs(4, [&](auto seed) { return make(1.02 * spread(seed), seed); })});
    add_row(d, name, kind.name + "_level", Scale::bridge, true, 0.0, 0.0);
  };
  add("E(Ep)", kinds::modulus_series(), [](double f, auto) {
    return line("E_p_pa", "modulus_pa", "modulus_sigma_pa", {5e5, 1.5e6, 6e6}, 10.0 * f);
  });
  add("kn(d)", kinds::bridge_stiffness(), [](double f, auto) {
    auto columns = line("d_um", "kn_n_per_m", "kn_sigma_n_per_m", {80, 60, 70, 90, 100}, 1.5 * f);
    for (const double v : columns["kn_n_per_m"]) columns["kt_n_per_m"].push_back(0.4 * v);
    return columns;
  });
  add("necks", kinds::bridge_diameters(),
      [](double f, auto seed) { return sample("d_um", 74 * f, 12, seed); });
  add("gaps", kinds::bridge_gaps(), [](double f, auto seed) { return sample("gap_um", 2 * f, 0.3, seed); });
  add("lateral", kinds::lateral_strain(), [](double f, auto) {
    return line("strain", "lateral_strain", "sigma", {0.005, 0.01, 0.015, 0.02, 0.025, 0.03}, 0.3 * f);
  });
  add("breaks", kinds::broken_bonds(), [](double f, auto) {
    return line("strain", "count", "", {0.01, 0.02, 0.03, 0.04, 0.05}, 2000.0 * f);
  });
  for (int k = 0; k < 6; ++k) d.effects.push_back("further_effect_number_" + std::to_string(k));
  finish(d);
  return d;
}

Diagnosis quiet_diagnosis() {
  Diagnosis d;
  d.experiment = "one curve";
  d.verdict = "Nothing differs beyond noise.";
  d.overlays.push_back({"A",
                        &kinds::compression(),
                        compression(1e7, 1, false),
                        runs(2, [](auto seed) { return compression(1e7 * spread(seed), seed, false); }),
                        {}});
  add_row(d, "A", "linear_modulus", Scale::aggregate, true, 0.005, 0.03);
  d.gap.rows[0].significant = false;
  d.gap.threshold = 2.0;
  d.explanations = {{"none", 0.7, {}, {}, 1.1, false, ""}, {"unknown", 0.3, {}, {}, 0.0, false, ""}};
  d.ambiguity_set = {"none"};
  d.set_probability = 0.7;
  return d;
}

Diagnosis named_throughout(const std::string& text) {
  Diagnosis d = planted_diagnosis();
  d.experiment = d.verdict = d.wrong_effect = text;
  d.warnings = {text};
  for (auto& row : d.gap.rows) row.observed.observation = row.observed.name = text;
  for (auto& overlay : d.overlays) overlay.observation = text;
  for (auto& effect : d.effects) effect = text;
  for (auto& e : d.explanations) {
    if (e.id != "none" && e.id != "unknown") e.id = text;
    e.reason = text;
    for (auto& unit : e.units) unit = text;
  }
  d.ambiguity_set = {text};
  for (auto& group : d.groups) group.effect = group.group = text;
  for (auto& pull : d.pulls) pull.key = text;
  for (auto* s : {&d.fitted, &d.withheld}) s->observations = {text};
  for (auto& next : d.next.experiments) next.observation = next.why = text;
  for (auto& row : d.ledger) row.hash = row.purpose = row.status = row.message = text;
  d.provenance = {text, text, 1, {{text, text}}};
  d.gap.rows[0].z = std::numeric_limits<double>::quiet_NaN();
  d.gap.rows[1].difference = std::numeric_limits<double>::infinity();
  d.fitted.fraction = std::numeric_limits<double>::quiet_NaN();
  return d;
}

}  // namespace pendular::test
