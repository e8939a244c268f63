#include "diagnosis_report/plan_folder.h"

#include <nlohmann/json.hpp>

#include "diagnosis_report/json.h"
#include "diagnosis_report/outcome_figures.h"
#include "diagnosis_report/tables.h"
#include "viz/gnuplot.h"

namespace pendular::diagnosis_report {

void write_plan_folder(const fs::path& out, const diagnosis::NextSteps& steps, const Provenance& provenance) {
  make_folder(out);
  const std::string comment = to_comment(provenance);
  for (const Table& table : {next_table(steps), next_effects_table(steps)})
    write_text(out / (table.name + ".csv"), comment + to_csv(table));
  if (const auto figure = next_figure(steps))
    viz::write_figure(std::get<viz::Figure>(figure->picture),
                      {out / "next_experiments.png", out / "next_experiments.pdf"},
                      pendular::to_json(provenance).dump());
  const nlohmann::ordered_json json = {{"outlook", to_json(steps.now)},
                                       {"next_experiments", to_json(steps)},
                                       {"provenance", pendular::to_json(provenance)}};
  write_text(out / "plan.json", json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

}  // namespace pendular::diagnosis_report
