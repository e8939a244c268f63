#include "blind/case_folder.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/path_kind.h"
#include "base/provenance.h"
#include "base/random.h"
#include "blind/engine.h"
#include "blind/instruments.h"
#include "blind/mechanism.h"
#include "blind/scans.h"
#include "dem_core/drive/run_length.h"
#include "effects/list.h"
#include "packing/tables.h"

namespace pendular::blind {
namespace {

using nlohmann::ordered_json;

/// Of every file of a case: it must not tell the truth.
Provenance case_provenance() {
  return {program_version(), "pendular blind make", 0, {}};
}

const SharedPacking& packing_of(const Split& split, const CasePlan& plan) {
  return split.packings[plan.packing];
}

/// Seeds of a packing's two specimens.
std::uint64_t seed_of(const SharedPacking& packing, std::uint64_t specimen) {
  return random_bits(packing.seed, specimen) >> 1;
}

ordered_json sealed_json(const Split& split, const CasePlan& plan, const std::string& engine,
                         const ordered_json& noise) {
  ordered_json json;
  json["case"] = plan.name;
  json["split"] = {{"name", split.name}, {"seed", split.seed}, {"sha256", split.content}};
  json["salt"] = plan.salt;
  json["seed"] = plan.seed;
  json["stratum"] = to_string(plan.stratum);
  json["answer"] = right_answer(plan);
  json["effects"] = ordered_json::array();
  for (const auto& effect : effects::all_effects())
    if (const auto found = plan.effects.find(effect.id); found != plan.effects.end())
      json["effects"].push_back({{"id", effect.id}, {"theta", found->second}, {"unit", effect.unit}});
  if (!plan.mechanism.empty()) {
    const Mechanism& mechanism = find_mechanism(plan.mechanism, plan.name);
    json["mechanism"] = {{"id", mechanism.id},
                         {"kind", mechanism.kind},
                         {"theta", plan.mechanism_theta},
                         {"unit", mechanism.unit}};
  }
  json["hidden"] = plan.hidden;
  json["observed"] = to_string(plan.observed);
  json["law"] = plan.law;
  if (!plan.engine.empty()) json["engine"] = {{"name", plan.engine}, {"program", engine}};
  json["packing"] = plan.packing + 1;
  const Sample believed = believed_a(split, packing_of(split, plan));
  for (const auto& [key, offset] : plan.offsets)
    json["beliefs"][key] = {{"believed", sample_key(believed, key)},
                            {"sigma", split.uncertainty.at(key)},
                            {"off_by_sigmas", offset}};
  json["noise"] = noise;
  json["provenance"] = {{"version", program_version()}};
  return json;
}

std::string observation_toml(const std::string& kind, const std::string& name, const std::string& beads,
                             const std::string& set = "") {
  std::string text =
      fmt::format("\n[[observation]]\nkind = \"{}\"\nname = \"{}\"\nfile = \"{}.csv\"\n", kind, name, name);
  if (!set.empty()) text += fmt::format("set = {{ {} }}\n", set);
  if (!beads.empty()) text += fmt::format("beads = \"{}\"\n", beads);
  return text;
}

std::string experiment_toml(const Split& split, const CasePlan& plan) {
  const SharedPacking& packing = packing_of(split, plan);
  std::string text =
      fmt::format("[experiment]\nname = \"{}\"\nsample = \"sample.toml\"\n\n[uncertainty]\n", plan.name);
  for (const auto& [key, sigma] : split.uncertainty) text += fmt::format("\"{}\" = {}\n", key, sigma);
  text += observation_toml("compression", "A", "A_beads.csv");
  if (plan.short_specimen())
    text +=
        observation_toml("compression", "B", "B_beads.csv",
                         fmt::format("\"specimen.height_um\" = {:.10g}, \"bridges.youngs_modulus_pa\" = {}",
                                     1e6 * packing.short_height, packing.short_youngs_modulus));
  for (const auto& kind : plan.kinds) {
    const bool of_polymer = kind == "bridge_stiffness" || kind == "bridge_diameters" || kind == "bridge_gaps";
    text += observation_toml(kind, kind, of_polymer ? "" : "A_beads.csv");
  }
  if (plan.scanned()) text += observation_toml("displacements", "displacements", "A_beads.csv");
  if (plan.bridges_at_rest) text += observation_toml("bridges", "bridges_rest", "A_beads.csv");
  if (plan.bridges_under_load)
    text += observation_toml("bridges", "bridges_load", "A_beads.csv") +
            fmt::format("strain = {}\n", packing.scan_strain);
  return text;
}

/// A specimen of the case, as it is reported and measured, and its test.
struct Tested {
  Packing reported;
  std::vector<Bead> measured;
  TrueTest test;
};

/// Its measured beads go to the case's folder.
Tested tested(const CaseFolders& folders, const Split& split, const CasePlan& plan, const char* name,
              const Sample& believed, std::uint64_t number, const fs::path& part) {
  const std::uint64_t seed = seed_of(packing_of(split, plan), number);
  const Packing beads = reported_beads(plan, split, believed, seed, number);
  const auto measured = measured_beads(beads, seed, split);
  write_beads(part / fmt::format("{}_beads.csv", name), measured, case_provenance());
  const bool is_a = number == 0;
  const double scan_at = is_a && plan.scanned() ? packing_of(split, plan).scan_strain : 0.0;
  return {beads, measured,
          run_truth(plan, split, believed, beads, number, is_a, scan_at, folders.work(plan.name) / "run")};
}

/// What the scans of A show, into the case's folder.
void write_scans(const Split& split, const CasePlan& plan, const Tested& a, const fs::path& part,
                 ordered_json& noise) {
  const ScannedSpecimen specimen{plan, split, a.reported, a.measured, a.test};
  const auto write_network = [&](const std::string& name, const std::set<std::pair<int, int>>& standing) {
    write_bridges(part / (name + ".csv"), a.measured, measured_bridges(specimen, name, standing, noise),
                  case_provenance());
  };
  if (plan.scanned())
    write_text(part / "displacements.csv",
               csv_text(followed_beads(specimen, packing_of(split, plan).scan_strain, noise)));
  if (plan.bridges_at_rest) write_network("bridges_rest", bridges_at_rest(a.test));
  if (plan.bridges_under_load) write_network("bridges_load", a.test.scan.standing);
}

}  // namespace

bool is_made(const CaseFolders& folders, const Split& split, const CasePlan& plan) {
  if (!is_there(folders.open(plan.name)) || !is_there(folders.sealed(plan.name))) return false;
  const auto json = ordered_json::parse(read_text(folders.sealed(plan.name)), nullptr, false);
  if (json.is_discarded() || !json.contains("split") || json["split"].value("sha256", "") != split.content)
    bad_input("{}: found a case of another split, seed or version, expected one of {} with seed {}",
              folders.sealed(plan.name).string(), split.file.string(), split.seed);
  return true;
}

void make_case(const CaseFolders& folders, const Split& split, const CasePlan& plan) {
  const fs::path part = folders.work(plan.name) / "case", done = folders.open(plan.name);
  for (const fs::path& inner : {folders.work(plan.name), folders.sealed(plan.name), done})
    make_inner_folder(inner.parent_path());
  fs::remove_all(folders.work(plan.name));
  fs::remove_all(done);
  make_folder(part);

  const SharedPacking& packing = packing_of(split, plan);
  const Tested a = tested(folders, split, plan, "A", believed_a(split, packing), 0, part);
  std::optional<Tested> b;
  if (plan.short_specimen()) b = tested(folders, split, plan, "B", believed_b(split, packing), 1, part);
  ordered_json noise;
  for (const auto& [name, table] : observe(plan, split, a.test, b ? &b->test : nullptr, noise))
    write_text(part / (name + ".csv"), csv_text(table));
  write_scans(split, plan, a, part, noise);
  write_text(part / "sample.toml", sample_text(believed_a(split, packing)));
  write_text(part / "experiment.toml", experiment_toml(split, plan));

  const std::string truth = sealed_json(split, plan, a.test.engine, noise).dump(2) + "\n";
  write_text(part / "seal.txt", fmt::format("{}  {}.json\n", sha256(truth), plan.name));
  write_text(folders.sealed(plan.name), truth);
  rename_durably(part, done);
  fs::remove_all(folders.work(plan.name));
}

std::string published_seal(const fs::path& case_folder) {
  const std::string text = read_text(case_folder / "seal.txt");
  std::string hash = text.substr(0, text.find(' '));
  if (hash.size() != 64)
    bad_input("{}: found \"{}\", expected a SHA-256", (case_folder / "seal.txt").string(),
              hash.substr(0, 80));
  return hash;
}

double expected_particle_steps(const Split& split, const CasePlan& plan) {
  const auto work = [&](Sample sample, double unloading) {
    sample.compression.max_strain = split.max_strain;
    const double section = 0.25 * M_PI * sample.specimen.diameter * sample.specimen.diameter;
    const double beads = sample.specimen.volume_fraction * section * sample.specimen.height /
                         (M_PI / 6.0 * std::pow(sample.beads.diameter, 3));
    return beads * dem_core::expected_steps(sample) * unloading;
  };
  constexpr double kUnloading = 1.5;  // what an unloading, and runs to find its strain, add
  const SharedPacking& packing = packing_of(split, plan);
  double steps = work(believed_a(split, packing), kUnloading);
  if (plan.short_specimen()) steps += work(believed_b(split, packing), 1.1);
  constexpr double kYadeSlower = 40.0;  // per particle-step
  const bool outside = !plan.engine.empty() && find_engine(plan.engine, plan.name).outside();
  return outside ? kYadeSlower * steps : steps;
}

}  // namespace pendular::blind
