#include "binding/arrays.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "packing/check.h"

namespace pendular::python {
namespace {

struct Field {
  const char* name;
  const char* format;
  std::size_t offset;
};

py::dtype struct_of(std::span<const Field> fields, std::size_t size) {
  py::list names, formats, offsets;
  for (const Field& field : fields) {
    names.append(field.name);
    formats.append(field.format);
    offsets.append(field.offset);
  }
  return {names, formats, offsets, static_cast<py::ssize_t>(size)};
}

// ---- Arrays that are given ----

/// The columns of a structured array.
class Columns {
 public:
  Columns(const py::object& array, std::string argument) : argument_(std::move(argument)) {
    if (!py::isinstance<py::array>(array))
      wrong("a structured NumPy array", py::str(py::type::of(array).attr("__name__")));
    array_ = py::reinterpret_borrow<py::array>(array);
    if (array_.dtype().attr("names").is_none())
      wrong("a structured NumPy array", "dtype " + std::string(py::str(array_.dtype())));
    if (array_.ndim() != 1) wrong("one dimension", fmt::format("{} dimensions", array_.ndim()));
    if (array_.size() == 0) wrong("at least one row", "an empty array");
  }

  std::size_t rows() const { return static_cast<std::size_t>(array_.size()); }
  bool has(const std::string& name) const { return array_.dtype().attr("names").contains(name); }

  std::vector<double> numbers(const std::string& name, std::optional<double> missing = std::nullopt) const {
    if (!has(name) && missing) return std::vector<double>(rows(), *missing);
    const auto values = column<double>(name, "biuf");
    for (std::size_t row = 0; row < values.size(); ++row)
      if (!std::isfinite(values[row]))
        bad_input("{}: field {}, row {}: found {}, expected a number", argument_, name, row, values[row]);
    return values;
  }

  /// In m, from NAME_m or NAME_um.
  std::vector<double> lengths(const std::string& name, std::optional<double> missing = std::nullopt) const {
    if (!has(name + "_um") || has(name + "_m")) return numbers(name + "_m", missing);
    auto values = numbers(name + "_um");
    for (double& value : values) value *= 1e-6;
    return values;
  }

  std::vector<std::int64_t> integers(const std::string& name,
                                     std::optional<std::int64_t> missing = std::nullopt) const {
    if (!has(name) && missing) return std::vector<std::int64_t>(rows(), *missing);
    return column<std::int64_t>(name, "biu");
  }

 private:
  [[noreturn]] void wrong(const char* expected, const std::string& found) const {
    bad_input("{}: found {}, expected {}", argument_, found, expected);
  }

  template <typename T>
  std::vector<T> column(const std::string& name, const std::string& kinds) const {
    if (!has(name)) bad_input("{}: field {} is missing", argument_, name);
    const py::array field = array_[py::str(name)];
    if (field.ndim() != 1 || kinds.find(field.dtype().kind()) == std::string::npos)
      bad_input("{}: field {}: found dtype {}, expected {}", argument_, name,
                std::string(py::str(field.dtype())),
                kinds.find('f') == std::string::npos ? "integers" : "numbers");
    const auto values = py::array_t<T, py::array::c_style | py::array::forcecast>::ensure(field);
    return {values.data(), values.data() + values.size()};
  }

  std::string argument_;
  py::array array_;
};

void require_not_negative(const std::vector<double>& values, const std::string& argument, const char* name) {
  for (std::size_t row = 0; row < values.size(); ++row)
    if (values[row] < 0.0)
      bad_input("{}: field {}, row {}: found {}, expected none below 0", argument, name, row, values[row]);
}

}  // namespace

py::dtype bead_fields() {
  static_assert(std::is_standard_layout_v<Bead>);
  constexpr std::size_t centre = offsetof(Bead, centre), d = sizeof(double);
  const Field fields[] = {{"bead_id", "i8", offsetof(Bead, id)},
                          {"x_m", "f8", centre},
                          {"y_m", "f8", centre + d},
                          {"z_m", "f8", centre + 2 * d},
                          {"diameter_m", "f8", offsetof(Bead, diameter)},
                          {"sigma_centre_m", "f8", offsetof(Bead, sigma_centre)},
                          {"sigma_diameter_m", "f8", offsetof(Bead, sigma_diameter)},
                          {"quality", "f8", offsetof(Bead, quality)},
                          {"boundary", "?", offsetof(Bead, boundary)}};
  return struct_of(fields, sizeof(Bead));
}

py::dtype bridge_fields() {
  static_assert(sizeof(BridgeState) == 4);
  const Field fields[] = {{"i", "i4", offsetof(Bridge, i)},
                          {"j", "i4", offsetof(Bridge, j)},
                          {"gap_m", "f8", offsetof(Bridge, gap)},
                          {"sigma_gap_m", "f8", offsetof(Bridge, sigma_gap)},
                          {"probability", "f8", offsetof(Bridge, probability)},
                          {"diameter_m", "f8", offsetof(Bridge, diameter)},
                          {"sigma_diameter_m", "f8", offsetof(Bridge, sigma_diameter)},
                          {"state", "i4", offsetof(Bridge, state)}};
  return struct_of(fields, sizeof(Bridge));
}

py::dtype curve_fields() {
  const Field fields[] = {{"strain", "f8", offsetof(CurveRow, strain)},
                          {"stress_pa", "f8", offsetof(CurveRow, stress)},
                          {"stress_bottom_pa", "f8", offsetof(CurveRow, stress_bottom)},
                          {"broken_bonds", "f8", offsetof(CurveRow, broken_bonds)},
                          {"kinetic_energy_j", "f8", offsetof(CurveRow, kinetic)},
                          {"elastic_energy_j", "f8", offsetof(CurveRow, elastic)},
                          {"platen_work_j", "f8", offsetof(CurveRow, work)},
                          {"damped_j", "f8", offsetof(CurveRow, damped)},
                          {"slipped_j", "f8", offsetof(CurveRow, slipped)},
                          {"released_by_breaking_j", "f8", offsetof(CurveRow, released)},
                          {"bonds_per_bead", "f8", offsetof(CurveRow, coordination)},
                          {"lateral_strain", "f8", offsetof(CurveRow, lateral_strain)},
                          {"inertial_number", "f8", offsetof(CurveRow, inertial_number)},
                          {"unbalanced_force", "f8", offsetof(CurveRow, unbalanced_force)},
                          {"halted_j", "f8", offsetof(CurveRow, halted)}};
  return struct_of(fields, sizeof(CurveRow));
}

py::array view_of(const void* first, const py::dtype& fields, const std::vector<py::ssize_t>& shape,
                  py::handle owner) {
  py::array array(fields, shape, first, owner);
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

std::vector<Bead> beads_from(const py::object& array, const std::string& argument) {
  const Columns columns(array, argument);
  const auto ids = columns.integers("bead_id");
  const auto x = columns.lengths("x"), y = columns.lengths("y"), z = columns.lengths("z");
  const auto diameter = columns.lengths("diameter");
  const auto sigma_centre = columns.lengths("sigma_centre", 0.0);
  const auto sigma_diameter = columns.lengths("sigma_diameter", 0.0);
  const auto quality = columns.numbers("quality", 1.0), boundary = columns.numbers("boundary", 0.0);
  require_not_negative(sigma_centre, argument, "sigma_centre");
  require_not_negative(sigma_diameter, argument, "sigma_diameter");
  std::vector<Bead> beads;
  for (std::size_t k = 0; k < ids.size(); ++k)
    beads.push_back({ids[k],
                     {x[k], y[k], z[k]},
                     diameter[k],
                     sigma_centre[k],
                     sigma_diameter[k],
                     quality[k],
                     boundary[k] != 0.0});
  check_beads(beads, argument);
  return beads;
}

std::vector<Bridge> bridges_from(const py::object& array, const std::vector<Bead>& beads,
                                 const std::string& argument) {
  if (array.is_none() ||
      (py::isinstance<py::array>(array) && py::reinterpret_borrow<py::array>(array).size() == 0))
    return {};
  const Columns columns(array, argument);
  const auto i = columns.integers("i"), j = columns.integers("j");
  const auto state = columns.integers("state", static_cast<std::int64_t>(BridgeState::bridge));
  const auto gaps =
      columns.has("gap_m") || columns.has("gap_um") ? columns.lengths("gap") : std::vector<double>{};
  const auto sigma_gap = columns.lengths("sigma_gap", 0.0), diameter = columns.lengths("diameter", 0.0);
  const auto sigma_diameter = columns.lengths("sigma_diameter", 0.0),
             probability = columns.numbers("probability", 1.0);
  const auto count = static_cast<std::int64_t>(beads.size());
  std::vector<Bridge> bridges;
  for (std::size_t k = 0; k < columns.rows(); ++k) {
    const auto [low, high] = std::minmax({i[k], j[k]});
    if (low < 0 || high >= count || low == high)
      bad_input("{}: row {}: found beads {} and {}, expected two places from 0 to {}", argument, k, i[k],
                j[k], count - 1);
    if (state[k] < 0 || state[k] > static_cast<int>(BridgeState::undetermined))
      bad_input("{}: field state, row {}: found {}, expected 0 to 3", argument, k, state[k]);
    const auto a = static_cast<std::size_t>(low), b = static_cast<std::size_t>(high);
    bridges.push_back({static_cast<int>(low), static_cast<int>(high),
                       gaps.empty() ? gap(beads[a], beads[b]) : gaps[k], sigma_gap[k], probability[k],
                       diameter[k], sigma_diameter[k], static_cast<BridgeState>(state[k])});
  }
  const auto pair = [](const Bridge& bridge) { return std::pair(bridge.i, bridge.j); };
  std::sort(bridges.begin(), bridges.end(),
            [&](const Bridge& a, const Bridge& b) { return pair(a) < pair(b); });
  for (std::size_t k = 1; k < bridges.size(); ++k)
    if (pair(bridges[k]) == pair(bridges[k - 1]))
      bad_input("{}: found beads {} and {} twice, expected each pair once", argument, bridges[k].i,
                bridges[k].j);
  return bridges;
}

}  // namespace pendular::python
