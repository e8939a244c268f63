#include <fmt/format.h>

#include "base/progress.h"
#include "base/sample.h"
#include "cli/command.h"
#include "cli/embedded.h"
#include "cli/picture_commands.h"
#include "cli/program.h"
#include "packing/comparison.h"
#include "packing/tables.h"
#include "packing/vtp.h"
#include "viz/render_run.h"
#include "viz/report.h"

namespace pendular::cli {
namespace {

/// One step of the chain, run as a user would type it.
void step(const Common& common, std::vector<std::string> words) {
  std::string line = "pendular";
  for (const auto& word : words) line += ' ' + word;
  if (!common.quiet) say("\n$ " + line);
  words.insert(words.end(),
               {"--threads", std::to_string(common.threads), "--seed", std::to_string(common.seed)});
  if (common.quiet) words.push_back("--quiet");
  run_command_line(words);
}

viz::ReportSection segmentation_section(const BeadComparison& c, double voxel, const fs::path& qa) {
  viz::ReportSection section;
  section.heading = "Tomogram to beads";
  section.text =
      "The tomogram is a phantom: beads and bridges voxelised with partial volume, point spread, noise, "
      "polymer, "
      "container and pistons, so that what was found can be held against what is there.";
  const Vec3 rms = c.centre_rms / voxel;
  section.rows = {{"Beads in the specimen", std::to_string(c.truth), ""},
                  {"Beads found",
                   fmt::format("{} ({:.2f} %)", c.matched,
                               100.0 * static_cast<double>(c.matched) / static_cast<double>(c.truth)),
                   ""},
                  {"Beads invented", std::to_string(c.invented), ""},
                  {"Centre error, rms along x, y, z",
                   fmt::format("{:.4f}, {:.4f}, {:.4f}", rms.x(), rms.y(), rms.z()), "voxel"},
                  {"Diameter error, mean and rms",
                   fmt::format("{:+.4f}, {:.4f}", c.diameter_bias / voxel, c.diameter_rms / voxel), "voxel"}};
  section.pictures = {
      {qa / "slice_xz_2.png",
       "Vertical slice with the circles found (orange: poor fit) and the container (blue)"},
      {qa / "residual_xz.png", "What the fitted beads leave of the middle slice: polymer, container, noise"},
      {qa / "fractional_positions.png",
       "Positions of centres within their voxel: flat where nothing pulls them to the grid"}};
  return section;
}

void run(const Common& common) {
  apply(common, {});
  const fs::path& out = common.out;
  make_folder(out);
  const auto in = [&](const char* name) { return (out / name).string(); };
  write_text(out / "sample.toml", demo_sample());
  step(common, {"phantom", in("sample.toml"), "-o", in("volume.mha"), "--truth", in("truth.vtp")});
  step(common, {"segment", in("volume.mha"), "-o", in("beads.csv"), "--bridges", in("bridges.csv"), "--qa",
                in("qa")});
  step(common, {"pack", in("beads.csv"), "--sample", in("sample.toml"), "-o", in("packing.vtp")});
  step(common, {"compress", in("packing.vtp"), "--sample", in("sample.toml"), "-o", in("run")});
  set_command_line({"demo"});
  const Sample sample = read_sample(out / "sample.toml");
  const BeadComparison beads =
      compare_beads(read_packing(out / "truth.vtp").beads, read_beads(out / "beads.csv"));
  viz::RenderOptions render;
  render.provenance = provenance(common, picture_inputs(out / "run"));
  const auto summary = viz::render_run(out / "run", out / "pictures", render);
  viz::Report report;
  report.title = "pendular demo: from a tomogram to the shear band";
  report.summary = viz::compression_summary(summary);
  report.sections = {segmentation_section(beads, sample.phantom.voxel, out / "qa"),
                     viz::compression_section(summary)};
  report.provenance = to_json(provenance(common, {out / "sample.toml"}));
  viz::write_report(out / "report.html", report);
  say(fmt::format("\n{} of {} beads found, {} invented, centre rms {:.4f} voxel", beads.matched, beads.truth,
                  beads.invented, beads.centre_rms.maxCoeff() / sample.phantom.voxel));
  say(fmt::format("report: {}\npictures: {}", in("report.html"), in("pictures")));
}

}  // namespace

void add_demo(CLI::App& app) {
  auto* command = add_picture_command(app, "demo");
  auto common = std::make_shared<Common>();
  add_common(*command, *common, "Folder for everything the demo makes", "demo");
  command->callback([common] { run(*common); });
}

}  // namespace pendular::cli
