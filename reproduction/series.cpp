#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <optional>

#include "base/csv.h"
#include "micromechanics/stiffness.h"
#include "reproduction/paper.h"
#include "reproduction/sections.h"
#include "viz/series_plot.h"

namespace pendular::reproduction {
namespace {

using viz::Series;

/// A point of a series in numbers.
struct Entry {
  double gap, polymer, content, normal_stiffness, bead_diameter;
  Spread modulus, fixed, limit;  ///< `fixed`: the slope at a fixed strain

  double over_polymer() const { return modulus.mean / polymer; }
};

std::vector<Entry> entries_of(const std::vector<Point>& points) {
  std::vector<Entry> entries;
  for (const auto& point : points) {
    const auto& bridges = point.sample.bridges;
    entries.push_back({bridges.gap, bridges.youngs_modulus, bridges.polymer_content,
                       micromechanics::bond_stiffness(point.sample).normal, point.sample.beads.diameter,
                       spread_of(point, modulus), spread_of(point, slope_at_fixed_strain),
                       spread_of(point, linear_limit)});
  }
  return entries;
}

std::vector<Entry> with_gap(const std::vector<Entry>& entries, double gap) {
  std::vector<Entry> found;
  std::copy_if(entries.begin(), entries.end(), std::back_inserter(found),
               [&](const Entry& e) { return e.gap == gap; });
  return found;
}

/// Gaps in the order in which they come.
std::vector<double> gaps_of(const std::vector<Entry>& entries) {
  std::vector<double> gaps;
  for (const auto& e : entries)
    if (std::find(gaps.begin(), gaps.end(), e.gap) == gaps.end()) gaps.push_back(e.gap);
  return gaps;
}

std::string csv_of(const std::vector<Entry>& entries) {
  std::string csv =
      "gap_um,E_p_pa,W,kn_n_per_m,modulus_pa,modulus_sd_pa,runs,slope_at_2_to_3_percent_pa,slope_sd_pa,"
      "linear_limit,linear_limit_sd\n";
  const auto cell = [](double value) { return csv_cell(value, 6); };
  for (const auto& e : entries)
    csv += fmt::format("{:g},{:g},{:g},{},{},{},{},{},{},{},{}\n", 1e6 * e.gap, e.polymer, e.content,
                       cell(e.normal_stiffness), cell(e.modulus.mean), cell(e.modulus.sd), e.modulus.count,
                       cell(e.fixed.mean), cell(e.fixed.sd), cell(e.limit.mean), cell(e.limit.sd));
  return csv;
}

/// Values over E_p, one series for each gap.
std::vector<Series> over_polymer(const std::vector<Entry>& entries, const std::string& words,
                                 Spread Entry::*quantity, double unit) {
  std::vector<Series> all;
  for (const double gap : gaps_of(entries)) {
    Series& series = all.emplace_back();
    series.label = fmt::format("{}gap {:g} µm", words, 1e6 * gap);
    for (const auto& e : with_gap(entries, gap)) {
      series.x.push_back(1e-6 * e.polymer);
      series.y.push_back((e.*quantity).mean / unit);
      series.sd.push_back((e.*quantity).sd / unit);
    }
  }
  return all;
}

/// Ratio of a value at the smaller of two gaps over that at the larger, at the sample's own polymer or the
/// nearest to it.
std::optional<std::pair<Entry, Entry>> both_gaps(const std::vector<Entry>& entries) {
  const auto gaps = gaps_of(entries);
  if (gaps.size() != 2) return std::nullopt;
  const auto nearest = [&](double gap) {
    const auto group = with_gap(entries, gap);
    return *std::min_element(group.begin(), group.end(), [](const Entry& a, const Entry& b) {
      const double own = std::log(kPaperSpecimens[0].youngs_modulus);
      return std::abs(std::log(a.polymer) - own) < std::abs(std::log(b.polymer) - own);
    });
  };
  return std::pair(nearest(std::min(gaps[0], gaps[1])), nearest(std::max(gaps[0], gaps[1])));
}

void compare_gaps(const std::vector<Entry>& entries, Section& section) {
  const auto pair = both_gaps(entries);
  if (!pair) return;
  const auto& [small, large] = *pair;
  const double effect = small.modulus.mean / large.modulus.mean, fixed = small.fixed.mean / large.fixed.mean,
               kn = small.normal_stiffness / large.normal_stiffness;
  section.comparisons.push_back(
      {fmt::format("E at gap {:g} µm over gap {:g} µm, E_p = {:g} MPa", 1e6 * small.gap, 1e6 * large.gap,
                   1e-6 * small.polymer),
       "about 1.6", fmt::format("{:.2f}; at 2 to 3 % strain {:.2f}; kn {:.2f}", effect, fixed, kn),
       within(effect, kPaperGapEffect - 0.15, kPaperGapEffect + 0.15),
       "At a fixed strain E follows kn as the paper says. Read as a curve's steepest part, E gains less: "
       "stiffer bonds carry the same breaking strain, but reach it on another part of a curve that bends "
       "upwards."});
}

void compare_law(const std::vector<Entry>& group, Section& section) {
  const Entry &soft = group.front(), &stiff = group.back();
  section.comparisons.push_back(
      {fmt::format("E over E_p, gap {:g} µm, from E_p = {:g} to {:g} MPa", 1e6 * soft.gap,
                   1e-6 * soft.polymer, 1e-6 * stiff.polymer),
       "about ten to twenty", fmt::format("{:.1f} to {:.1f}", soft.over_polymer(), stiff.over_polymer()),
       within(soft.over_polymer(), 10.0, 20.0) && within(stiff.over_polymer(), 10.0, 20.0),
       "Soft bonds do not break within the strain shown; the curve goes on bending upwards as more glass "
       "touches, "
       "and its steepest part lies at its end."});
  section.comparisons.push_back(
      {"E against E_p for stiff polymer", "less than proportional",
       fmt::format("E/E_p falls by {:.0f} %", 100.0 * (1.0 - stiff.over_polymer() / soft.over_polymer())),
       stiff.over_polymer() < 0.9 * soft.over_polymer()});
  double low = std::numeric_limits<double>::infinity(), high = 0.0;
  for (const auto& e : group)
    if (e.limit.count > 0) low = std::min(low, e.limit.mean), high = std::max(high, e.limit.mean);
  if (!(high > 0.0)) return;
  section.comparisons.push_back(
      {"linear limit over decades of E_p", "one strain, independent of E_p (Hemmerle 2016)",
       fmt::format("{:.1f} to {:.1f} % where there is one", 100.0 * low, 100.0 * high), high < 1.25 * low,
       "The criterion breaks a bond at a stretch of √(2 G l/E_p): with one G for all polymers the limit "
       "falls as "
       "E_p rises. A limit that does not depend on E_p needs G ∝ E_p."});
}

Table table_of(const std::vector<Entry>& entries) {
  Table table{{"gap, µm", "E_p, MPa", "kn, N/m", "E, MPa", "E/E_p", "E D/kn", "slope at 2–3 %, D/kn",
               "linear limit, %"},
              {}};
  for (const auto& e : entries)
    table.rows.push_back({fmt::format("{:g}", 1e6 * e.gap), fmt::format("{:g}", 1e-6 * e.polymer),
                          fmt::format("{:.0f}", e.normal_stiffness), in_words(e.modulus, 1e6, 2),
                          fmt::format("{:.1f}", e.over_polymer()),
                          in_words(e.modulus, e.normal_stiffness / e.bead_diameter, 2),
                          in_words(e.fixed, e.normal_stiffness / e.bead_diameter, 2),
                          in_words(e.limit, 0.01, 2)});
  return table;
}

/// The exponent n of value ∝ W^n between the first and the last of some entries.
double exponent(const std::vector<Entry>& entries, const std::function<double(const Entry&)>& value) {
  const Entry &first = entries.front(), &last = entries.back();
  return std::log(value(last) / value(first)) / std::log(last.content / first.content);
}

void compare_content(const std::vector<Entry>& entries, Section& section) {
  std::vector<Entry> pendular;
  for (const auto& e : entries)
    if (e.content <= kPaperFunicularContent) pendular.push_back(e);
  if (pendular.size() < 2) return;
  const double e = exponent(pendular, [](const Entry&entry) { return entry.modulus.mean; }),
               kn = exponent(pendular, [](const Entry&entry) { return entry.normal_stiffness; });
  section.comparisons.push_back(
      {fmt::format("E against W from {:g} to {:g} %", 100.0 * pendular.front().content,
                   100.0 * pendular.back().content),
       "about linear", fmt::format("E ∝ W^{:.2f}; kn ∝ W^{:.2f}", e, kn), within(e, 0.8, 1.2),
       "The stiffness of a bridge grows much more slowly than its cross-section, because what is added at "
       "the rim is "
       "higher, and E follows it: E D/kn at a fixed strain is nearly one number."});
}

}  // namespace

Section stiffness_section(const Desk& desk, const std::vector<Point>& points) {
  const auto entries = entries_of(points);
  Section section{
      "E against E_p (Fig. 4)",
      "Sample A's material in a smaller cylinder, stiffness of bridges by finite elements. In model units "
      "nothing but the breaking criterion knows E_p: as long as no bond breaks, E D/kn must be the same "
      "number for all, and the table shows it."};
  compare_gaps(entries, section);
  for (const double gap : gaps_of(entries)) compare_law(with_gap(entries, gap), section);
  section.table = table_of(entries);
  auto series = over_polymer(entries, "", &Entry::modulus, 1e6);
  const auto& x = series.front().x;
  if (!x.empty()) {
    const auto [low, high] = std::minmax_element(x.begin(), x.end());
    series.push_back({"E = E_p", {*low, *high}, {*low, *high}, {}, Series::Look::dashes});
  }
  section.figures.push_back(desk.keep("modulus_of_e_p",
                                      viz::series_figure(series, {"E_p (MPa)", true}, {"E (MPa)", true}),
                                      csv_of(entries), "E against E_p."));
  const auto limits = over_polymer(entries, "", &Entry::limit, 0.01);
  if (std::any_of(entries.begin(), entries.end(), [](const Entry& e) { return e.limit.count > 0; }))
    section.figures.push_back(
        desk.keep("limit_of_e_p", viz::series_figure(limits, {"E_p (MPa)", true}, {"linear limit (%)"}),
                  csv_of(entries), "Strain at the end of the linear part, beyond the toe, against E_p."));
  return section;
}

Section content_section(const Desk& desk, const std::vector<Point>& points) {
  const auto entries = entries_of(points);
  Section section{
      "E against W (Fig. 5)",
      "The same cylinder; the bridges' diameter follows W ∝ d². The simulation knows no funicular "
      "bridges and goes on rising beyond W* = 2.7 %, as the paper's does."};
  compare_content(entries, section);
  section.table = table_of(entries);
  section.table->columns.front() = "W, %";
  for (std::size_t k = 0; k < entries.size(); ++k)
    section.table->rows[k].front() = fmt::format("{:g}", 100.0 * entries[k].content);
  Series e{"E", {}, {}, {}}, fixed{"slope at 2 to 3 % strain", {}, {}, {}};
  double highest = 0.0;
  for (const auto& entry : entries) {
    for (auto [series, value] : {std::pair(&e, entry.modulus), std::pair(&fixed, entry.fixed)}) {
      series->x.push_back(100.0 * entry.content);
      series->y.push_back(1e-6 * value.mean);
      series->sd.push_back(1e-6 * value.sd);
    }
    highest = std::max(highest, e.y.back());
  }
  const double critical = 100.0 * kPaperFunicularContent;
  const std::vector<Series> series = {
      e, fixed, {"W*", {critical, critical}, {0.0, highest}, {}, Series::Look::dashes}};
  section.figures.push_back(desk.keep("modulus_of_content",
                                      viz::series_figure(series, {"W (%)"}, {"E (MPa)"}), csv_of(entries),
                                      "E against W."));
  return section;
}

}  // namespace pendular::reproduction
