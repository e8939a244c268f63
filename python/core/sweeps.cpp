#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "binding/inputs.h"
#include "binding/runs.h"
#include "binding/work.h"
#include "core/core.h"
#include "sweep/plan.h"
#include "sweep/tables.h"

namespace pendular::python {
namespace {

/// What came of a sweep.
struct SweepOutcome {
  std::size_t runs = 0;
  std::vector<std::string> failed;  ///< "HASH: message"
  std::vector<fs::path> folders;    ///< of the runs in the order of results.csv; empty: it failed
};

SweepOutcome sweep_file(const fs::path& path, const fs::path& out, const std::optional<std::uint64_t>& seed,
                        const RunTerms& runs, Origin origin, const Terms& terms) {
  return work(terms, [&] {
    const sweep::SweepFile file = sweep::read_sweep(path, seed);
    const sweep::Plan plan = sweep::plan_of(file);
    make_folder(out);
    std::vector<fs::path> inputs = {path, file.sample};
    if (!file.packing.empty()) inputs.push_back(file.packing);
    protect_inputs(inputs);
    origin.seed = file.seed;
    for (const auto& input : inputs) origin.inputs.push_back(input_of(input));
    const auto outcomes = make_runs(runs, file.name, plan.requests);
    sweep::write_tables(out, plan, outcomes, provenance_of(origin));
    SweepOutcome result{outcomes.size(), {}, {}};
    for (const auto& outcome : outcomes) {
      const bool done = outcome.status == sweep::RunStatus::done;
      if (!done) result.failed.push_back(outcome.hash.substr(0, 12) + ": " + outcome.message);
      result.folders.push_back(done ? outcome.folder : fs::path());
    }
    return result;
  });
}

}  // namespace

void add_sweeps(py::module_& module) {
  py::class_<RunTerms>(module, "RunTerms")
      .def(py::init([](fs::path store, fs::path program, bool retry_failed, int threads) {
             return RunTerms{std::move(store), std::move(program), retry_failed, threads};
           }),
           py::arg("store"), py::arg("program"), py::arg("retry_failed"), py::arg("threads"));
  py::class_<SweepOutcome>(module, "SweepOutcome")
      .def_readonly("runs", &SweepOutcome::runs)
      .def_readonly("failed", &SweepOutcome::failed)
      .def_readonly("folders", &SweepOutcome::folders);
  module.def("sweep", &sweep_file);
}

}  // namespace pendular::python
