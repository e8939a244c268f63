#include "base/error.h"

#include <nlohmann/json.hpp>
#include "base/progress.h"
#include "cli/command.h"
#include "cli/option_checks.h"
#include "cli/picture_commands.h"
#include "packing/bridges.h"
#include "packing/tables.h"
#include "segmentation/qa/qa.h"
#include "segmentation/segment.h"
#include "volume/format.h"

namespace pendular::cli {
namespace {

struct SegmentOptions {
  Common common;
  fs::path volume, bridges, labels, qa;
  double voxel_um = 0.0, min_diameter_um = 0.0;
  std::vector<std::size_t> size;
  std::string type, tone = "auto";
  double false_discoveries = segmentation::BridgeOptions().false_discoveries;
  bool calibrate_bridges = false;
  segmentation::SegmentOptions segment;
};

ReadOptions reading(const SegmentOptions& options) {
  ReadOptions reading;
  if (options.voxel_um > 0.0) reading.spacing = options.voxel_um * 1e-6;
  if (options.size.empty() != options.type.empty())
    throw BadUsage("headerless data needs both --size and --type");
  if (!options.size.empty()) reading.raw_size = {options.size[0], options.size[1], options.size[2]};
  reading.raw_type = options.type;
  return reading;
}

segmentation::SegmentOptions choices(const SegmentOptions& options) {
  segmentation::SegmentOptions segment = options.segment;
  if (!options.bridges.empty()) segment.bridges = {options.false_discoveries, options.calibrate_bridges};
  segment.tone = options.tone == "bright" ? segmentation::BeadTone::bright
                 : options.tone == "dark" ? segmentation::BeadTone::dark
                                          : segmentation::BeadTone::automatic;
  if (options.min_diameter_um > 0.0) segment.least_diameter = options.min_diameter_um * 1e-6;
  return segment;
}

nlohmann::ordered_json to_json(const Specimen& specimen) {
  return {{"diameter_um", specimen.diameter * 1e6},
          {"height_um", specimen.height * 1e6},
          {"axis_x_um", specimen.axis_x * 1e6},
          {"axis_y_um", specimen.axis_y * 1e6},
          {"bottom_um", specimen.bottom * 1e6}};
}

nlohmann::ordered_json to_json(const segmentation::BridgeSummary& bridges) {
  nlohmann::ordered_json json = {{"pairs", bridges.pairs},
                                 {"bridges", bridges.bridges},
                                 {"none", bridges.none},
                                 {"undetermined", bridges.undetermined},
                                 {"hidden", bridges.unseen},
                                 {"noise_scatter", bridges.noise_scatter},
                                 {"polymer_seen", bridges.polymer_seen}};
  if (!bridges.polymer_seen) return json;
  json["polymer_contrast"] = bridges.contrast;
  json["sigma_polymer_contrast"] = bridges.sigma_contrast;
  json["share_of_pairs"] = bridges.share;
  json["bridge_diameter_um"] = 1e6 * bridges.diameter;
  json["bridge_diameter_sd_um"] = 1e6 * bridges.diameter_sd;
  for (const auto& size : bridges.injected)
    json["injected"].push_back({{"bridge_diameter_um", 1e6 * size.diameter},
                                {"injected", size.injected},
                                {"found", size.found},
                                {"measured_um", 1e6 * size.measured},
                                {"rms_error_um", 1e6 * size.rms_error}});
  return json;
}

nlohmann::ordered_json summary(const Volume& volume, const segmentation::Segmentation& result,
                               const Provenance& provenance) {
  const auto& levels = result.levels;
  nlohmann::ordered_json json = {
      {"beads", result.beads.size()},
      {"candidate_bridges", result.bridges.size()},
      {"rejected", result.rejected},
      {"irregular_grains", result.grains.size()},
      {"mean_diameter_um", mean_diameter(result.beads) * 1e6},
      {"specimen", result.specimen ? to_json(*result.specimen) : nlohmann::ordered_json(nullptr)},
      {"porosity", result.porosity},
      {"measured_bridges", result.measured ? to_json(*result.measured) : nlohmann::ordered_json(nullptr)},
      {"threshold", levels.threshold},
      {"dark_level", levels.dark},
      {"bright_level", levels.bright},
      {"bead_tone", result.bright_beads ? "bright" : "dark"},
      {"blur_um", result.blur * 1e6},
      {"noise_over_edge", result.noise},
      {"noise_correlation", result.noise_correlation},
      {"rings_over_edge", result.rings},
      {"volume",
       {{"size", volume.size}, {"voxel_um", volume.spacing * 1e6}, {"pixel_type", pixel_type(volume)}}},
      {"warnings", result.warnings},
      {"provenance", pendular::to_json(provenance)}};
  return json;
}

void run(const SegmentOptions& options) {
  const fs::path& out = options.common.out;
  const std::vector<fs::path> outputs = {out, beside(out, ".json"), options.bridges, options.labels};
  apply(options.common, {options.volume}, outputs);
  const ReadOptions how = reading(options);
  if (options.calibrate_bridges && options.bridges.empty())
    throw BadUsage("--calibrate-bridges: found no --bridges, expected bridges to calibrate");
  protect_also(volume_files(options.volume));
  require_outputs(outputs);
  const Provenance origin = provenance(options.common, {volume_place(options.volume)});
  const Volume volume = read_volume(options.volume, how);
  const segmentation::Segmentation result = [&] {
    try {
      return segmentation::segment(volume, choices(options));
    } catch (const BadInput& error) {
      throw BadInput(fmt::format("{}: {}", options.volume.string(), error.what()));
    }
  }();
  for (const auto& warning : result.warnings) warn(warning);
  WrittenTogether written;
  write_beads(out, result.beads, origin);
  if (!options.bridges.empty()) write_bridges(options.bridges, result.beads, result.bridges, origin);
  if (!options.labels.empty())
    write_volume(options.labels, segmentation::label_volume(volume, result), origin);
  if (!options.qa.empty()) segmentation::write_qa(options.qa, volume, result);
  write_text(beside(out, ".json"), summary(volume, result, origin).dump(2) + "\n");
  written.commit();
  const auto& measured = result.measured;
  say(fmt::format("{} beads of {:.2f} um, {} pairs near enough for a bridge{}, porosity {:.4f}",
                  result.beads.size(), mean_diameter(result.beads) * 1e6, result.bridges.size(),
                  measured ? fmt::format(": {} bridges, {} without, {} undetermined", measured->bridges,
                                         measured->none, measured->undetermined)
                           : "",
                  result.porosity));
}

}  // namespace

void add_segment(CLI::App& app) {
  auto options = std::make_shared<SegmentOptions>();
  auto* command = add_picture_command(app, "segment");
  command->add_option("volume", options->volume, "Volume: " + format_names())->required();
  add_common(*command, options->common, "Beads (beads.csv); a summary goes beside it as .json");
  command->add_option("--voxel-um", options->voxel_um, "Edge of a voxel, um; overrides the header's")
      ->check(within(1e-3, 1e4));
  command->add_option("--size", options->size, "Raw data: voxels along x, y, z, as NX,NY,NZ")
      ->delimiter(',')
      ->expected(3)
      ->check(CLI::Range(1, 1 << 24));
  command->add_option("--type", options->type, "Raw data: pixel type, little endian")
      ->check(CLI::IsMember({"uint8", "int8", "uint16", "int16", "uint32", "int32", "float", "double"}));
  command->add_option("--bridges", options->bridges,
                      "Look for polymer between near beads and write what is found (bridges.csv)");
  command
      ->add_option(
          "--false-discoveries", options->false_discoveries,
          "Largest expected share of errors among pairs labelled bridge, and among those labelled none")
      ->capture_default_str()
      ->check(within(0.0, 0.5));
  command->add_flag("--calibrate-bridges", options->calibrate_bridges,
                    "Put necks of several sizes into the volume, and say which are found (in the summary)");
  command->add_option("--labels", options->labels, "Write each voxel's bead number (.mha or .tif)");
  command->add_option("--qa", options->qa, "Write pictures to judge the result by into this folder");
  command
      ->add_option("--cutoff", options->segment.cutoff,
                   "Largest gap of a candidate bridge over the mean diameter")
      ->capture_default_str()
      ->check(within(0.0, 1.0));
  command->add_option("--beads", options->tone, "Beads are brighter or darker than what surrounds them")
      ->capture_default_str()
      ->check(CLI::IsMember({"auto", "bright", "dark"}));
  command
      ->add_option("--min-diameter-um", options->min_diameter_um,
                   "Leave out beads smaller than this; without it, than a quarter of the typical one")
      ->check(within(1e-3, 1e5));
  command->callback([options] { run(*options); });
}

}  // namespace pendular::cli
