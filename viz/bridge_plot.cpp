#include "viz/bridge_plot.h"

#include <algorithm>
#include <array>

#include "viz/chart.h"

namespace pendular::viz {
namespace {

using Values = std::vector<double>;

constexpr std::array<Colour, 6> kColours = {
    {{31, 90, 165}, {190, 40, 30}, {20, 130, 80}, {150, 90, 20}, {110, 60, 150}, {30, 30, 30}}};
constexpr Colour kGrey = {130, 130, 130};

/// One of the two plots, placed in shares of the picture.
struct Panel {
  double left;
  std::string quantity;
  const Values StiffnessCurve::*values;
  std::optional<std::pair<double, double>> measured;
};
constexpr double kBottom = 0.14, kWidth = 0.38, kHeight = 0.78;
constexpr double kRoom = 0.08, kLegendLine = 0.055;  // above the highest value, in shares of it

Points points_of(const Values& x, const Values& y) {
  Points points;
  for (std::size_t k = 0; k < x.size(); ++k) points.emplace_back(x[k], y[k]);
  return points;
}

void add_panel(Sheet& sheet, std::span<const StiffnessCurve> curves, const Panel& panel) {
  double low = curves[0].diameter_um.front(), high = curves[0].diameter_um.back(),
         top = panel.measured ? panel.measured->second : 0.0;
  for (const StiffnessCurve& curve : curves) {
    low = std::min(low, curve.diameter_um.front());
    high = std::max(high, curve.diameter_um.back());
    top = std::max(top, *std::max_element((curve.*panel.values).begin(), (curve.*panel.values).end()));
  }
  const auto lines = static_cast<double>(curves.size() + (panel.measured ? 1 : 0));
  const Area area{panel.left, kBottom, kWidth, kHeight};
  Chart chart(area, {low, high}, {0.0, (1.0 + kRoom + kLegendLine * lines) * top});
  if (panel.measured) {
    const auto [least, most] = *panel.measured;
    const Pen pen{kGrey, sheet.scaled(3), true};
    chart.add_line({{low, least}, {high, least}}, pen, "range of measured values");
    chart.add_line({{low, most}, {high, most}}, pen);
  }
  for (std::size_t k = 0; k < curves.size(); ++k)
    chart.add_line(points_of(curves[k].diameter_um, curves[k].*panel.values),
                   {kColours[k % kColours.size()], sheet.scaled(5)}, curves[k].label);
  sheet.add(chart);
  sheet.write("bridge diameter d (\u00b5m)", area.middle_x(), 0.04);
  sheet.write_upright(panel.quantity, panel.left - 0.075, area.middle_y());
}

}  // namespace

Figure stiffness_figure(std::span<const StiffnessCurve> curves,
                        const std::optional<MeasuredStiffness>& measured, PictureSize size) {
  Sheet sheet(size);
  Panel normal{0.10, "normal stiffness kn (N/m)", &StiffnessCurve::normal, {}};
  Panel tangential{0.60, "tangential stiffness kt (N/m)", &StiffnessCurve::tangential, {}};
  if (measured) {
    normal.measured = {measured->normal_low, measured->normal_high};
    tangential.measured = {measured->tangential_low, measured->tangential_high};
  }
  for (const Panel* panel : {&normal, &tangential}) add_panel(sheet, curves, *panel);
  return sheet.figure();
}

}  // namespace pendular::viz
