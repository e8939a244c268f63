#pragma once

#include <functional>
#include <vector>

#include "pipette/grey_image.h"

namespace pendular::pipette {

/// What is followed: the pixels of a region of the first frame, with all that stays the same for every frame.
struct Template {
  Region box;                           ///< around the pixels
  std::vector<Eigen::Vector2i> pixels;  ///< those inside the mask
  std::vector<double> values;           ///< zero mean, unit norm
  std::vector<Point> gradients;         ///< of the grey values, per pixel
  Eigen::Matrix2d inverse_hessian;
  double norm = 0.0;      ///< of the grey values about their mean
  GreyImage patch, mask;  ///< the box, for the search at whole pixels
};

/// A template of those pixels of `box` that `wanted` (all where empty). `box` lies within the image. A region
/// without enough contrast in both directions to be followed has a norm of zero.
Template make_template(const GreyImage& image, const Region& box,
                       const std::function<bool(const Point&)>& wanted = {});

/// Where a template was found.
struct Match {
  Point displacement = Point::Zero();  ///< since the template's frame, pixels
  double score = 0.0;                  ///< zero-mean normalised cross-correlation, 1: the same picture
  bool found = false;                  ///< false where the search ran out of the image or did not converge
};

/// Finds a template near a guessed displacement: the best whole pixel within `reach` by normalised
/// cross-correlation, then Gauss–Newton steps on the zero-mean normalised squared difference, inverse
/// compositional (Baker & Matthews 2004, IJCV 56, 221; Pan, Li & Tong 2013, Exp. Mech. 53, 1277), between the
/// first frame's grey values and the cubic spline of this frame, in double precision. Both are smoothed
/// first, because noise in the template's gradients would otherwise add its own error. Gain and offset of the
/// light do not matter. The template stays that of the first frame, so errors do not add up.
Match match(const Template& wanted, const GreyImage& image, const Point& guess, int reach);

}  // namespace pendular::pipette
