#pragma once

// What the plots of the viz folder are drawn with. Internal: knows VTK.

#include <vtkChartXY.h>
#include <vtkContextActor.h>
#include <vtkNew.h>
#include <vtkPlot.h>
#include <vtkRenderer.h>

#include <string>
#include <utility>
#include <vector>

#include "viz/annotation.h"
#include "viz/canvas.h"

namespace pendular::viz {

struct Colour {
  unsigned char r, g, b;
};

/// A rectangle in shares of the picture.
struct Area {
  double left, bottom, width, height;
  double middle_x() const { return left + 0.5 * width; }
  double middle_y() const { return bottom + 0.5 * height; }
};

using Points = std::vector<std::pair<double, double>>;

/// A white picture that holds charts and words.
class ChartSheet {
 public:
  ChartSheet(const Display& display, PictureSize size, double zoom = 0.0);

  /// An empty chart whose axes enclose `area`, with its legend in the upper left corner.
  vtkChartXY* add_chart(const Area& area);

  /// Words centred at a place in shares of the picture; upright ones read upwards.
  void write(const std::string& words, double x, double y);
  void write_upright(const std::string& words, double x, double y);
  void write(const std::string& words, double x, double y, const TextStyle& style);

  vtkRenderer* renderer() { return renderer_; }
  const Canvas& canvas() const { return canvas_; }
  Image draw() { return canvas_.draw(); }

 private:
  Canvas canvas_;
  vtkNew<vtkRenderer> renderer_;
  vtkNew<vtkContextActor> actor_;
};

/// Adds points, a line or bars (vtkChart::POINTS, …); an empty label stays out of the legend.
vtkPlot* add_plot(vtkChartXY* chart, int kind, const Points& points, const std::string& label, Colour colour,
                  double width);

/// Fills what lies between `low` and `high` over `x`; `opacity` from 0 to 255.
void add_fill(vtkChartXY* chart, const std::vector<double>& x, const std::vector<double>& low,
              const std::vector<double>& high, const std::string& label, Colour colour,
              unsigned char opacity);

/// Fixes an axis to [low, high] with at most about `ticks` round ticks. `scale`: value of a tick's label over
/// its place on the axis.
void set_axis(vtkAxis* axis, double low, double high, const Canvas& canvas, double scale = 1.0,
              int ticks = 6);

/// Fixes an axis on which places are decadic logarithms to [low, high], with a tick at each whole power.
void set_log_axis(vtkAxis* axis, double low, double high, const Canvas& canvas);

/// Fixes an axis to [low, high] with no ticks at all.
void set_bare_axis(vtkAxis* axis, double low, double high, const Canvas& canvas);

}  // namespace pendular::viz
