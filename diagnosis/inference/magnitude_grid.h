#pragma once

#include <array>
#include <cstddef>
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
double beside_unknown(const ReducedSpace& space, const ReducedGap& gap, const Predictions& predictions,
                      std::size_t lane, double chi_squared);

/// One effect, or two together, over a grid of magnitudes. What each says is worked out once and compared
/// with many gaps; cells are cut finer about the peak, since a field may say a magnitude far better than a
/// grid over its range has cells. Keeps a reference to the space.
class MagnitudeGrid {
 public:
  /// `reduced`: one signature, or two; `together`: of two that were run together, reduced, in their order.
  MagnitudeGrid(std::vector<Signature> reduced, std::optional<Together> together, const ReducedSpace& space);

  struct Fitted;
  /// How the cells of the grid fit each gap, before any is cut. Once: what only this needs is given back,
  /// since it is large.
  std::vector<std::vector<Fitted>> fit(const std::vector<ReducedGap>& gaps);

  /// The logarithm of the evidence that fits come to.
  static double evidence_of(const std::vector<Fitted>& fitted);

  /// Goes on from the fits to a gap. Cells are cut finer only where their evidence comes to this logarithm.
  /// `beside`: also beside something unknown.
  Weighed weigh(const ReducedGap& gap, std::vector<Fitted> fitted, double least, bool beside) const;

 private:
  static constexpr std::size_t kScales = 5;  // of the standard deviations of a response's own covariance
  /// Some magnitudes of an effect, for which the one in the middle stands.
  struct Cell {
    double theta = 0.0, width = 0.0;
  };
  /// A cell of each effect.
  struct Place {
    std::vector<Cell> cells;
    double log_prior = 0.0;
  };
  /// As many places as lanes, or fewer, and what they say.
  struct Batch {
    std::vector<Place> places;
    std::vector<Predictions> predictions;  // one per scale
  };

  static std::vector<std::vector<Cell>> parts_of(const std::vector<Cell>& cells, int parts);
  std::vector<Batch> batches_at(const std::vector<std::vector<Cell>>& all) const;
  void fit(const Batch& batch, const ReducedGap& gap, std::vector<Fitted>& to) const;
  Expected expected(const std::vector<Cell>& cells) const;
  Magnitude magnitude(std::size_t effect, const std::vector<Fitted>& fitted, double log_evidence) const;

  std::vector<Signature> reduced_;
  std::optional<Together> together_;
  const ReducedSpace& space_;
  std::vector<Batch> batches_;
};

/// A place of the grid and how it fits a gap, at each scale and over all.
struct MagnitudeGrid::Fitted {
  const Batch* batch;
  std::size_t lane;
  double log_likelihood = 0.0;
  std::array<double, kScales> chi_squareds = {};

  const Place& place() const { return batch->places[lane]; }
  double log_weight() const { return place().log_prior + log_likelihood; }
  double log_density() const;
};

}  // namespace pendular::diagnosis
