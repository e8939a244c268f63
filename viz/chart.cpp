#include "viz/chart.h"

#include <vtkAxis.h>
#include <vtkBrush.h>
#include <vtkChartLegend.h>
#include <vtkContextScene.h>
#include <vtkDoubleArray.h>
#include <vtkPen.h>
#include <vtkPlotArea.h>
#include <vtkStringArray.h>
#include <vtkTable.h>
#include <vtkTextProperty.h>

#include <fmt/format.h>

#include <cmath>

#include "viz/ticks.h"

namespace pendular::viz {

ChartSheet::ChartSheet(const Display& display, PictureSize size, double zoom) : canvas_(display, size, zoom) {
  renderer_->SetBackground(1.0, 1.0, 1.0);
  canvas_.window()->AddRenderer(renderer_);
  renderer_->AddActor(actor_);
  actor_->GetScene()->SetRenderer(renderer_);
}

vtkChartXY* ChartSheet::add_chart(const Area& area) {
  vtkNew<vtkChartXY> chart;
  actor_->GetScene()->AddItem(chart);
  const int* window = canvas_.window()->GetSize();
  chart->SetLayoutStrategy(vtkChart::AXES_TO_RECT);
  chart->SetSize(
      vtkRectf(static_cast<float>(area.left * window[0]), static_cast<float>(area.bottom * window[1]),
               static_cast<float>(area.width * window[0]), static_cast<float>(area.height * window[1])));
  chart->SetShowLegend(true);
  vtkChartLegend* legend = chart->GetLegend();
  legend->SetLabelSize(canvas_.scaled(30));
  legend->SetSymbolWidth(canvas_.scaled(60));
  legend->SetPadding(canvas_.scaled(12));
  legend->SetHorizontalAlignment(vtkChartLegend::LEFT);
  legend->SetVerticalAlignment(vtkChartLegend::TOP);
  legend->GetPen()->SetOpacity(0);
  legend->GetBrush()->SetOpacity(0);
  return chart;
}

void ChartSheet::write(const std::string& words, double x, double y) {
  add_text(renderer_, canvas_, words, x, y, {.size = 36, .align = Align::centre});
}

void ChartSheet::write_upright(const std::string& words, double x, double y) {
  add_text(renderer_, canvas_, words, x, y, {.size = 36, .align = Align::centre, .angle = 90});
}

void ChartSheet::write(const std::string& words, double x, double y, const TextStyle& style) {
  add_text(renderer_, canvas_, words, x, y, style);
}

vtkPlot* add_plot(vtkChartXY* chart, int kind, const Points& points, const std::string& label, Colour colour,
                  double width) {
  vtkNew<vtkDoubleArray> x, y;
  x->SetName("x");
  y->SetName("y");
  for (const auto& [px, py] : points) {
    x->InsertNextValue(px);
    y->InsertNextValue(py);
  }
  vtkNew<vtkTable> table;
  table->AddColumn(x);
  table->AddColumn(y);
  vtkPlot* plot = chart->AddPlot(kind);
  plot->SetInputData(table, 0, 1);
  plot->SetLabel(label.empty() ? label : " " + label);
  plot->SetColor(colour.r, colour.g, colour.b, 255);
  plot->SetWidth(static_cast<float>(width));
  return plot;
}

void add_fill(vtkChartXY* chart, const std::vector<double>& x, const std::vector<double>& low,
              const std::vector<double>& high, const std::string& label, Colour colour,
              unsigned char opacity) {
  vtkNew<vtkTable> table;
  const auto add = [&](const char* name, const std::vector<double>& values) {
    vtkNew<vtkDoubleArray> column;
    column->SetName(name);
    for (const double v : values) column->InsertNextValue(v);
    // vtkPlotArea draws nothing of a strip between two places only.
    if (values.size() == 2) column->InsertNextValue(values.back());
    table->AddColumn(column);
  };
  add("x", x), add("low", low), add("high", high);
  auto* area = vtkPlotArea::SafeDownCast(chart->AddPlot(vtkChart::AREA));
  area->SetInputData(table);
  area->SetInputArray(0, "x");
  area->SetInputArray(1, "low");
  area->SetInputArray(2, "high");
  area->SetLabel(label.empty() ? label : " " + label);
  area->SetColor(colour.r, colour.g, colour.b, opacity);
}

namespace {

void fix_axis(vtkAxis* axis, double low, double high, const Ticks& ticks, const Canvas& canvas) {
  vtkNew<vtkDoubleArray> positions;
  vtkNew<vtkStringArray> labels;
  for (std::size_t k = 0; k < ticks.values.size(); ++k) {
    positions->InsertNextValue(ticks.values[k]);
    labels->InsertNextValue(ticks.labels[k]);
  }
  axis->SetBehavior(vtkAxis::FIXED);
  axis->SetRange(low, high);
  axis->SetCustomTickPositions(positions, labels);
  axis->SetTitle("");
  axis->SetGridVisible(false);
  axis->SetVisible(true);
  axis->SetTickLength(static_cast<float>(canvas.scaled(10)));
  axis->SetLabelOffset(static_cast<float>(canvas.scaled(18)));
  axis->GetPen()->SetWidth(static_cast<float>(canvas.scaled(2.5)));
  axis->GetLabelProperties()->SetFontFamilyToArial();
  axis->GetLabelProperties()->SetColor(0.05, 0.05, 0.05);
  axis->GetLabelProperties()->SetFontSize(canvas.scaled(34));
}

}  // namespace

void set_axis(vtkAxis* axis, double low, double high, const Canvas& canvas, double scale, int wanted) {
  Ticks ticks = round_ticks(low * scale, high * scale, wanted);
  for (double& value : ticks.values) value /= scale;
  fix_axis(axis, low, high, ticks, canvas);
}

void set_log_axis(vtkAxis* axis, double low, double high, const Canvas& canvas) {
  Ticks ticks;
  for (double power = std::ceil(low - 1e-9); power <= high + 1e-9; power += 1.0) {
    ticks.values.push_back(power);
    ticks.labels.push_back(fmt::format("{:g}", std::pow(10.0, power)));
  }
  fix_axis(axis, low, high, ticks, canvas);
}

void set_bare_axis(vtkAxis* axis, double low, double high, const Canvas& canvas) {
  fix_axis(axis, low, high, {}, canvas);
}

}  // namespace pendular::viz
