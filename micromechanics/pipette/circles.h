#pragma once

#include <array>
#include <optional>
#include <vector>

#include "pipette/grey_image.h"

namespace pendular::pipette {

/// A bead's outline in pixels.
struct Circle {
  Point centre = Point::Zero();
  double radius = 0.0;
  double radius_sigma = 0.0;  ///< from the scatter of the edge points
  double scatter = 0.0;       ///< of the edge points about the circle, sd
  std::vector<Point> edge;    ///< those it rests on
};

/// The circle through points: least sum of squared algebraic distances (Kåsa 1976), then of squared distances
/// by Gauss–Newton; points further off than three times the scatter are left out. At least 12 points; none
/// where they lie on no circle.
std::optional<Circle> fit_circle(const std::vector<Point>& points);

/// The outline of a bead near a first guess: along 180 radii the steepest grey step between 0.65 and 1.35 of
/// the guessed radius, to sub-pixel; radii within 50° of `neighbour` are left out. None where no circle fits
/// half of the edge points within a twentieth of its radius.
std::optional<Circle> find_outline(const GreyImage& image, const Point& centre, double radius,
                                   const Point& neighbour);

/// Two beads that touch nearly, with radii within a quarter of `radius`, by Hough's transform; the left (or
/// upper) first. None where there are not two.
std::optional<std::array<Circle, 2>> find_two_beads(const GreyImage& image, double radius);

/// Where the outline of the bridge crosses the plane half way between two beads.
struct Neck {
  Point a = Point::Zero(), b = Point::Zero();
  double diameter = 0.0, sigma = 0.0;  ///< pixels; sigma from three lines a pixel apart
};

/// None where either side shows no edge.
std::optional<Neck> find_neck(const GreyImage& image, const Circle& bead, const Circle& other);

}  // namespace pendular::pipette
