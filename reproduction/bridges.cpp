#include <fmt/format.h>

#include "base/number_cell.h"
#include "micromechanics/bridge_fe.h"
#include "reproduction/paper.h"
#include "reproduction/sections.h"
#include "viz/bridge_plot.h"

namespace pendular::reproduction {
namespace {

micromechanics::BridgeStiffness stiffness(double neck, double gap, double bead, double modulus) {
  return micromechanics::bridge_stiffness({neck, gap, bead, bead}, {modulus, kPaperPoissonRatio});
}

Comparison beside(const std::string& quantity, double paper, double ours) {
  const double off = ours / paper - 1.0;
  return {quantity, fmt::format("{:.0f} N/m", paper),
          fmt::format("{:.0f} N/m ({:+.1f} %)", ours, 100.0 * off), within(off, -0.02, 0.02),
          "The paper's look-up table is good to about 2 %; ours is converged to 0.1 %."};
}

/// Whether the stiffness at both ends of the range of diameters covers what was measured, to a half or twice.
Comparison pipette(const std::string& quantity, double low, double high, double softest, double stiffest) {
  return {quantity, fmt::format("{:.0f} to {:.0f} N/m", low, high),
          fmt::format("{:.0f} to {:.0f} N/m", softest, stiffest),
          within(softest / low, 0.5, 2.0) && within(stiffest / high, 0.5, 2.0)};
}

}  // namespace

Section bridges_section(const Desk& desk) {
  Section section{
      "Single bridges (Table 1, Fig. 2)",
      "Finite elements on the paper's geometry, gap 2 µm and Poisson ratio 0.49 for the samples. For "
      "the micropipette tests the range spans bridge diameters of 50 to 270 µm and gaps of 2 and 1 µm. "
      "The samples A and B below use the paper's own stiffness, the series the finite elements."};
  for (const auto& s : kPaperSpecimens) {
    const auto k = stiffness(s.neck_diameter, kPaperGap, s.bead_diameter, s.youngs_modulus);
    section.comparisons.push_back(beside(fmt::format("{}, kn", s.name), s.normal_stiffness, k.normal));
    section.comparisons.push_back(
        beside(fmt::format("{}, kt", s.name), s.tangential_stiffness, k.tangential));
  }
  constexpr PaperPipette p = kPaperPipette;
  std::vector<viz::StiffnessCurve> curves;
  std::string csv = "gap_um,d_um,kn_n_per_m,kt_n_per_m\n";
  for (const double gap : {2e-6, 1e-6}) {
    auto& curve = curves.emplace_back(viz::StiffnessCurve{fmt::format("gap {:g} µm", 1e6 * gap), {}, {}, {}});
    for (int n = 0; n <= 11; ++n) {
      const double neck = p.thinnest + (p.widest - p.thinnest) * n / 11.0;
      const auto k = stiffness(neck, gap, p.bead_diameter, p.youngs_modulus);
      curve.diameter_um.push_back(1e6 * neck);
      curve.normal.push_back(k.normal);
      curve.tangential.push_back(k.tangential);
      csv += fmt::format("{:g},{:g},{:.6g},{:.6g}\n", 1e6 * gap, 1e6 * neck, NumberCell{k.normal},
                         NumberCell{k.tangential});
    }
  }
  section.comparisons.push_back(pipette("Micropipette tests, kn", p.normal_low, p.normal_high,
                                        curves[0].normal.front(), curves[1].normal.back()));
  section.comparisons.push_back(pipette("Micropipette tests, kt", p.tangential_low, p.tangential_high,
                                        curves[0].tangential.front(), curves[1].tangential.back()));
  const viz::MeasuredStiffness measured{p.normal_low, p.normal_high, p.tangential_low, p.tangential_high};
  section.figures.push_back(desk.keep("bridges", viz::stiffness_figure(curves, measured), csv,
                                      "Stiffness of a bridge of the micropipette tests over its diameter."));
  return section;
}

}  // namespace pendular::reproduction
