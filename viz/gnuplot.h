#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/files.h"
#include "base/process.h"
#include "base/temporary_folder.h"
#include "viz/figure.h"

namespace pendular::viz {

/// A chart and the files that it is drawn into, in the format of their extension: .svg, .pdf or .png.
struct FigureFiles {
  Figure figure;
  std::vector<fs::path> files;
};

/// Whether charts can be written under this name.
bool is_figure_name(const fs::path& file);

/// Charts that gnuplot draws while this program does something else. `comment` goes into the files' metadata
/// where not empty (PNG: text chunk "Comment"; PDF: subject; SVG: description). The same figures give the
/// same bytes.
class ChartsInWork {
 public:
  /// Starts at most as many gnuplot processes as there are threads.
  ChartsInWork(std::vector<FigureFiles> figures, std::string comment);

  /// Waits for them and writes each file whole or not at all, once. ComputationFailed where gnuplot is
  /// missing or fails; then none is written.
  void write();

  /// gnuplot at work.
  struct Script {
    fs::path log;
    Process process;
  };

 private:
  void start_scripts();

  TemporaryFolder folder_;
  std::vector<FigureFiles> figures_;
  std::string comment_;
  std::size_t started_ = 0;
  std::vector<Script> at_work_;
};

/// Draws charts and waits for them.
void write_figures(std::span<const FigureFiles> figures, const std::string& comment = "");

/// The same for one.
void write_figure(const Figure& figure, std::vector<fs::path> files, const std::string& comment = "");

}  // namespace pendular::viz
