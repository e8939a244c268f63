#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>

#include "base/error.h"
#include "base/progress.h"
#include "binding/inputs.h"
#include "binding/runs.h"
#include "binding/work.h"
#include "diagnosis/advice/planning.h"
#include "diagnosis/bank/feature_values.h"
#include "diagnosis/diagnose.h"
#include "diagnosis_report/report_folder.h"
#include "effects/list.h"
#include "pictures/pictures.h"

namespace pendular::python {
namespace {

/// How a diagnosis is made.
struct DiagnoseTerms {
  int levels, runs;
  double confidence;
  std::vector<std::string> leave_out;
  bool fresh_runs, plan;
};

std::vector<fs::path> files_of(const fs::path& file, const diagnosis::Experiment& experiment) {
  std::vector<fs::path> files = {file, experiment.sample_file};
  for (const auto& observation : experiment.observations)
    for (const auto& named : {observation.file, observation.beads})
      if (!named.empty() && std::find(files.begin(), files.end(), named) == files.end())
        files.push_back(named);
  return files;
}

diagnosis::BankOptions bank_of(const DiagnoseTerms& how) {
  diagnosis::BankOptions bank;
  bank.levels = how.levels;
  bank.runs = how.runs;
  for (const auto& id : how.leave_out) bank.leave_out.insert(effects::find_effect(id, "leave_out").id);
  return bank;
}

/// Writes the report's folder; returns the verdict.
std::string diagnose(const fs::path& file, const fs::path& out, const DiagnoseTerms& how, RunTerms runs,
                     Origin origin, const Terms& terms) {
  runs.rows_suffice = true;
  return work(terms, [&] {
    const auto experiment = diagnosis::read_experiment(file);
    diagnosis::require_features(experiment);
    const auto inputs = files_of(file, experiment);
    protect_inputs(inputs);
    const fs::path beads = runs.store / "measured";
    const auto bank = diagnosis::plan_bank(experiment, bank_of(how), beads);
    make_folder(out);
    diagnosis::Rules rules;
    rules.confidence = how.confidence;
    const auto make = [&](const std::string& name, std::span<const sweep::RunRequest> requests) {
      return make_runs(runs, name, requests);
    };
    auto found = diagnosis::diagnose(experiment, bank, beads, make, rules, {how.fresh_runs, how.plan});
    for (const auto& input : inputs) origin.inputs.push_back(input_of(input));
    found.provenance = provenance_of(origin);
    diagnosis_report::write_report_folder(out, found);
    for (const auto& warning : found.warnings) warn(warning);
    return found.verdict;
  });
}

}  // namespace

void add_diagnosis(py::module_& module) {
  py::class_<DiagnoseTerms>(module, "DiagnoseTerms")
      .def(py::init<int, int, double, std::vector<std::string>, bool, bool>(), py::arg("levels"),
           py::arg("runs"), py::arg("confidence"), py::arg("leave_out"), py::arg("fresh_runs"),
           py::arg("plan"));
  module.def("diagnose", &diagnose);
  module.attr("default_runs") = diagnosis::BankOptions().runs;
  module.attr("default_confidence") = diagnosis::Rules().confidence;
}

}  // namespace pendular::python
