#include "viz/gnuplot.h"

#include <fmt/format.h>

#include <fstream>
#include <map>

#include "base/error.h"
#include "base/process.h"
#include "base/temporary_folder.h"
#include "viz/comment.h"

namespace pendular::viz {
namespace {

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

std::string script_of(std::span<const FigureFiles> figures) {
  std::string script = "set encoding utf8\n";
  for (std::size_t k = 0; k < figures.size(); ++k) {
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

void draw(const fs::path& folder, const std::string& script) {
  // Not write_text(), which waits for other files where they are written together (WrittenTogether).
  std::ofstream(folder / "script", std::ios::binary) << script;
  // -d: without the user's settings.
  const fs::path log = folder / "log";
  const int status = run({"gnuplot", {"-d", "script"}}, {.log = log, .folder = folder});
  if (status == kCannotBeStarted)
    throw ComputationFailed("charts need gnuplot: not found (Debian package gnuplot-nox)");
  if (status != 0) throw ComputationFailed(fmt::format("gnuplot ended with {}: {}", status, last_line(log)));
}

}  // namespace

bool is_figure_name(const fs::path& file) {
  return kFormats.contains(file.extension());
}

void write_figures(std::span<const FigureFiles> figures, const std::string& comment) {
  if (figures.empty()) return;
  const TemporaryFolder folder;
  draw(folder.path(), script_of(figures));
  for (std::size_t k = 0; k < figures.size(); ++k)
    for (std::size_t f = 0; f < figures[k].files.size(); ++f) {
      const fs::path& file = figures[k].files[f];
      const std::string drawn = drawn_name(k, f);
      if (!fs::exists(folder.path() / drawn))
        throw ComputationFailed(fmt::format("{}: gnuplot did not draw it", file.string()));
      write_text(file, format_of(file).finished(read_text(folder.path() / drawn), comment));
    }
}

void write_figure(const Figure& figure, std::vector<fs::path> files, const std::string& comment) {
  const FigureFiles one{figure, std::move(files)};
  write_figures(std::span(&one, 1), comment);
}

}  // namespace pendular::viz
