#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <optional>
#include <span>
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
/// grid over its range has cells. Keeps references to the space and to what was run at the fit.
class MagnitudeGrid {
 public:
  /// `reduced`: one signature, or two; `together`: of two that were run together, reduced, in their order;
  /// `at_fit`: of the explanation, reduced; may be null.
  MagnitudeGrid(std::vector<Signature> reduced, std::optional<Together> together, const AtFit* at_fit,
                const ReducedSpace& space);

  struct Fitted;
  /// How the cells of the grid fit each gap, before any is cut. Valid as long as the grid.
  std::vector<std::vector<Fitted>> fit(std::span<const ReducedGap> gaps);

  /// The logarithm of the evidence that fits come to.
  static double evidence_of(const std::vector<Fitted>& fitted);

  /// Goes on from the fits to a gap. Cells are cut finer only where their evidence comes to this logarithm.
  /// `beside`: also beside something unknown.
  Weighed weigh(const ReducedGap& gap, std::vector<Fitted> fitted, double least, bool beside) const;

 private:
  static constexpr std::size_t kScales = 5;  // of the standard deviations of a response's own covariance
  /// Some magnitudes of an effect, for which the one in the middle stands, and which of its readings acts.
  struct Cell {
    double theta = 0.0, width = 0.0;
    std::size_t reading = 0;
  };
  /// Of each effect; of one effect, the first.
  using Cells = std::array<Cell, 2>;
  struct Place {
    Cells cells;
    double log_prior = 0.0;
  };
  /// As many places as lanes, or fewer, and what they say.
  struct Batch {
    std::vector<Place> places;
    std::vector<Predictions> predictions;  // one per scale
  };
  using Batches = std::deque<Batch>;  // what fits point into

  std::vector<Cells> whole_ranges() const;
  std::vector<Cells> parts_of(const Cells& cells, int parts) const;
  /// Fits of cells to each gap, added to those that there are.
  void fit(const std::vector<Cells>& all, std::span<const ReducedGap> gaps, Batches& batches,
           std::span<std::vector<Fitted>> to) const;
  static Fitted fitted_of(const Batch& batch, std::size_t lane, const std::array<Fits, kScales>& fits);
  Expected expected_of(std::size_t effect, const Cell& cell) const;
  Expected together(const Expected& a, const Expected& b, const Cells& cells) const;
  Magnitude magnitude(std::size_t effect, const std::vector<Fitted>& fitted, double log_evidence) const;

  std::vector<Signature> reduced_;
  std::optional<Together> together_;
  const AtFit* at_fit_;
  const ReducedSpace& space_;
  Batches batches_;
};

/// A place of the grid and how it fits a gap, at each scale and over all.
struct MagnitudeGrid::Fitted {
  const Batch* batch;
  std::size_t lane;
  double log_likelihood = 0.0;
  std::array<double, kScales> chi_squareds = {};

  const Place& place() const { return batch->places[lane]; }
  double log_weight() const { return place().log_prior + log_likelihood; }
  double log_density(std::size_t effects) const;
};

}  // namespace pendular::diagnosis
