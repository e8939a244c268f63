#include "viz/chart.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <sstream>
#include <string_view>

#include "base/text_line.h"
#include "viz/ticks.h"

namespace pendular::viz {
namespace {

constexpr Colour kInk{13, 13, 13};
constexpr double kTickType = 34.0, kLegendType = 30.0, kBarType = 26.0, kWordType = 36.0, kTick = 0.56,
                 kAxisWidth = 2.5;

std::string rgb(Colour c, double opacity = 1.0) {
  const auto clear = static_cast<int>(std::lround(255.0 * (1.0 - opacity)));
  return clear == 0 ? fmt::format("rgb '#{:02x}{:02x}{:02x}'", c.r, c.g, c.b)
                    : fmt::format("rgb '#{:02x}{:02x}{:02x}{:02x}'", clear, c.r, c.g, c.b);
}

std::string font(double size, bool bold = false) {
  return fmt::format("font 'Arial{},{:.4g}'", bold ? ":Bold" : "", size);
}

std::string look_of(const Pen& pen) {
  return fmt::format("using 1:2 with lines linewidth {:.4g} linecolor {} dashtype {}", pen.width,
                     rgb(pen.colour, pen.opacity), pen.dashed ? "(8,8)" : "solid");
}

/// A line of a data block; empty where one of the numbers is not finite.
std::string row(std::initializer_list<double> numbers) {
  if (!std::all_of(numbers.begin(), numbers.end(), [](double v) { return std::isfinite(v); })) return "";
  std::string line;
  for (const double v : numbers) line += fmt::format("{:.17g} ", v);
  line.back() = '\n';
  return line;
}

std::string tick(double place, std::string label) {
  if (label.starts_with('-')) label.replace(0, 1, "\u2212");
  return fmt::format("{} {:.17g}", as_string(label), place);
}

std::vector<std::string> ticks_of(const Axis& axis) {
  std::vector<std::string> ticks;
  if (axis.ticks == 0) return ticks;
  if (!axis.logarithmic) {
    const Ticks round = round_ticks(axis.low, axis.high, axis.ticks);
    for (std::size_t k = 0; k < round.values.size(); ++k)
      ticks.push_back(tick(round.values[k], round.labels[k]));
    return ticks;
  }
  const auto first = static_cast<int>(std::ceil(std::log10(axis.low) - 1e-9)),
             last = static_cast<int>(std::floor(std::log10(axis.high) + 1e-9));
  for (int power = first; power <= last; ++power)
    ticks.push_back(tick(std::pow(10.0, power), fmt::format("{:g}", std::pow(10.0, power))));
  return ticks;
}

/// `name`: x, y, y2, cb.
std::string axis_script(const std::string& name, const Axis& axis, double zoom, double type = kTickType) {
  std::string script = fmt::format("set {}range [{:.17g}:{:.17g}]\n", name, axis.low, axis.high);
  if (axis.logarithmic) script += fmt::format("set logscale {}\n", name);
  const auto ticks = ticks_of(axis);
  if (ticks.empty()) return script + fmt::format("unset {}tics\n", name);
  return script + fmt::format("set {}tics out nomirror scale {:.4g} {} textcolor {} ({})\n", name,
                              kTick * zoom, font(type * zoom), rgb(kInk), fmt::join(ticks, ", "));
}

}  // namespace

std::string as_string(const std::string& text) {
  // In double quotes, all but these by their octal number: gnuplot looks for commands (`), macros (@) and
  // ends of strings, and of single quotes that are doubled it understands not all. It reads a number to its
  // last digit, so that a digit after a number is one too.
  constexpr std::string_view kPlain = " .,:;()/+-_=%<>";
  std::string out = "\"";
  bool after_number = false;
  for (const char c : printable(text)) {
    const auto byte = static_cast<unsigned char>(c);
    const bool plain = std::isdigit(byte) != 0 ? !after_number
                                               : byte >= 128 || std::isalpha(byte) != 0 ||
                                                     kPlain.find(c) != std::string_view::npos;
    out += plain ? std::string(1, c) : fmt::format("\\{:03o}", byte);
    after_number = !plain;
  }
  return out + "\"";
}

void Chart::add(const std::string& rows, const std::string& look, const std::string& label) {
  if (rows.empty()) return;
  const std::string name = fmt::format("$data{}", clauses_.size());
  data_ += fmt::format("{} << END\n{}END\n", name, rows);
  clauses_.push_back(
      fmt::format("{} {} {}", name, look, label.empty() ? "notitle" : "title " + as_string(label)));
}

void Chart::add_line(const Points& points, const Pen& pen, const std::string& label) {
  std::string rows;
  for (const auto& [x, y] : points) rows += row({x, y});
  add(rows, look_of(pen), label);
}

void Chart::add_segments(const std::vector<Segment>& segments, const Pen& pen) {
  std::string rows;
  for (const auto& [from, to] : segments) {
    const std::string first = row({from.first, from.second}), last = row({to.first, to.second});
    if (!first.empty() && !last.empty()) rows += first + last + '\n';
  }
  add(rows, look_of(pen), "");
}

void Chart::add_points(const Points& points, Colour colour, double diameter, const std::string& label,
                       Marker marker) {
  std::string rows;
  for (const auto& [x, y] : points) rows += row({x, y});
  add(rows,
      fmt::format("using 1:2 with points linewidth 1 pointtype {} pointsize {:.4g}*point linecolor {}",
                  marker == Marker::circle ? 7 : 13, 0.5 * diameter, rgb(colour)),
      label);
}

void Chart::add_fill(const std::vector<double>& x, const std::vector<double>& low,
                     const std::vector<double>& high, Colour colour, double opacity) {
  std::string rows;
  for (std::size_t k = 0; k < x.size(); ++k) rows += row({x[k], low[k], high[k]});
  add(rows,
      fmt::format("using 1:2:3 with filledcurves fillcolor {} fillstyle transparent solid {:.3g} noborder",
                  rgb(colour), opacity),
      "");
}

void Chart::add_boxes(const std::vector<Rectangle>& boxes, Colour colour, const std::string& label) {
  std::string rows;
  for (const Rectangle& b : boxes)
    rows += row({0.5 * (b.left + b.right), 0.5 * (b.bottom + b.top), b.left, b.right, b.bottom, b.top});
  add(rows,
      fmt::format("using 1:2:3:4:5:6 {}with boxxyerror fillcolor {} fillstyle solid noborder",
                  has_right_ ? "axes x1y2 " : "", rgb(colour)),
      label);
}

void Chart::add_coloured_boxes(const std::vector<Rectangle>& boxes, const std::vector<double>& values) {
  std::string rows;
  for (std::size_t k = 0; k < boxes.size(); ++k) {
    const Rectangle& b = boxes[k];
    rows += row(
        {0.5 * (b.left + b.right), 0.5 * (b.bottom + b.top), b.left, b.right, b.bottom, b.top, values[k]});
  }
  add(rows, "using 1:2:3:4:5:6:7 with boxxyerror fillcolor palette fillstyle solid noborder", "");
}

void Chart::add_words(const std::string& words, double x, double y, double size, Colour colour) {
  words_ += fmt::format("set label {} at first {:.17g},first {:.17g} center front {} textcolor {}\n",
                        as_string(words), x, y, font(size), rgb(colour));
}

std::string Chart::axes_script(double zoom) const {
  std::string script = fmt::format("set lmargin at screen {:.17g}\nset rmargin at screen {:.17g}\n",
                                   area_.left, area_.left + area_.width) +
                       fmt::format("set bmargin at screen {:.17g}\nset tmargin at screen {:.17g}\n",
                                   area_.bottom, area_.bottom + area_.height);
  script += axis_script("x", x_, zoom) + axis_script("y", y_, zoom);
  if (has_right_) script += axis_script("y2", right_, zoom);
  return script + fmt::format("set border {} linewidth {:.4g} linecolor {}\n",
                              !axes_       ? 0
                              : has_right_ ? 1 + 2 + 8
                                           : 1 + 2,
                              kAxisWidth * zoom, rgb(kInk));
}

std::string Chart::bar_script(double zoom) const {
  if (bar_.colours.empty()) return "unset colorbox\n";
  std::vector<std::string> stations;
  for (std::size_t k = 0; k < bar_.colours.size(); ++k) {
    const Colour& c = bar_.colours[k];
    stations.push_back(fmt::format("{} '#{:02x}{:02x}{:02x}'", k, c.r, c.g, c.b));
  }
  return fmt::format("set palette defined ({})\n", fmt::join(stations, ", ")) +
         axis_script("cb", {bar_.low, bar_.high, 5}, zoom, kBarType) +
         fmt::format(
             "set colorbox vertical user origin screen {:.17g},screen {:.17g} size screen {:.17g},screen "
             "{:.17g} border\n",
             bar_.area.left, bar_.area.bottom, bar_.area.width, bar_.area.height);
}

std::string Chart::script(double zoom) const {
  const std::string key = fmt::format("set key inside left top Left reverse samplen 2 spacing 1.1 {}\n",
                                      font(kLegendType * zoom));
  // An empty chart has axes all the same.
  const std::string plot = clauses_.empty() ? "NaN notitle" : fmt::format("{}", fmt::join(clauses_, ", "));
  return axes_script(zoom) + bar_script(zoom) + key + words_ + data_ + "plot " + plot + '\n';
}

Sheet::Sheet(PictureSize size, double zoom) : size_(size), zoom_(zoom > 0.0 ? zoom : size.height / 1200.0) {}

void Sheet::write(const std::string& words, double x, double y) {
  write(words, x, y, {.size = kWordType, .align = Align::centre});
}

void Sheet::write_upright(const std::string& words, double x, double y) {
  write(words, x, y, {.size = kWordType, .align = Align::centre, .angle = 90});
}

void Sheet::write(const std::string& words, double x, double y, const TextStyle& style) {
  constexpr double kLine = 1.25;  // of the size of type
  const char* align = style.align == Align::left ? "left" : style.align == Align::centre ? "center" : "right";
  const double size = scaled(style.size), line = kLine * size / size_.height;
  const auto more = static_cast<double>(std::count(words.begin(), words.end(), '\n'));
  std::istringstream lines(words);
  double place = y + 0.5 * more * line;
  for (std::string text; std::getline(lines, text); place -= line)
    words_ += fmt::format("set label {} at screen {:.17g},screen {:.17g} {} rotate by {:g} {} textcolor {}\n",
                          as_string(text), x, place, align, style.angle, font(size, style.bold),
                          rgb(style.white ? Colour{255, 255, 255} : kInk));
}

void Sheet::fill(const Area& area, Colour colour) {
  words_ += fmt::format(
      "set object rectangle from screen {:.17g},screen {:.17g} to screen {:.17g},screen {:.17g} fillcolor {} "
      "fillstyle solid noborder\n",
      area.left, area.bottom, area.left + area.width, area.bottom + area.height, rgb(colour));
}

Figure Sheet::figure() const {
  std::string script = "set multiplot\n" + words_;
  for (const std::string& chart : charts_) script += chart + "unset label\nunset object\nunset logscale\n";
  return {size_, script + "unset multiplot\n"};
}

}  // namespace pendular::viz
