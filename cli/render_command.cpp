#include <fmt/format.h>

#include <memory>

#include "base/path_kind.h"
#include "base/progress.h"
#include "cli/command.h"
#include "cli/picture_commands.h"
#include "viz/render_run.h"
#include "viz/report.h"
#include "viz/scene.h"

namespace pendular::cli {
namespace {

struct RenderOptions {
  Common common;
  fs::path run;
  viz::RenderOptions render;
  bool no_film = false;
};

void render(RenderOptions& options) {
  apply(options.common, {});
  for (const auto& input : picture_inputs(options.run))
    protect_also(is_folder(input) ? files_in(input) : std::vector{input});
  const fs::path out = options.common.out.empty() ? options.run / "pictures" : options.common.out;
  if (options.common.out.empty()) make_inner_folder(out);
  options.render.film = !options.no_film;
  options.render.provenance = provenance(options.common, picture_inputs(options.run));
  const auto summary = viz::render_run(options.run, out, options.render);
  viz::write_report(out / "report.html", {"Compression of " + fs::canonical(options.run).filename().string(),
                                          viz::compression_summary(summary),
                                          {viz::compression_section(summary)},
                                          {{"pictures", to_json(options.render.provenance)},
                                           {"run", summary.run.result.provenance}}});
  say(fmt::format("{} pictures{} and report.html in {}", summary.pictures.size(),
                  summary.video ? ", film.mp4" : "", out.string()));
}

}  // namespace

void add_render(CLI::App& app) {
  auto options = std::make_shared<RenderOptions>();
  auto* command = add_picture_command(app, "render");
  command
      ->add_option("run", options->run,
                   "Run folder of `pendular compress`; of several realisations the first is drawn "
                   "and all curves are overlaid")
      ->required();
  std::vector<std::string> names;
  for (const viz::View& view : viz::views()) names.push_back(view.name);
  command->add_option("--view", options->render.view, "Draw only this view")->check(CLI::IsMember(names));
  command->add_flag("--no-film", options->no_film, "Make no film");
  add_common(*command, options->common, "Folder for the pictures [RUN/pictures]");
  command->get_option("--out")->required(false);
  command->callback([options] { render(*options); });
}

}  // namespace pendular::cli
