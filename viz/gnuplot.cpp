#include "viz/gnuplot.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <utility>

#include "base/error.h"
#include "base/parallel.h"
#include "viz/comment.h"

namespace pendular::viz {
namespace {

// Scripts that figures are spread over; each costs gnuplot a tenth of a second to start. What gnuplot writes
// of a figure depends on those before it in its script, so the number must not depend on that of threads.
constexpr std::size_t kScripts = 2;

/// How a format is drawn. Figures are in pixels; each terminal has measures of its own.
struct Format {
  const char* terminal;  ///< {0} and {1}: width and height
  double point;          ///< size of a marker with a radius of a pixel
  std::string (*finished)(std::string bytes, const std::string& comment);
};

const std::map<std::string, Format> kFormats = {
    {".svg",
     {"svg noenhanced size {0},{1} font 'Arial,24' background rgb 'white' rounded", 1.0 / 9.0,
      svg_with_comment}},
    {".pdf",
     {"pdfcairo noenhanced size {0}/144.,{1}/144. font 'Arial,24' fontscale 0.375 background rgb 'white' "
      "rounded",
      1.0 / 6.0, pdf_with_comment}},
    {".png",
     {"pngcairo noenhanced size {0},{1} font 'Arial,24' fontscale 0.75 background rgb 'white' rounded",
      1.0 / 3.0, png_with_comment}}};

const Format& format_of(const fs::path& file) {
  const auto found = kFormats.find(file.extension());
  if (found == kFormats.end())
    throw BadUsage(fmt::format("{}: found no name of a chart, expected one that ends in .svg, .pdf or .png",
                               file.string()));
  return found->second;
}

/// The file that gnuplot writes, within its folder.
std::string drawn_name(std::size_t figure, std::size_t file) {
  return fmt::format("{}_{}", figure, file);
}

/// Of every so-manyth figure, from `first` on.
std::string script_of(std::span<const FigureFiles> figures, std::size_t first, std::size_t every) {
  std::string script = "set encoding utf8\n";
  for (std::size_t k = first; k < figures.size(); k += every) {
    const Figure& figure = figures[k].figure;
    for (std::size_t f = 0; f < figures[k].files.size(); ++f) {
      const Format& format = format_of(figures[k].files[f]);
      script += fmt::format("reset\nset terminal {}\nset output '{}'\npoint = {}\n{}set output\n",
                            fmt::format(fmt::runtime(format.terminal), figure.size.width, figure.size.height),
                            drawn_name(k, f), format.point, figure.script);
    }
  }
  return script;
}

/// Starts gnuplot on a script.
ChartsInWork::Script start(const fs::path& folder, const std::string& name, const std::string& script) {
  // Not write_text(), which waits for other files where they are written together (WrittenTogether).
  std::ofstream(folder / name, std::ios::binary) << script;
  // -d: without the user's settings.
  const fs::path log = folder / (name + ".log");
  return {log, Process({"gnuplot", {"-d", name}}, {.log = log, .folder = folder})};
}

void finish(ChartsInWork::Script& script) {
  const int status = watch(script.process);
  if (status == kCannotBeStarted)
    throw ComputationFailed("charts need gnuplot: not found (Debian package gnuplot-nox)");
  if (status != 0)
    throw ComputationFailed(fmt::format("gnuplot ended with {}: {}", status, last_line(script.log)));
}

}  // namespace

bool is_figure_name(const fs::path& file) {
  return kFormats.contains(file.extension());
}

ChartsInWork::ChartsInWork(std::vector<FigureFiles> figures, std::string comment)
    : figures_(std::move(figures)), comment_(std::move(comment)) {
  start_scripts();
}

void ChartsInWork::start_scripts() {
  const std::size_t scripts = std::min(figures_.size(), kScripts);
  for (std::size_t n = 0; started_ < scripts && n < thread_count(); ++n, ++started_)
    at_work_.push_back(
        start(folder_.path(), fmt::format("script_{}", started_), script_of(figures_, started_, scripts)));
}

void ChartsInWork::write() {
  for (; !at_work_.empty(); start_scripts()) {
    for (auto& script : at_work_) finish(script);
    at_work_.clear();
  }
  for (std::size_t k = 0; k < figures_.size(); ++k)
    for (std::size_t f = 0; f < figures_[k].files.size(); ++f) {
      const fs::path& file = figures_[k].files[f];
      const std::string drawn = drawn_name(k, f);
      if (!fs::exists(folder_.path() / drawn))
        throw ComputationFailed(fmt::format("{}: gnuplot did not draw it", file.string()));
      write_text(file, format_of(file).finished(read_text(folder_.path() / drawn), comment_));
    }
}

void write_figures(std::span<const FigureFiles> figures, const std::string& comment) {
  ChartsInWork({figures.begin(), figures.end()}, comment).write();
}

void write_figure(const Figure& figure, std::vector<fs::path> files, const std::string& comment) {
  const FigureFiles one{figure, std::move(files)};
  write_figures(std::span(&one, 1), comment);
}

}  // namespace pendular::viz
