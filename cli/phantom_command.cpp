#include <memory>

#include "base/error.h"
#include "base/progress.h"
#include "base/sample.h"
#include "cli/command.h"
#include "cli/picture_commands.h"
#include "packing/bridges.h"
#include "packing/generate.h"
#include "packing/vtp.h"
#include "phantom/phantom.h"

namespace pendular::cli {
namespace {

struct PhantomOptions {
  Common common;
  fs::path sample, truth, packing;
};

Packing generated(const Sample& sample, std::uint64_t seed) {
  Packing packing = generate_packing(sample, seed);
  packing.bridges = candidate_bridges(packing.beads, sample.bridges.cutoff * sample.beads.diameter);
  return packing;
}

void require_extension(const char* option, const fs::path& path, const char* extension) {
  if (path.extension() != extension)
    throw BadUsage(
        fmt::format("phantom: {}: found {}, expected a name ending in {}", option, path.string(), extension));
}

void run(const PhantomOptions& options) {
  apply(options.common, {options.sample, options.packing}, {options.common.out, options.truth});
  require_extension("--out", options.common.out, ".mha");
  if (!options.truth.empty()) require_extension("--truth", options.truth, ".vtp");
  const Sample sample = read_sample(options.sample);
  const std::uint64_t seed = options.common.seed;
  std::vector<fs::path> inputs = {options.sample};
  if (!options.packing.empty()) inputs.push_back(options.packing);
  Packing packing = options.packing.empty() ? generated(sample, seed) : read_packing(options.packing);
  phantom::draw_neck_diameters(packing, sample, seed);
  packing.provenance = provenance(options.common, inputs);

  const Volume volume = phantom::make_phantom(packing, sample.phantom, seed);
  WrittenTogether written;
  if (!options.truth.empty()) write_packing(options.truth, packing);
  write_volume(options.common.out, volume, packing.provenance);
  written.commit();
  say(fmt::format("{} beads, {} bridges, {} x {} x {} voxels of {:.4g} um: {}", packing.beads.size(),
                  packing.bridges.size(), volume.size[0], volume.size[1], volume.size[2],
                  1e6 * volume.spacing, options.common.out.string()));
}

}  // namespace

void add_phantom(CLI::App& app) {
  auto options = std::make_shared<PhantomOptions>();
  auto* command = add_picture_command(app, "phantom");
  command->add_option("sample", options->sample, "SAMPLE.toml; its [phantom] says how the tomogram looks")
      ->required();
  command->add_option("--truth", options->truth,
                      "Packing (.vtp) of the beads and necks that the tomogram shows");
  command->add_option(
      "--packing", options->packing,
      "Packing (.vtp) to show instead of a generated one; its bridges and candidates get necks");
  add_common(
      *command, options->common,
      "Volume (.mha), lengths in um; axis order x, y, z, voxel i has its centre at origin + i*spacing");
  command->callback([options] { run(*options); });
}

}  // namespace pendular::cli
