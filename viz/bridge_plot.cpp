#include "viz/bridge_plot.h"

#include <vtkAxis.h>
#include <vtkPen.h>

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

Points points_of(const Values& x, const Values& y) {
  Points points;
  for (std::size_t k = 0; k < x.size(); ++k) points.emplace_back(x[k], y[k]);
  return points;
}

void add_panel(ChartSheet& sheet, std::span<const StiffnessCurve> curves, const Panel& panel) {
  const Area area{panel.left, kBottom, kWidth, kHeight};
  const Canvas& canvas = sheet.canvas();
  vtkChartXY* chart = sheet.add_chart(area);
  double low = curves[0].diameter_um.front(), high = curves[0].diameter_um.back(), top = 0.0;
  for (const StiffnessCurve& curve : curves) {
    low = std::min(low, curve.diameter_um.front());
    high = std::max(high, curve.diameter_um.back());
    top = std::max(top, *std::max_element((curve.*panel.values).begin(), (curve.*panel.values).end()));
  }
  if (panel.measured) {
    top = std::max(top, panel.measured->second);
    const std::array bounds = {panel.measured->first, panel.measured->second};
    for (double bound : bounds)
      add_plot(chart, vtkChart::LINE, {{low, bound}, {high, bound}},
               bound == bounds[0] ? "range of measured values" : "", kGrey, canvas.scaled(3))
          ->GetPen()
          ->SetLineType(vtkPen::DASH_LINE);
  }
  for (std::size_t k = 0; k < curves.size(); ++k)
    add_plot(chart, vtkChart::LINE, points_of(curves[k].diameter_um, curves[k].*panel.values),
             curves[k].label, kColours[k % kColours.size()], canvas.scaled(5));
  set_axis(chart->GetAxis(vtkAxis::BOTTOM), low, high, canvas);
  set_axis(chart->GetAxis(vtkAxis::LEFT), 0.0, 1.25 * top, canvas);
  sheet.write("bridge diameter d (\xC2\xB5m)", area.middle_x(), 0.04);
  sheet.write_upright(panel.quantity, panel.left - 0.075, area.middle_y());
}

}  // namespace

Image draw_bridge_stiffness(const Display& display, std::span<const StiffnessCurve> curves,
                            const std::optional<MeasuredStiffness>& measured, PictureSize size) {
  ChartSheet sheet(display, size);
  Panel normal{0.10, "normal stiffness kn (N/m)", &StiffnessCurve::normal, {}};
  Panel tangential{0.60, "tangential stiffness kt (N/m)", &StiffnessCurve::tangential, {}};
  if (measured) {
    normal.measured = {measured->normal_low, measured->normal_high};
    tangential.measured = {measured->tangential_low, measured->tangential_high};
  }
  for (const Panel* panel : {&normal, &tangential}) add_panel(sheet, curves, *panel);
  return sheet.draw();
}

}  // namespace pendular::viz
