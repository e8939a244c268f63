#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <memory>

#include "base/columns.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "base/number_cell.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "base/sample.h"
#include "cli/command.h"
#include "cli/picture_commands.h"
#include "micromechanics/bridge_fe.h"
#include "micromechanics/stiffness.h"
#include "reproduction/paper.h"
#include "viz/bridge_plot.h"
#include "viz/gnuplot.h"

namespace pendular::cli {
namespace {

struct BridgeOptions {
  Common common;
  fs::path sample, plot;
  std::string neck_um, gap_um, bead_um, second_bead_um, youngs_modulus_pa, poisson_ratio;
  bool paper = false;

  bool has_values() const {
    for (const auto* text :
         {&neck_um, &gap_um, &bead_um, &second_bead_um, &youngs_modulus_pa, &poisson_ratio})
      if (!text->empty()) return true;
    return false;
  }
};

struct Row {
  micromechanics::BridgeBody body;
  micromechanics::Polymer polymer;
  micromechanics::BridgeStiffness stiffness;
};

constexpr std::size_t kMostRows = 1000000;

using reproduction::kPaperPipette;
using reproduction::kPaperPoissonRatio;

// ---- Values of the options ----

[[noreturn]] void bad_list(const std::string& option, const std::string& found) {
  bad_input("{}: found \"{}\", expected a number, a comma list, or a range FROM:TO:N with N from 2 to {}",
            option, found, kMostRows);
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts = {""};
  for (char c : text)
    if (c == separator)
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

double to_number(const std::string& option, const std::string& word, const std::string& text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value))
    bad_list(option, text);
  std::string column = option.substr(2);  // --E-pa is E_pa
  std::replace(column.begin(), column.end(), '-', '_');
  require_in_range("bridge", option, range_of(column), value);
  return value;
}

/// "2", "1,2,5", "50:270:23" or a mixture, times `unit`; `otherwise` where nothing is given.
std::vector<double> values_of(const std::string& option, const std::string& text, double unit,
                              double otherwise) {
  if (text.empty()) return {otherwise};
  std::vector<double> values;
  for (const std::string& item : split(text, ',')) {
    const auto parts = split(item, ':');
    if (parts.size() == 1) {
      values.push_back(unit * to_number(option, item, text));
      continue;
    }
    if (parts.size() != 3) bad_list(option, text);
    const double from = to_number(option, parts[0], text), to = to_number(option, parts[1], text),
                 count = to_number(option, parts[2], text);
    if (!(from < to) || count != std::floor(count) || count < 2.0 || count > static_cast<double>(kMostRows))
      bad_list(option, text);
    for (int k = 0; k < static_cast<int>(count); ++k)
      values.push_back(unit * (from + (to - from) * k / (count - 1.0)));
  }
  return values;
}

std::vector<Row> rows_of(const BridgeOptions& options) {
  const Sample sample = options.sample.empty() ? Sample{} : read_sample(options.sample);
  const double um = 1e-6;
  const auto necks = values_of("--d-um", options.neck_um, um, sample.bridges.diameter);
  const auto gaps = values_of("--gap-um", options.gap_um, um, sample.bridges.gap);
  const auto beads = values_of("--D-um", options.bead_um, um, sample.beads.diameter);
  const auto second = values_of("--D2-um", options.second_bead_um, um, 0.0);  // 0: as the first
  const auto moduli = values_of("--E-pa", options.youngs_modulus_pa, 1.0, sample.bridges.youngs_modulus);
  const auto ratios = values_of("--nu", options.poisson_ratio, 1.0, sample.bridges.poisson_ratio);
  double count = 1.0;
  for (const auto* values : {&necks, &gaps, &beads, &second, &moduli, &ratios})
    count *= static_cast<double>(values->size());
  if (count > static_cast<double>(kMostRows))
    bad_input("bridge: found {:.0f} combinations of values, expected at most {}", count, kMostRows);
  std::vector<Row> rows;
  for (double bead : beads)
    for (double other : second)
      for (double modulus : moduli)
        for (double ratio : ratios)
          for (double gap : gaps)
            for (double neck : necks)
              rows.push_back(
                  {{neck, gap, bead, options.second_bead_um.empty() ? bead : other}, {modulus, ratio}, {}});
  return rows;
}

/// The lines of the paper's Fig. 2(e,f).
std::vector<Row> figure_rows() {
  std::vector<Row> rows;
  for (double gap : {1e-6, 2e-6})
    for (int neck_um = 50; neck_um <= 270; neck_um += 10)
      rows.push_back({{1e-6 * neck_um, gap, kPaperPipette.bead_diameter, kPaperPipette.bead_diameter},
                      {kPaperPipette.youngs_modulus, kPaperPoissonRatio},
                      {}});
  return rows;
}

void solve(std::vector<Row>& rows) {
  for (const Row& row : rows) micromechanics::check_bridge(row.body, row.polymer);
  Progress progress("bridges", static_cast<double>(rows.size()));
  constexpr std::size_t kBatch = 16;
  for (std::size_t start = 0; start < rows.size(); start += kBatch) {
    for_blocks(std::min(kBatch, rows.size() - start), 1, [&](std::size_t k, std::size_t) {
      Row& row = rows[start + k];
      row.stiffness = micromechanics::bridge_stiffness(row.body, row.polymer);
    });
    stop_if_interrupted();
    progress.update(static_cast<double>(std::min(start + kBatch, rows.size())));
  }
}

void warn_outside(const std::vector<Row>& rows) {
  std::size_t outside = 0;
  double worst = 0.0;
  for (const Row& row : rows)
    if (!micromechanics::within_verified_range(row.body, row.polymer)) {
      ++outside;
      worst = std::max(worst, row.stiffness.error_estimate);
    }
  if (outside > 0)
    warn(fmt::format(
        "{} of {} bridges lie outside d/D from 0.1 to 0.8, gap/D from 0.001 to 0.1, D2/D from 0.8 to 1.25, "
        "nu to "
        "0.499, where the error has been shown to stay below 0.1 %; their largest estimate is {:.2g} %",
        outside, rows.size(), 100.0 * worst));
}

// ---- Output ----

std::string csv_of(const std::vector<Row>& rows, const Provenance& where_from) {
  std::string text = to_comment(where_from) +
                     "d_um,D_um,gap_um,E_pa,nu,kn_n_per_m,kt_n_per_m,k_bend_n_m_per_rad,k_twist_n_m_per_rad,"
                     "error_estimate,D2_um,k_coupling_n_per_rad,mean_stress_average_pa_per_m,"
                     "axial_stress_average_pa_per_m,mean_stress_centre_pa_per_m,axial_stress_centre_pa_per_m,"
                     "axial_stress_rim_pa_per_m\n";
  for (const Row& row : rows) {
    const micromechanics::BridgeStiffness& k = row.stiffness;
    text += fmt::format(
        "{:.8g},{:.8g},{:.8g},{:.8g},{:.8g},{:.9g},{:.9g},{:.9g},{:.9g},{:.2e},{:.8g},{:.6g},{:.6g},{:.6g},{:"
        ".6g},"
        "{:.6g},{:.6g}\n",
        1e6 * row.body.neck_diameter, 1e6 * row.body.diameter_i, 1e6 * row.body.gap,
        row.polymer.youngs_modulus, row.polymer.poisson_ratio, NumberCell{k.normal}, NumberCell{k.tangential},
        NumberCell{k.bending}, NumberCell{k.twisting}, NumberCell{k.error_estimate},
        1e6 * row.body.diameter_j, NumberCell{k.coupling}, NumberCell{k.stress.mean_average},
        NumberCell{k.stress.axial_average}, NumberCell{k.stress.mean_centre},
        NumberCell{k.stress.axial_centre}, NumberCell{k.stress.axial_rim});
  }
  return text;
}

std::string label_of(const Row& row, const std::vector<Row>& all) {
  const auto varies = [&](auto value) {
    return std::any_of(all.begin(), all.end(), [&](const Row& other) { return value(other) != value(row); });
  };
  std::string label = fmt::format("gap {:.4g} \u00b5m", 1e6 * row.body.gap);
  if (varies([](const Row& r) { return r.body.diameter_i; }))
    label += fmt::format(", D {:.4g} \u00b5m", 1e6 * row.body.diameter_i);
  if (varies([](const Row& r) { return r.body.diameter_j; }))
    label += fmt::format(", D2 {:.4g} \u00b5m", 1e6 * row.body.diameter_j);
  if (varies([](const Row& r) { return r.polymer.youngs_modulus; }))
    label += fmt::format(", E {:.4g} Pa", row.polymer.youngs_modulus);
  if (varies([](const Row& r) { return r.polymer.poisson_ratio; }))
    label += fmt::format(", nu {:.4g}", row.polymer.poisson_ratio);
  return label;
}

/// One curve for each run of rows that differ in the bridge's diameter alone.
std::vector<viz::StiffnessCurve> curves_of(const std::vector<Row>& rows) {
  std::vector<viz::StiffnessCurve> curves;
  for (const Row& row : rows) {
    const std::string label = label_of(row, rows);
    if (curves.empty() || curves.back().label != label) curves.push_back({label, {}, {}, {}});
    viz::StiffnessCurve& curve = curves.back();
    const double neck_um = 1e6 * row.body.neck_diameter;
    if (!curve.diameter_um.empty() && neck_um <= curve.diameter_um.back())
      bad_input("--plot: found {} um after {} um in --d-um, expected rising values", neck_um,
                curve.diameter_um.back());
    curve.diameter_um.push_back(neck_um);
    curve.normal.push_back(row.stiffness.normal);
    curve.tangential.push_back(row.stiffness.tangential);
  }
  if (curves.front().diameter_um.size() < 2)
    bad_input("--plot: found one value of --d-um, expected at least two");
  if (curves.size() > 12) bad_input("--plot: found {} curves, expected at most 12", curves.size());
  return curves;
}

/// "kn paper, ours, difference": 5760 against 5517 gives −4.2 %.
std::string with_departure(double paper, double ours) {
  return fmt::format("{:>9.0f} {:>9.1f} {:>+8.1f} %", paper, ours, 100.0 * (ours / paper - 1.0));
}

/// Table 1 of the paper beside this program.
void print_table_1() {
  const auto of = [](double neck, double gap, double bead, double modulus) {
    return micromechanics::bridge_stiffness({neck, gap, bead, bead}, {modulus, kPaperPoissonRatio});
  };
  fmt::print("Hemmerle et al. 2021, Table 1, beside finite elements (gap 2 um, Poisson ratio 0.49)\n\n");
  fmt::print("{:<10} {:>8} {:>6} {:>6}   {:>31}   {:>31}\n", "", "E_p", "d", "D", "kn (N/m)", "kt (N/m)");
  fmt::print("{:<10} {:>8} {:>6} {:>6}   {:>9} {:>9} {:>11}   {:>9} {:>9} {:>11}\n", "", "(Pa)", "(um)",
             "(um)", "paper", "ours", "difference", "paper", "ours", "difference");
  double worst = 0.0;
  for (const auto& s : reproduction::kPaperSpecimens) {
    const micromechanics::BridgeStiffness k =
        of(s.neck_diameter, reproduction::kPaperGap, s.bead_diameter, s.youngs_modulus);
    worst = std::max(worst, k.error_estimate);
    fmt::print("{:<10} {:>8.3g} {:>6.1f} {:>6.1f}   {}   {}\n", s.name, s.youngs_modulus,
               1e6 * s.neck_diameter, 1e6 * s.bead_diameter, with_departure(s.normal_stiffness, k.normal),
               with_departure(s.tangential_stiffness, k.tangential));
  }
  fmt::print(
      "\nMicromechanical tests (E_p 50 kPa, d 50 to 270 um, D 365 um); measured kn 200 to 800, kt 5 to 30 "
      "N/m\n");
  for (double gap_um : {2.0, 1.0}) {
    const auto of_tests = [&](double neck) {
      return of(neck, 1e-6 * gap_um, kPaperPipette.bead_diameter, kPaperPipette.youngs_modulus);
    };
    const micromechanics::BridgeStiffness thin = of_tests(kPaperPipette.thinnest),
                                          wide = of_tests(kPaperPipette.widest);
    worst = std::max({worst, thin.error_estimate, wide.error_estimate});
    fmt::print("  gap {:.0f} um: ours kn {:.0f} to {:.0f}, kt {:.1f} to {:.1f} N/m\n", gap_um, thin.normal,
               wide.normal, thin.tangential, wide.tangential);
  }
  fmt::print("\nLargest error estimate of these: {:.2g} %\n", 100.0 * worst);
}

/// This run's provenance, which names no output.
Provenance provenance_of(const BridgeOptions& options) {
  std::vector<fs::path> inputs;
  if (!options.sample.empty()) inputs.push_back(options.sample);
  Provenance result = provenance(options.common, inputs);
  for (const char* separator : {" ", "="}) {
    const std::string words = " --plot" + (separator + options.plot.string());
    if (const auto at = result.command.find(words); !options.plot.empty() && at != std::string::npos)
      result.command.erase(at, words.size());
  }
  return result;
}

void run(const BridgeOptions& options) {
  apply(options.common, {options.sample}, {options.common.out, options.plot});
  if (options.paper && (options.has_values() || !options.sample.empty()))
    throw BadUsage("bridge: --paper goes without a sample and without values");
  if (!options.plot.empty() && !viz::is_figure_name(options.plot))
    throw BadUsage(fmt::format("bridge: --plot: found {}, expected a name ending in .svg, .pdf or .png",
                               options.plot.string()));
  const bool asks = options.paper || options.has_values() || !options.sample.empty();
  if (!asks && options.common.out.empty() && options.plot.empty()) return print_table_1();

  std::vector<Row> rows = options.paper ? figure_rows() : rows_of(options);
  if (!options.plot.empty()) curves_of(rows);  // complains before the work
  solve(rows);
  warn_outside(rows);
  const Provenance where_from = provenance_of(options);
  const std::string csv = csv_of(rows, where_from);
  WrittenTogether written;
  if (options.common.out.empty())
    fmt::print("{}", csv);
  else
    write_text(options.common.out, csv);
  if (options.plot.empty()) return written.commit();
  const auto curves = curves_of(rows);
  std::optional<viz::MeasuredStiffness> measured;
  if (options.paper)
    measured = {kPaperPipette.normal_low, kPaperPipette.normal_high, kPaperPipette.tangential_low,
                kPaperPipette.tangential_high};
  viz::write_figure(viz::stiffness_figure(curves, measured), {options.plot}, to_comment(where_from));
  written.commit();
}

}  // namespace

void add_bridge(CLI::App& app) {
  auto options = std::make_shared<BridgeOptions>();
  auto* command = add_picture_command(app, "bridge");
  command->add_option("sample", options->sample, "Sample file (.toml)");
  command->add_option("--d-um", options->neck_um, "Bridge diameter d, um");
  command->add_option("--gap-um", options->gap_um, "Gap between the beads' surfaces, um");
  command->add_option("--D-um", options->bead_um, "Bead diameter D, um");
  command->add_option("--D2-um", options->second_bead_um, "Diameter of the second bead, um [as the first]");
  command->add_option("--E-pa", options->youngs_modulus_pa, "Young's modulus of the polymer, Pa");
  command->add_option("--nu", options->poisson_ratio, "Poisson ratio of the polymer");
  command->add_flag("--paper", options->paper, "The bridges of the paper's Fig. 2(e,f) instead");
  command->add_option("--plot", options->plot, "Draw kn and kt over d (.svg, .pdf or .png)");
  add_common(*command, options->common, "Table to write (.csv) [standard output]");
  command->get_option("--out")->required(false);
  command->callback([options] { run(*options); });
}

}  // namespace pendular::cli
