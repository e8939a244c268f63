#pragma once

#include <string>
#include <utility>
#include <vector>

#include "viz/figure.h"

namespace pendular::test {

/// A figure as SVG text.
std::string svg_of(const viz::Figure& figure);

using SvgPoints = std::vector<std::pair<double, double>>;  ///< pixels from the upper left corner

/// A filled area; `colour` as "31,90,165".
struct SvgArea {
  std::string colour;
  double opacity;
  SvgPoints points;

  double width() const;
  double height() const;
  double area() const;
  double left() const;
};
std::vector<SvgArea> areas(const std::string& svg);

/// Areas of one colour.
std::vector<SvgArea> areas(const std::string& svg, const std::string& colour);

/// Lines of one colour; each as drawn in one go.
std::vector<SvgPoints> lines(const std::string& svg, const std::string& colour);

/// Places of the markers of one colour.
SvgPoints markers(const std::string& svg, const std::string& colour);

/// All texts, as a reader sees them, and where they stand.
struct SvgWords {
  std::string text, anchor;
  double x, y, size;
  bool bold;
};
std::vector<SvgWords> words(const std::string& svg);

}  // namespace pendular::test
