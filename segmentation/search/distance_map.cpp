#include "segmentation/search/distance_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/lanes.h"
#include "segmentation/search/erosion.h"

namespace pendular::segmentation {
namespace {

using Square = std::int32_t;

// Along each axis; three of its squares are less than kNowhere, and two beside that are a number yet.
constexpr Square kFarthest = 10000;
constexpr Square kNowhere = 1 << 29;  // the square where no surface is that near
constexpr std::size_t kWidth = 16;    // lines side by side
constexpr std::size_t kFar = 30;  // rows that one looks at in the mean; from there on envelopes are faster

/// Squares of lines side by side, in the compiler's vector.
using Squares = Square __attribute__((vector_size(kWidth * sizeof(Square))));
struct alignas(sizeof(Squares)) SquaresInMemory {
  Squares of;
};

/// Keeps the lesser ones. Signs are told by their bits (base/lanes.h).
inline __attribute__((always_inline)) void set_least(Squares& least, const Squares& other) {
  const Squares more = other - least;
  least += more & (more >> 31);
}

inline __attribute__((always_inline)) Square greatest_of(const Squares& squares) {
  Square greatest = squares[0];
  for (std::size_t lane = 1; lane < kWidth; ++lane) greatest = std::max(greatest, squares[lane]);
  return greatest;
}

/// `to`: of each row of `from` the least, lane by lane, of all rows plus the square of the way there. Ends
/// early, and says so, where rows look far.
struct LeastOnLines {
  static inline __attribute__((always_inline)) void run(const SquaresInMemory* from, SquaresInMemory* to,
                                                        std::size_t count, bool* ended_early) {
    std::size_t looks = 0;
    double before = kNowhere;  // the greatest square of the row before
    for (std::size_t n = 0; n < count; ++n) {
      Squares least = from[n].of;
      const double beyond = std::sqrt(before) + 1.0,
                   reach = std::sqrt(std::min<double>(greatest_of(least), beyond * beyond));
      const auto most = std::min<std::size_t>(static_cast<std::size_t>(reach) + 1, kFarthest);
      const std::size_t down = std::min(most, n), up = std::min(most, count - 1 - n);
      looks += down + up;
      *ended_early = looks > kFar * count && count <= kFarthest;
      if (*ended_early) return;
      for (std::size_t d = 1; d <= down; ++d) set_least(least, from[n - d].of + static_cast<Square>(d * d));
      for (std::size_t d = 1; d <= up; ++d) set_least(least, from[n + d].of + static_cast<Square>(d * d));
      to[n].of = least;
      before = greatest_of(least);
    }
  }
};

/// The same for one line of at most kFarthest nodes, in time that grows with its length alone: the lower
/// envelope of a parabola per node (Meijster et al. 2000).
class Envelope {
 public:
  void run(const SquaresInMemory* from, SquaresInMemory* to, std::size_t count, std::size_t lane) {
    const auto square = [&](std::int64_t n) -> std::int64_t { return from[n].of[lane]; };
    const auto value = [&](std::int64_t at, std::int64_t node) {
      return (at - node) * (at - node) + square(node);
    };
    pieces_.clear();
    const auto size = static_cast<std::int64_t>(count);
    for (std::int64_t n = 0; n < size; ++n) {
      if (square(n) >= kNowhere) continue;
      while (!pieces_.empty() &&
             value(pieces_.back().first, pieces_.back().node) > value(pieces_.back().first, n))
        pieces_.pop_back();
      if (pieces_.empty()) {
        pieces_.push_back({n, 0});
        continue;
      }
      const std::int64_t last = pieces_.back().node;
      const std::int64_t first = 1 + (n * n - last * last + square(n) - square(last)) / (2 * (n - last));
      if (first < size) pieces_.push_back({n, first});
    }
    for (std::int64_t n = size - 1; n >= 0; --n) {
      to[n].of[lane] = pieces_.empty() ? kNowhere : static_cast<Square>(value(n, pieces_.back().node));
      if (!pieces_.empty() && n == pieces_.back().first) pieces_.pop_back();
    }
  }

 private:
  /// A node whose parabola is the least one from `first` on, as far as the next piece.
  struct Piece {
    std::int64_t node, first;
  };
  std::vector<Piece> pieces_;
};

/// The same for `width` lines whose nodes are `stride` apart, in place.
void least_on_lines(Square* first, std::size_t width, std::size_t count, std::size_t stride,
                    std::vector<SquaresInMemory>& from, std::vector<SquaresInMemory>& to) {
  from.resize(count), to.resize(count);
  Envelope envelope;
  for (std::size_t i = 0; i < width; i += kWidth) {
    const std::size_t lanes = std::min(kWidth, width - i);
    for (std::size_t n = 0; n < count; ++n) {
      const Square* const row = first + n * stride + i;
      auto* const out = reinterpret_cast<Square*>(&from[n]);
      std::fill(std::copy_n(row, lanes, out), out + kWidth, 0);
    }
    bool ended_early = false;
    run_widest<LeastOnLines>(static_cast<const SquaresInMemory*>(from.data()), to.data(), count,
                             &ended_early);
    if (ended_early)
      for (std::size_t lane = 0; lane < lanes; ++lane) envelope.run(from.data(), to.data(), count, lane);
    for (std::size_t n = 0; n < count; ++n)
      std::copy_n(reinterpret_cast<const Square*>(&to[n]), lanes, first + n * stride + i);
  }
}

/// Squares of the distances to the nearest node of a row that is in the mask and not in its core.
void squares_on_row(const std::uint8_t* mask, const std::uint8_t* core, std::size_t count, Square* squares) {
  const auto size = static_cast<std::ptrdiff_t>(count);
  const auto scan = [&](std::ptrdiff_t first, std::ptrdiff_t step, const auto& take) {
    Square way = -1;  // from the last such node; negative: none near
    for (std::ptrdiff_t n = first; n >= 0 && n < size; n += step) {
      way = mask[n] && !core[n] ? 0 : way < 0 || way == kFarthest ? -1 : way + 1;
      take(squares[n], way < 0 ? kNowhere : way * way);
    }
  };
  scan(0, 1, [](Square& to, Square found) { to = found; });
  scan(size - 1, -1, [](Square& to, Square found) { to = std::min(to, found); });
}

}  // namespace

Grid<float> distance_inside(const Grid<std::uint8_t>& mask) {
  Grid<std::uint8_t> core = mask;
  erode(core, 1);
  const auto [nx, ny, nz] = mask.size;
  std::vector<Square> squares(mask.values.size());
  std::vector<SquaresInMemory> from, to;
  for (std::size_t k = 0; k < nz; ++k) {
    for (std::size_t j = 0; j < ny; ++j) {
      const std::size_t row = mask.index(0, j, k);
      squares_on_row(&mask.values[row], &core.values[row], nx, &squares[row]);
    }
    least_on_lines(&squares[mask.index(0, 0, k)], nx, ny, nx, from, to);
  }
  for (std::size_t j = 0; j < ny; ++j)
    least_on_lines(&squares[mask.index(0, j, 0)], nx, nz, nx * ny, from, to);
  Grid<float> distance{mask.size, mask.factor, std::vector<float>(squares.size())};
  for (std::size_t n = 0; n < squares.size(); ++n)
    distance.values[n] = !mask.values[n]          ? 0.0F
                         : squares[n] >= kNowhere ? std::numeric_limits<float>::max()
                                                  : std::sqrt(static_cast<float>(squares[n])) + 0.5F;
  return distance;
}

}  // namespace pendular::segmentation
