#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/files.h"
#include "viz/figure.h"

namespace pendular::viz {

/// A chart and the files that it is drawn into, in the format of their extension: .svg, .pdf or .png.
struct FigureFiles {
  Figure figure;
  std::vector<fs::path> files;
};

/// Whether charts can be written under this name.
bool is_figure_name(const fs::path& file);

/// Draws all figures with one gnuplot process and writes each file whole or not at all; `comment` goes into
/// its metadata where not empty (PNG: text chunk "Comment"; PDF: subject; SVG: description). The same figure
/// gives the same bytes. ComputationFailed where gnuplot is missing or fails; then none is written.
void write_figures(std::span<const FigureFiles> figures, const std::string& comment = "");

/// The same for one.
void write_figure(const Figure& figure, std::vector<fs::path> files, const std::string& comment = "");

}  // namespace pendular::viz
