#include "blind/verdict.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/csv.h"
#include "base/error.h"
#include "base/path_kind.h"
#include "blind/case_folder.h"

namespace pendular::blind {
namespace {

using nlohmann::json;

constexpr double kNearly = 0.35;      // of the logarithm of a magnitude, over which runs stand for it
constexpr double kLeastWeight = 0.1;  // of such runs together, below which none does
constexpr double kNowhere = std::numeric_limits<double>::infinity();
constexpr const char* kMark = "without_truth.txt";

json parsed(const fs::path& path) {
  json read = json::parse(read_text(path), nullptr, false);
  if (read.is_discarded()) bad_input("{}: is no JSON", path.string());
  return read;
}

/// Reads with `take`; what the JSON library finds wrong is said of the file.
template <typename Result, typename Take>
Result read_json(const fs::path& path, const Take& take) {
  const json read = parsed(path);
  try {
    return take(read);
  } catch (const json::exception& error) {
    bad_input("{}: {}", path.string(), error.what());
  }
}

std::optional<double> number_in(const json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_number()) return std::nullopt;
  return found->get<double>();
}

std::optional<bool> flag_in(const json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_boolean()) return std::nullopt;
  return found->get<bool>();
}

/// Zero where nothing is said of a sign, infinite where null is.
double least_told(const json& from, const char* sign) {
  return from.contains(sign) ? number_in(from, sign).value_or(kNowhere) : 0.0;
}

Claim claim_of(const json& hypothesis) {
  Claim claim;
  claim.probability = hypothesis.at("probability").get<double>();
  claim.magnitude = number_in(hypothesis, "magnitude");
  const auto interval = hypothesis.find("interval_90");
  if (interval != hypothesis.end() && interval->is_array() && interval->size() == 2 &&
      (*interval)[0].is_number() && (*interval)[1].is_number())
    claim.interval_90 = {(*interval)[0].get<double>(), (*interval)[1].get<double>()};
  return claim;
}

void read_shrinkage(Diagnosed& said, const json& shrinkage) {
  const auto withheld = shrinkage.find("withheld");
  // Nothing withheld, nothing to close.
  if (withheld == shrinkage.end() || number_in(*withheld, "before").value_or(0.0) <= 0.0) return;
  said.withheld = number_in(*withheld, "fraction");
  const auto controls = shrinkage.find("controls");
  if (controls == shrinkage.end()) return;
  said.retuned = number_in(*controls, "modulus_retuned");
  said.wrong_effect = number_in(*controls, "wrong_effect");
}

/// Share of the replayed cases of one sort; nothing where there are none.
std::optional<double> share_of(const json& promise, const char* sort, const char* what) {
  const json found = promise.value(sort, json::object());
  if (found.value("cases", 0) <= 0) return std::nullopt;
  return found.at(what).get<double>() / found.at("cases").get<double>();
}

void read_promise(Diagnosed& said, const json& promise) {
  const auto in_set = number_in(promise, "in_set"), size = number_in(promise, "set_size"),
             theta = number_in(promise, "theta_held"), alarms = number_in(promise, "false_alarms");
  if (in_set && size && theta && alarms) said.promised = {*in_set, *size, *theta, *alarms};
  said.promised_of_none = share_of(promise, "none", "in_set");
  said.promised_flagged = share_of(promise, "outside", "flagged");
  said.promised_pairs = share_of(promise, "pairs", "in_set");
  const json effects = promise.value("effects", json::object());  // items() does not keep it alive
  for (const auto& [id, replayed] : effects.items()) {
    if (const auto from = replayed.find("told_from"); from != replayed.end())
      said.told_from[id] = {least_told(*from, "negative"), least_told(*from, "positive")};
    const json runs = replayed.value("runs", json::array());
    for (const auto& run : runs)
      said.replayed[id].push_back(
          {run.at("magnitude").get<double>(), flag_in(run, "in_set"), flag_in(run, "first")});
  }
}

/// The last column is the distance from none.
void read_separation(Diagnosed& said, const json& separation) {
  const auto effects = separation.at("effects").get<std::vector<std::string>>();
  const json& rows = separation.at("squared_distance");
  for (std::size_t a = 0; a < effects.size(); ++a)
    for (std::size_t b = 0; b <= effects.size(); ++b)
      if (const json& value = rows.at(a).at(b); value.is_number() && a != b)
        said.squared_distance[effects[a]][b < effects.size() ? effects[b] : "none"] = value.get<double>();
}

/// Share of the replayed runs of a case's one effect, the nearer in magnitude the heavier. Nothing where all
/// are larger: less is harder to tell.
std::optional<double> share_near(const Verdict& verdict, std::optional<bool> Diagnosed::Run::*what) {
  if (!verdict.said || verdict.truth.effects.size() != 1) return std::nullopt;
  const auto& [id, theta] = verdict.truth.effects.front();
  const auto found = verdict.said->replayed.find(id);
  if (found == verdict.said->replayed.end()) return std::nullopt;
  double weights = 0.0, share = 0.0;
  bool as_small = false;
  for (const auto& run : found->second) {
    if (run.magnitude * theta <= 0.0 || !(run.*what)) continue;
    as_small |= std::fabs(run.magnitude) <= (1.0 + 1e-9) * std::fabs(theta);
    const double apart = std::log(run.magnitude / theta) / kNearly;
    const double weight = std::exp(-0.5 * apart * apart);
    weights += weight, share += *(run.*what) ? weight : 0.0;
  }
  if (!as_small || weights < kLeastWeight) return std::nullopt;
  return share / weights;
}

std::optional<double> read_oracle(const fs::path& path) {
  if (!is_there(path)) return std::nullopt;
  return read_json<std::optional<double>>(path, [](const json& read) { return number_in(read, "fraction"); });
}

std::string farthest_belief(const json& truth) {
  std::string key;
  double farthest = 0.0;
  const json beliefs = truth.value("beliefs", json::object());  // items() does not keep it alive
  for (const auto& [name, belief] : beliefs.items())
    if (const double off = belief.at("off_by_sigmas").get<double>(); std::fabs(off) > std::fabs(farthest))
      key = name, farthest = off;
  return key.empty() ? "" : fmt::format("{} {:+.2g} sigma", key, farthest);
}

}  // namespace

std::string in_order(const std::string& id) {
  const auto plus = id.find('+');
  if (plus == std::string::npos) return id;
  const std::string first = id.substr(0, plus), second = id.substr(plus + 1);
  return first < second ? id : second + "+" + first;
}

std::optional<double> Verdict::promised_in_set() const {
  if (said && truth.effects.empty()) return said->promised_of_none;
  return share_near(*this, &Diagnosed::Run::in_set);
}

std::optional<double> Verdict::promised_first() const {
  return share_near(*this, &Diagnosed::Run::first);
}

std::optional<double> Verdict::promised_flagged() const {
  if (!said || truth.mechanism.empty()) return std::nullopt;
  return said->promised_flagged;
}

std::optional<double> Verdict::promised_pairs() const {
  if (!said || truth.effects.size() != 2) return std::nullopt;
  return said->promised_pairs;
}

std::string Verdict::top() const {
  if (!said) return "";
  const auto best = std::max_element(
      said->claims.begin(), said->claims.end(),
      [](const auto& a, const auto& b) { return a.second.probability < b.second.probability; });
  return best->first;
}

double Verdict::probability(const std::string& id) const {
  if (!said) return 0.0;
  const auto found = said->claims.find(id);
  return found == said->claims.end() ? 0.0 : found->second.probability;
}

bool Verdict::in_set(const std::string& id) const {
  return said && std::find(said->set.begin(), said->set.end(), id) != said->set.end();
}

bool Verdict::untold(const std::string& effect, double theta) const {
  if (!said) return false;
  const auto from = said->told_from.find(effect);
  if (from == said->told_from.end()) return false;
  return std::fabs(theta) < (theta < 0.0 ? from->second.first : from->second.second);
}

bool Verdict::set_is_right() const {
  if (in_set(answer)) return true;
  const auto& effects = truth.effects;
  return effects.size() == 1 && answer == effects.front().first && in_set("none") &&
         untold(answer, effects.front().second);
}

bool without_truth(const fs::path& reports) {
  return is_there(reports / kMark);
}

void mark_without_truth(const fs::path& reports) {
  write_text(reports / kMark, "Each case's true effects were left out of the library.\n");
}

Truth read_truth(const fs::path& sealed) {
  return read_json<Truth>(sealed, [&](const json& read) {
    Truth truth;
    truth.name = read.at("case").get<std::string>();
    truth.stratum = stratum_of(read.at("stratum").get<std::string>(), sealed.string());
    truth.answer = in_order(read.at("answer").get<std::string>());
    for (const auto& effect : read.at("effects"))
      truth.effects.emplace_back(effect.at("id").get<std::string>(), effect.at("theta").get<double>());
    if (read.contains("mechanism")) {
      truth.mechanism = read["mechanism"].at("id").get<std::string>();
      truth.mechanism_theta = read["mechanism"].at("theta").get<double>();
    }
    truth.law = read.at("law").get<std::string>();
    if (read.contains("engine")) truth.law = read["engine"].at("name").get<std::string>();
    if (truth.stratum == Stratum::wrong_belief) truth.wrong_belief = farthest_belief(read);
    truth.packing = read.at("packing").get<std::size_t>();
    truth.hidden = read.value("hidden", false);
    if (!read.contains("observed"))
      bad_input(
          "{}: observed: is missing, expected what was measured (splits of earlier versions have to be made "
          "anew)",
          sealed.string());
    truth.observed = observed_of(read.at("observed").get<std::string>(), sealed.string());
    return truth;
  });
}

std::vector<Truth> open_seals(const fs::path& folder) {
  const CaseFolders folders{folder};
  const CsvTable seals = read_csv(folders.seals(), {"case", "sha256"});
  std::vector<Truth> truths;
  for (std::size_t k = 0; k < seals.rows(); ++k) {
    const std::string &name = seals.texts("case")[k], &hash = seals.texts("sha256")[k];
    const fs::path sealed = folders.sealed(name);
    if (!is_there(sealed))
      bad_input("{}: is missing, expected the truth of a case of {}", sealed.string(),
                folders.seals().string());
    const std::string found = sha256_of(sealed);
    const bool open_too = is_there(folders.open(name));
    if (found != hash || (open_too && published_seal(folders.open(name)) != found))
      bad_input("{}: found a file of SHA-256 {}, expected the one that was published, {}", sealed.string(),
                found, hash);
    truths.push_back(read_truth(sealed));
    if (truths.back().name != name)
      bad_input("{}: found the truth of {}, expected that of {}", sealed.string(), truths.back().name, name);
  }
  if (truths.empty()) bad_input("{}: found no case", folders.seals().string());
  return truths;
}

Diagnosed read_diagnosis(const fs::path& path) {
  return read_json<Diagnosed>(path, [&](const json& read) {
    Diagnosed said;
    for (const auto& hypothesis : read.at("hypotheses"))
      said.claims[in_order(hypothesis.at("id").get<std::string>())] = claim_of(hypothesis);
    if (said.claims.empty()) bad_input("{}: hypotheses: found none", path.string());
    for (const auto& id : read.at("ambiguity_set")) said.set.push_back(in_order(id.get<std::string>()));
    read_shrinkage(said, read.at("shrinkage"));
    if (const auto nearest = read.find("nearest_signature"); nearest != read.end() && nearest->is_string())
      said.nearest_signature = in_order(nearest->get<std::string>());
    if (read.contains("promise")) read_promise(said, read["promise"]);
    if (read.contains("unseen"))
      for (const auto& one : read["unseen"])
        if (const auto limit = number_in(one, "limit_95"))
          said.limits[one.at("effect").get<std::string>()] = *limit;
    if (read.contains("separation")) read_separation(said, read["separation"]);
    return said;
  });
}

std::vector<Verdict> verdicts(const std::vector<Truth>& truths, const fs::path& reports) {
  if (!is_folder(reports)) bad_input("{}: no such folder, expected one of reports", reports.string());
  const bool left_out = without_truth(reports);
  std::vector<Verdict> all;
  for (const auto& truth : truths) {
    if (left_out && truth.effects.empty()) continue;
    Verdict verdict{truth, left_out ? "unknown" : truth.answer, std::nullopt, ""};
    const fs::path path = reports / truth.name / "diagnosis.json";
    try {
      if (is_there(path)) {
        verdict.said = read_diagnosis(path);
        verdict.said->closable = read_oracle(reports / truth.name / kOracle);
      } else {
        verdict.failure = "no diagnosis.json";
      }
    } catch (const BadInput& error) {
      verdict.failure = error.what();
    }
    all.push_back(std::move(verdict));
  }
  return all;
}

}  // namespace pendular::blind
