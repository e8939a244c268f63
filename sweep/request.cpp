#include "sweep/request.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/model_version.h"
#include "effects/list.h"
#include "packing/measurement.h"
#include "packing/vtp.h"

namespace pendular::sweep {

PackingSource packing_file(const fs::path& path) {
  PackingSource source;
  const auto beads = read_packing(path).beads;
  source.beads = beads.size();
  source.errors_stated = states_errors(beads);
  source.sha256 = sha256_of(path);
  source.file = path;
  return source;
}

PackingSource generated_packing(std::uint64_t seed) {
  PackingSource source;
  source.seed = seed;
  return source;
}

namespace {

SampleValue value_of(const nlohmann::json& json) {
  if (json.is_number()) return json.get<double>();
  if (json.is_boolean()) return json.get<bool>();
  if (json.is_string()) return json.get<std::string>();
  return json.get<std::vector<double>>();
}

}  // namespace

std::string request_text(const RunRequest& request) {
  nlohmann::ordered_json packing;
  if (request.packing.sha256.empty())
    packing["seed"] = request.packing.seed;
  else
    packing["sha256"] = request.packing.sha256;
  nlohmann::ordered_json sample;
  for (const auto& [key, value] : sample_settings(request.sample)) {
    // Stores are older than these keys: a request without them has what they have by default.
    if (key == "contact.glass" && request.sample.contact.glass == Sample{}.contact.glass) continue;
    if (key == "bridges.breaking" && request.sample.bridges.breaking == Sample{}.bridges.breaking) continue;
    std::visit([&, name = key](const auto& held) { sample[name] = held; }, value);
  }
  nlohmann::ordered_json json = {{"model", kModelVersion},
                                 {"packing", packing},
                                 {"seed", request.seed},
                                 {"keep", request.keep_all ? "all" : "curve"},
                                 {"sample", sample}};
  for (const auto& effect : effects::all_effects())
    if (!effect.code.empty() && request.sample.effects.contains(effect.id))
      json["code"][effect.id] = effect.code;
  return json.dump(2) + "\n";
}

RunRequest parse_request(const std::string& text, const std::string& where) {
  try {
    const auto json = nlohmann::json::parse(text);
    RunRequest request;
    std::vector<SampleSetting> settings;
    for (const auto& [key, value] : json.at("sample").items()) settings.emplace_back(key, value_of(value));
    request.sample = parse_sample("", where, settings);
    request.packing.sha256 = json.at("packing").value("sha256", "");
    request.packing.seed = json.at("packing").value("seed", std::uint64_t{1});
    request.seed = json.at("seed").get<std::uint64_t>();
    request.keep_all = json.at("keep").get<std::string>() == "all";
    return request;
  } catch (const nlohmann::json::exception&) {
    bad_input("{}: is damaged, expected a request of pendular sweep", where);
  }
}

std::string content_hash(const RunRequest& request) {
  return sha256(request_text(request));
}

std::string packing_hash(const RunRequest& request) {
  if (!request.packing.sha256.empty()) return request.packing.sha256;
  // What generate_packing() reads.
  std::string text = fmt::format("pendular model {} packing {}\n", kModelVersion, request.packing.seed);
  for (const char* key : {"beads.diameter_um", "beads.diameter_sd_um", "specimen.diameter_um",
                          "specimen.height_um", "specimen.volume_fraction"})
    text += fmt::format("{} = {}\n", key, sample_key(request.sample, key));
  return sha256(text);
}

}  // namespace pendular::sweep
