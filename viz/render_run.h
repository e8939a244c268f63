#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/provenance.h"
#include "run_folder/run_folder.h"
#include "viz/image.h"
#include "viz/report.h"

namespace pendular::viz {

struct RenderOptions {
  std::string view;  ///< only this one; empty: all
  bool film = true;
  PictureSize size = {1600, 1200};
  PictureSize film_size = {800, 600};
  Provenance provenance;  ///< of the pictures; goes into their metadata
};

/// What was drawn from a run folder, and the figures that go with it.
struct RenderSummary {
  std::vector<ReportPicture> pictures;  ///< stress–strain curve first
  std::optional<fs::path> video;
  RunFolder run;  ///< the first realisation
  std::size_t realisations = 1;
  double coordination = 0.0;  ///< bonds per interior bead before loading; NaN where there are none
};

/// Draws a run folder, or a folder of realisation_* run folders, into `out`: the stress–strain plot
/// (stress_strain.png, .pdf and .svg; all realisations), and of the first realisation every view of the last
/// frame and of the frame nearest the peak (NAME_end.png, NAME_peak.png) and the film of local shear strain
/// (film/, film.mp4), or of the one view asked for. BadInput for what is missing or broken in the run folder.
RenderSummary render_run(const fs::path& run, const fs::path& out, const RenderOptions& options = {});

/// A run's section of a report: its figures in a table, its specimen to turn, and its pictures.
ReportSection compression_section(const RenderSummary& summary);

/// A run in words: modulus, linear limit, peak, broken bonds, shear band.
std::string compression_summary(const RenderSummary& summary);

}  // namespace pendular::viz
