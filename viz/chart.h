#pragma once

// What the plots of the viz folder are made of. Internal.

#include <string>
#include <utility>
#include <vector>

#include "viz/colours.h"
#include "viz/figure.h"
#include "viz/text_style.h"

namespace pendular::viz {

/// A rectangle in shares of the picture.
struct Area {
  double left, bottom, width, height;
  double middle_x() const { return left + 0.5 * width; }
  double middle_y() const { return bottom + 0.5 * height; }
};

/// An axis from `low` to `high` with at most about `ticks` round ticks (0: none), or on a logarithmic one a
/// tick at each whole power of ten.
struct Axis {
  double low, high;
  int ticks = 6;
  bool logarithmic = false;
};

/// How a line is drawn; `width` in pixels.
struct Pen {
  Colour colour;
  double width;
  bool dashed = false;
  double opacity = 1.0;
};

enum class Marker { circle, diamond };

/// A rectangle in the values of the axes.
struct Rectangle {
  double left, bottom, right, top;
};

using Point = std::pair<double, double>;
using Points = std::vector<Point>;
struct Segment {
  Point from, to;
};

/// A scale of colours beside a chart, for boxes that are coloured by their value.
struct ColourBar {
  Area area;
  double low, high;
  std::vector<Colour> colours;  ///< from low to high, evenly spaced
};

/// A text as a string of gnuplot, in which nothing is a command or markup: one line of UTF-8
/// (base/text_line.h).
std::string as_string(const std::string& text);

/// One pair of axes with what is drawn between them, in the order in which it is added; nothing is drawn of
/// what is not finite. A label goes into the legend, in the upper left corner; an empty one stays out of it.
class Chart {
 public:
  Chart(const Area& area, const Axis& x, const Axis& y) : area_(area), x_(x), y_(y) {}

  void add_line(const Points& points, const Pen& pen, const std::string& label = "");
  void add_segments(const std::vector<Segment>& segments, const Pen& pen);
  /// `diameter` in pixels.
  void add_points(const Points& points, Colour colour, double diameter, const std::string& label = "",
                  Marker marker = Marker::circle);
  /// What lies between `low` and `high` over `x`.
  void add_fill(const std::vector<double>& x, const std::vector<double>& low, const std::vector<double>& high,
                Colour colour, double opacity);
  void add_boxes(const std::vector<Rectangle>& boxes, Colour colour, const std::string& label = "");
  /// Each box in the colour of its value; the chart has a colour bar.
  void add_coloured_boxes(const std::vector<Rectangle>& boxes, const std::vector<double>& values);
  /// Words centred at a place in the values of the axes, over all else; `size` in pixels.
  void add_words(const std::string& words, double x, double y, double size, Colour colour);

  void hide_axes() { axes_ = false; }
  void set_colour_bar(const ColourBar& bar) { bar_ = bar; }
  /// Boxes that are added after this stand on this axis instead of the left one.
  void set_right_axis(const Axis& axis) { right_ = axis, has_right_ = true; }

  /// The commands that draw it; `zoom`: pixels per unit of type and ticks.
  std::string script(double zoom) const;

 private:
  void add(const std::string& rows, const std::string& look, const std::string& label);
  std::string axes_script(double zoom) const;
  std::string bar_script(double zoom) const;

  Area area_;
  Axis x_, y_, right_ = {0.0, 1.0};
  bool axes_ = true, has_right_ = false;
  ColourBar bar_ = {};
  std::string words_;
  std::string data_;                  ///< a block for each of the clauses
  std::vector<std::string> clauses_;  ///< of the command that plots
};

/// A white picture that holds charts and words.
class Sheet {
 public:
  /// `zoom`: the picture's pixels per unit of scaled(); 0: its height over 1200.
  explicit Sheet(PictureSize size, double zoom = 0.0);

  /// Pixels of a length that is `length` pixels in a picture 1200 pixels high (of zoom 1).
  double scaled(double length) const { return zoom_ * length; }

  void add(const Chart& chart) { charts_.push_back(chart.script(zoom_)); }

  /// Words centred at a place in shares of the picture; upright ones read upwards.
  void write(const std::string& words, double x, double y);
  void write_upright(const std::string& words, double x, double y);
  /// More than one line: centred about the place.
  void write(const std::string& words, double x, double y, const TextStyle& style);

  /// A swatch.
  void fill(const Area& area, Colour colour);

  Figure figure() const;

 private:
  PictureSize size_;
  double zoom_;
  std::string words_;
  std::vector<std::string> charts_;
};

}  // namespace pendular::viz
