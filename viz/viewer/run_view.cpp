#include "viz/viewer/run_view.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"
#include "base/interrupt.h"
#include "packing/polydata.h"

namespace pendular::viz {
namespace {

constexpr double kUm = 1e-6;
constexpr const char* kShownFirst = "local_shear_strain";

using Array = PolyTable::Array;

/// What an array of a frame is called in words, and its unit.
SpecimenView::Field field_of(const std::string& array) {
  static const std::vector<std::pair<std::string, std::string>> units = {
      {"_um", "\u00b5m"}, {"_pa", "Pa"}, {"_n", "N"}};
  SpecimenView::Field field{array, ""};
  for (const auto& [ending, unit] : units)
    if (field.name.ends_with(ending)) {
      field.name.resize(field.name.size() - ending.size());
      field.unit = unit;
      break;
    }
  std::replace(field.name.begin(), field.name.end(), '_', ' ');
  return field;
}

/// The arrays of a frame that a reader may colour beads by: all but names and sizes.
std::vector<std::string> shown_arrays(const PolyTable& table) {
  std::vector<std::string> names;
  for (const auto& [name, values] : table.point_data)
    if (name != "bead_id" && name != "diameter_um") names.push_back(name);
  std::stable_partition(names.begin(), names.end(), [](const auto& name) { return name == kShownFirst; });
  return names;
}

bool is_vector(const PolyTable& table, const std::string& name) {
  return std::any_of(table.point_data.begin(), table.point_data.end(), [&](const auto& array) {
    return array.first == name && std::holds_alternative<std::vector<Vec3>>(array.second);
  });
}

/// Reads frames into a view whose pairs grow by those that each frame has and none before had.
class Reader {
 public:
  explicit Reader(const fs::path& first) : first_(first) {
    const PolyTable table = read_polydata(first);
    if (table.points.empty()) bad_input("{}: found no beads, expected at least one", first.string());
    view_.ids = integers(table, true, "bead_id", first);
    view_.diameters = numbers(table, true, "diameter_um", first);
    for (double& d : view_.diameters) d *= kUm;
    arrays_ = shown_arrays(table);
    for (const auto& name : arrays_) {
      const auto field = field_of(name);
      view_.fields.push_back(field);
      if (!is_vector(table, name)) continue;
      view_.fields.push_back(field);
      view_.fields.back().name += " along z";
    }
    view_.fields.push_back({"broken bonds", "", SpecimenView::Colours::alarm});
    for (const auto& [name, values] : table.line_data)
      if (name != "state") pair_arrays_.push_back(name), view_.pair_fields.push_back(field_of(name));
    lines_ = table.lines.size();
  }

  std::size_t bytes_per_frame() const {
    const std::size_t raw =
        view_.ids.size() * (6 + 2 * view_.fields.size()) + lines_ * (1 + 2 * view_.pair_fields.size());
    return raw * 4 / 3;
  }

  void add(const fs::path& path) {
    const PolyTable table = read_polydata(path);
    if (integers(table, true, "bead_id", path) != view_.ids)
      bad_input("{}: bead_id: found other beads than in {}, expected the same", path.string(),
                first_.filename().string());
    SpecimenView::Moment moment;
    moment.label = label_of(table);
    for (const Vec3& p : table.points) {
      if (!p.allFinite())
        bad_input("{}: found a position that is no number, expected finite ones", path.string());
      moment.centres.push_back(kUm * p);
    }
    for (const auto& name : arrays_)
      if (is_vector(table, name)) {
        std::vector<double> length, axial;
        for (const Vec3& v : vectors(table, true, name, path))
          length.push_back(v.norm()), axial.push_back(v.z());
        moment.values.push_back(std::move(length));
        moment.values.push_back(std::move(axial));
      } else {
        moment.values.push_back(numbers(table, true, name, path));
      }
    add_pairs(table, path, moment);
    view_.moments.push_back(std::move(moment));
  }

  SpecimenView take() {
    for (auto& moment : view_.moments) {
      moment.states.resize(view_.pairs.size(), SpecimenView::Pair::absent);
      for (auto& values : moment.pair_values) values.resize(view_.pairs.size(), std::nan(""));
    }
    choose_colours(view_.fields, &SpecimenView::Moment::values);
    choose_colours(view_.pair_fields, &SpecimenView::Moment::pair_values);
    set_ranges(view_);
    return std::move(view_);
  }

 private:
  static std::string label_of(const PolyTable& table) {
    const auto field = [&](const char* name) {
      const auto found = table.number_fields.find(name);
      return found == table.number_fields.end() ? std::nan("") : found->second;
    };
    const double strain = field("strain"), stress = field("stress_pa");
    std::string label = fmt::format("{:.2f} % strain", 100.0 * strain);
    if (std::isfinite(stress)) label += fmt::format(", {:.3f} MPa", 1e-6 * stress);
    return label;
  }

  void add_pairs(const PolyTable& table, const fs::path& path, SpecimenView::Moment& moment) {
    std::vector<std::size_t> places;
    for (auto [i, j] : table.lines) {
      if (i > j) std::swap(i, j);
      const auto [at, is_new] = place_of_.emplace(std::pair(i, j), view_.pairs.size());
      if (is_new) view_.pairs.push_back({i, j});
      places.push_back(at->second);
    }
    std::vector<double> broken(view_.ids.size());
    moment.states.assign(view_.pairs.size(), SpecimenView::Pair::absent);
    if (!places.empty()) {
      const auto states = integers(table, false, "state", path);
      for (std::size_t k = 0; k < places.size(); ++k) {
        if (states[k] < 0 || states[k] > 2)
          bad_input("{}: state: found {}, expected 0, 1 or 2", path.string(), states[k]);
        // A pair that broke and touches again has two lines; that it broke is what counts.
        auto& state = moment.states[places[k]];
        if (state != SpecimenView::Pair::broken) state = static_cast<SpecimenView::Pair>(states[k]);
        if (states[k] == 1)
          for (const int bead : table.lines[k]) broken[static_cast<std::size_t>(bead)] += 1.0;
      }
    }
    moment.values.push_back(std::move(broken));
    for (const auto& name : pair_arrays_) {
      std::vector<double> values(view_.pairs.size(), std::nan(""));
      const auto found = places.empty() ? std::vector<double>{} : numbers(table, false, name, path);
      for (std::size_t k = 0; k < places.size(); ++k) values[places[k]] = found[k];
      moment.pair_values.push_back(std::move(values));
    }
  }

  /// Signed where values lie on both sides of zero; alarm where most are zero.
  void choose_colours(std::vector<SpecimenView::Field>& fields,
                      std::vector<std::vector<double>> SpecimenView::Moment::*of) {
    for (std::size_t k = 0; k < fields.size(); ++k) {
      double low = 0.0, high = 0.0;
      std::size_t zeros = 0;
      const auto& values = (view_.moments.back().*of)[k];
      for (const double v : values) {
        if (v < low) low = v;
        if (v > high) high = v;
        zeros += v == 0.0;
      }
      if (low < -0.05 * high && high > -0.05 * low)
        fields[k].colours = SpecimenView::Colours::signed_values;
      else if (2 * zeros > values.size() || fields[k].name == "damage")
        fields[k].colours = SpecimenView::Colours::alarm;
    }
  }

  fs::path first_;
  SpecimenView view_;
  std::vector<std::string> arrays_, pair_arrays_;
  std::size_t lines_ = 0;
  std::map<std::pair<int, int>, std::size_t> place_of_;
};

}  // namespace

SpecimenView run_view(const RunFolder& run, std::size_t most_bytes) {
  Reader reader(run.frames.front());
  const std::size_t frames = run.frames.size();
  const std::size_t most = std::clamp<std::size_t>(most_bytes / reader.bytes_per_frame(), 1, frames);
  for (std::size_t k = 0; k < most; ++k) {
    stop_if_interrupted();
    reader.add(run.frames[most == 1 ? frames - 1 : (k * (frames - 1) + (most - 1) / 2) / (most - 1)]);
  }
  SpecimenView view = reader.take();
  view.caption = most == frames
                     ? fmt::format("The specimen in its {} frames.", frames)
                     : fmt::format("The specimen in {} of its {} frames, evenly taken.", most, frames);
  return view;
}

}  // namespace pendular::viz
