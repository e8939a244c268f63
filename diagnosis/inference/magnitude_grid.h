#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "diagnosis/inference/evidence.h"
#include "diagnosis/inference/reduced_space.h"

namespace pendular::diagnosis {

/// An explanation, and what it would come to beside something unknown.
struct Weighed {
  Hypothesis hypothesis;
  double beside_unknown = 0.0;  ///< logarithm of the evidence with wider noise
};

/// Mean over the widths of the noise within the span and outside it, of which at least one is larger: what is
/// unknown may look like the known, or like nothing that is known. Logarithm.
double beside_unknown(const ReducedSpace& space, const ReducedGap& gap, const Prediction& prediction,
                      double chi_squared);

/// One effect, or two together, over a grid of magnitudes. What each says is worked out once and compared
/// with any gap; cells are cut finer about the peak, since a field may say a magnitude far better than a grid
/// over its range has cells. Keeps a reference to the space.
class MagnitudeGrid {
 public:
  /// `reduced`: one signature, or two; `together`: of two that were run together, reduced, in their order.
  MagnitudeGrid(std::vector<Signature> reduced, std::optional<Together> together, const ReducedSpace& space);

  /// Cells are cut finer only where those that are not cut come to this logarithm of evidence.
  Weighed weigh(const ReducedGap& gap, double least = -std::numeric_limits<double>::infinity()) const;

  /// The logarithm of evidence before any cell is cut.
  double coarse_evidence(const ReducedGap& gap) const;

 private:
  /// Some magnitudes of an effect, for which the one in the middle stands.
  struct Cell {
    double theta = 0.0, width = 0.0;
  };
  /// A cell of each effect, and what it says.
  struct Place {
    std::vector<Cell> cells;
    double log_prior = 0.0;
    std::vector<Prediction> predictions;  // one per scale of the response's own covariance
  };
  struct Fitted;

  static std::vector<std::vector<Cell>> parts_of(const std::vector<Cell>& cells, int parts);
  std::vector<Place> places_at(const std::vector<std::vector<Cell>>& all) const;
  static double evidence_of(const std::vector<Fitted>& fitted);
  Fitted fit(const Place& place, const ReducedGap& gap) const;
  std::vector<Prediction> predict(const std::vector<Cell>& cells) const;
  Magnitude magnitude(std::size_t effect, const std::vector<Fitted>& fitted, double log_evidence) const;

  std::vector<Signature> reduced_;
  std::optional<Together> together_;
  const ReducedSpace& space_;
  std::vector<Place> places_;
};

}  // namespace pendular::diagnosis
