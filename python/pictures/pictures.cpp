#include "pictures/pictures.h"
#include "base/path_kind.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>

#include "base/error.h"
#include "binding/inputs.h"
#include "binding/work.h"
#include "viz/render_run.h"
#include "viz/report.h"
#include "viz/scene.h"

namespace pendular::python {
namespace {

void require_view(const std::string& name) {
  std::string known;
  for (const viz::View& view : viz::views()) {
    if (view.name == name) return;
    known += (known.empty() ? "" : ", ") + view.name;
  }
  throw BadUsage(fmt::format("view: found \"{}\", expected one of {}", name, known));
}

std::vector<fs::path> render(const fs::path& run, const fs::path& out, const std::string& view, bool film,
                             Origin origin, const Terms& terms) {
  if (!view.empty()) require_view(view);
  return work(terms, [&] {
    const auto inputs = picture_inputs(run);
    for (const auto& input : inputs) protect_also(is_folder(input) ? files_in(input) : std::vector{input});
    viz::RenderOptions options;
    options.view = view;
    options.film = film;
    for (const auto& input : inputs) origin.inputs.push_back(input_of(input));
    options.provenance = provenance_of(origin);
    const auto summary = viz::render_run(run, out, options);
    viz::write_report(out / "report.html",
                      {"Compression of " + fs::canonical(run).filename().string(),
                       viz::compression_summary(summary),
                       {viz::compression_section(summary)},
                       {{"pictures", to_json(options.provenance)}, {"run", summary.run.result.provenance}}});
    std::vector<fs::path> files;
    for (const auto& picture : summary.pictures) files.push_back(picture.file);
    return files;
  });
}

}  // namespace

void add_pictures(py::module_& module) {
  module.def("render", &render);
}

}  // namespace pendular::python
