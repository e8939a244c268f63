#include <pybind11/numpy.h>

#include "base/batches.h"
#include "base/progress.h"
#include "binding/arrays.h"
#include "binding/work.h"
#include "core/core.h"
#include "micromechanics/bridge_fe.h"

namespace pendular::python {
namespace {

/// A row of the table; units as in its columns.
struct Row {
  double d_um, D_um, D2_um, gap_um, E_pa, nu;
  double kn = 0.0, kt = 0.0, bend = 0.0, twist = 0.0, coupling = 0.0, error = 0.0;
  double mean_average = 0.0, axial_average = 0.0, mean_centre = 0.0, axial_centre = 0.0, axial_rim = 0.0;
};

py::dtype row_fields() {
  py::list names, formats;
  for (const char* name :
       {"d_um", "D_um", "D2_um", "gap_um", "E_pa", "nu", "kn_n_per_m", "kt_n_per_m", "k_bend_n_m_per_rad",
        "k_twist_n_m_per_rad", "k_coupling_n_per_rad", "error_estimate", "mean_stress_average_pa_per_m",
        "axial_stress_average_pa_per_m", "mean_stress_centre_pa_per_m", "axial_stress_centre_pa_per_m",
        "axial_stress_rim_pa_per_m"}) {
    names.append(name);
    formats.append("f8");
  }
  py::list offsets;
  for (std::size_t k = 0; k < py::len(names); ++k) offsets.append(k * sizeof(double));
  return {names, formats, offsets, static_cast<py::ssize_t>(sizeof(Row))};
}

micromechanics::BridgeBody body_of(const Row& row) {
  return {1e-6 * row.d_um, 1e-6 * row.gap_um, 1e-6 * row.D_um, 1e-6 * row.D2_um};
}

void solve(Row& row) {
  const micromechanics::BridgeStiffness k =
      micromechanics::bridge_stiffness(body_of(row), {row.E_pa, row.nu});
  row.kn = k.normal, row.kt = k.tangential, row.bend = k.bending, row.twist = k.twisting;
  row.coupling = k.coupling, row.error = k.error_estimate;
  row.mean_average = k.stress.mean_average, row.axial_average = k.stress.axial_average;
  row.mean_centre = k.stress.mean_centre, row.axial_centre = k.stress.axial_centre;
  row.axial_rim = k.stress.axial_rim;
}

void check(const std::vector<Row>& rows) {
  std::size_t outside = 0;
  for (const Row& row : rows) {
    micromechanics::check_bridge(body_of(row), {row.E_pa, row.nu});
    outside += !micromechanics::within_verified_range(body_of(row), {row.E_pa, row.nu});
  }
  if (outside > 0)
    warn(fmt::format(
        "{} of {} bridges lie outside the range where the error has been shown to stay below 0.1 %", outside,
        rows.size()));
}

using Numbers = py::array_t<double, py::array::c_style>;

py::array bridge(const Numbers& d, const Numbers& D, const Numbers& D2, const Numbers& gap, const Numbers& E,
                 const Numbers& nu, const Terms& terms) {
  std::vector<Row> rows(static_cast<std::size_t>(d.size()));
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const auto at = static_cast<py::ssize_t>(k);
    rows[k] = {d.data()[at], D.data()[at], D2.data()[at], gap.data()[at], E.data()[at], nu.data()[at]};
  }
  constexpr std::size_t kBatch = 16;
  rows = work(terms, [&] {
    check(rows);
    for_batches("bridges", rows.size(), kBatch, [&](std::size_t k) { solve(rows[k]); });
    return std::move(rows);
  });
  return records(std::move(rows), row_fields());
}

}  // namespace

void add_bridge_stiffness(py::module_& module) {
  module.def("bridge", &bridge);
}

}  // namespace pendular::python
