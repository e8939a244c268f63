#include "sweep/plan.h"

#include "base/error.h"
#include "effects/list.h"
#include "packing/measurement.h"

namespace pendular::sweep {
namespace {

/// The sample of one point. W comes last: it scales the diameter that the other keys have set.
Sample sample_at(const std::string& text, const SweepFile& file, const Plan::Run& run,
                 const std::vector<std::string>& keys) {
  std::vector<SampleSetting> settings;
  std::optional<double> content;
  std::string where = file.sample.string();
  for (std::size_t k = 0; k < keys.size(); ++k) {
    where += fmt::format("{} {} = {}", k == 0 ? " with" : ",", keys[k], to_string(run.values[k]));
    if (keys[k] == "W")
      content = std::get<double>(run.values[k]);
    else
      settings.emplace_back(keys[k], run.values[k]);
  }
  Sample sample = whole_sample(text, where, settings);
  effects::check_effects(sample, where);
  if (!content) return sample;
  set_polymer_content(sample, *content);
  return parse_sample("", where, sample_settings(sample));  // checked again, with its new diameter
}

/// The values of one point, from its number; the last axis is the fastest.
std::vector<SampleValue> values_at(const std::vector<Axis>& axes, std::size_t point) {
  std::vector<SampleValue> values;
  for (auto axis = axes.rbegin(); axis != axes.rend(); ++axis) {
    const auto& chosen = axis->points[point % axis->points.size()];
    values.insert(values.begin(), chosen.begin(), chosen.end());
    point /= axis->points.size();
  }
  return values;
}

/// Realisations of a specimen that is used as measured would all be one.
void check_realisations(const SweepFile& file, const Sample& sample, bool errors_stated) {
  if (file.realisations == 1 || file.packing_each) return;
  if (diameters_used(sample, errors_stated) == Diameters::measured)
    bad_input(
        "{}: beads.diameters = \"{}\" takes them as measured: found {} realisations, expected 1, because "
        "all would be the same (or \"drawn\", or packings = \"each\")",
        file.sample.string(), to_string(sample.beads.diameters), file.realisations);
}

}  // namespace

std::string to_string(const SampleValue& value) {
  if (const auto* number = std::get_if<double>(&value)) return fmt::format("{}", *number);
  if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  if (const auto* word = std::get_if<std::string>(&value)) return *word;
  return fmt::format("[{}]", fmt::join(std::get<std::vector<double>>(value), ", "));
}

Plan plan_of(const SweepFile& file) {
  Plan plan;
  std::size_t points = 1;
  for (const auto& axis : file.axes) {
    plan.keys.insert(plan.keys.end(), axis.keys.begin(), axis.keys.end());
    points *= axis.points.size();
  }
  const std::string text = read_text(file.sample);
  const PackingSource given = file.packing.empty() ? PackingSource{} : packing_file(file.packing);
  for (std::size_t point = 0; point < points; ++point) {
    Plan::Run run;
    run.point = point + 1;
    run.values = values_at(file.axes, point);
    const Sample sample = sample_at(text, file, run, plan.keys);
    check_realisations(file, sample, given.errors_stated);
    for (run.realisation = 1; run.realisation <= file.realisations; ++run.realisation) {
      run.seed = file.seed + static_cast<std::uint64_t>(run.realisation) - 1;
      plan.runs.push_back(run);
      const auto generated = generated_packing(file.packing_each ? run.seed : file.packing_seed);
      plan.requests.push_back({sample, file.packing.empty() ? generated : given, run.seed, file.keep_all});
    }
  }
  warn_of_later_keys(text, file.sample.string());
  return plan;
}

}  // namespace pendular::sweep
