#include "segmentation/fit/shell_equations.h"

#include <utility>

#include "segmentation/fit/ball_profile.h"

namespace pendular::segmentation {
namespace {

constexpr std::size_t kRow = 8;  // slopes with respect to the seven parameters, and what is left
constexpr std::size_t kSums = kRow * (kRow + 1) / 2;

/// What is the same for all voxels of a shell.
struct Model {
  const GreyBall& ball;
  const BallParameters& q;
  const NormalTable& normal = normal_table();
};

using LaneIndices = int __attribute__((vector_size(kLanes * sizeof(int))));

/// Φ and φ, by linear interpolation in the table.
inline __attribute__((always_inline)) void set_normal(const NormalTable& table, const Lanes& t,
                                                      Lanes& cumulative, Lanes& density) {
  constexpr double end = 2.0 * NormalTable::kReach * NormalTable::kPerUnit;
  Lanes place = end - (t + NormalTable::kReach) * NormalTable::kPerUnit;
  set_positive_part(place);
  place = end - place;
  set_positive_part(place);
  const LaneIndices node = __builtin_convertvector(place, LaneIndices);
  const Lanes share = place - __builtin_convertvector(node, Lanes);
  Lanes step, rise;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const auto* const at = table.at(static_cast<std::size_t>(node[lane]));
    cumulative[lane] = at[0].cumulative, step[lane] = at[1].cumulative;
    density[lane] = at[0].density, rise[lane] = at[1].density;
  }
  cumulative += share * (step - cumulative);
  density += share * (rise - density);
}

/// A grey level that has a slope.
inline __attribute__((always_inline)) void set_level(const Lanes& x, const Lanes& y, const Lanes& z,
                                                     double at_centre, const Vec3& slope, Lanes& level) {
  level = at_centre + (x * slope.x() + y * slope.y() + z * slope.z());
}

/// Slopes with respect to the parameters, and what is left of the grey values.
inline __attribute__((always_inline)) void set_rows(const Model& model, const ShellVoxels::Block& block,
                                                    Lanes* row) {
  const GreyBall& ball = model.ball;
  const BallParameters& q = model.q;
  Lanes x, y, z, grey, r, cumulative, density;
  load(block.x, x), load(block.y, y), load(block.z, z), load(block.grey, grey);
  const Lanes dx = x - q[0], dy = y - q[1], dz = z - q[2];
  set_root(dx * dx + dy * dy + dz * dz, r);
  const Lanes t = (q[3] - r) * (1.0 / q[6]);
  set_normal(model.normal, t, cumulative, density);
  BallProfileOf<Lanes> profile;
  set_profile(r, q[6], t, cumulative, density, profile);
  Lanes contrast, background;
  set_level(x, y, z, q[4], ball.contrast_slope, contrast);
  set_level(x, y, z, q[5], ball.background_slope, background);
  const Lanes pull = -contrast * profile.by_distance / r;
  row[0] = pull * dx, row[1] = pull * dy, row[2] = pull * dz;
  row[3] = contrast * profile.by_radius;
  row[4] = profile.value;
  row[5] = Lanes{} + 1.0;
  row[6] = contrast * profile.by_blur;
  row[7] = grey - background - contrast * profile.value;
}

constexpr std::size_t row_of(std::size_t sum) {
  std::size_t row = 0;
  while ((row + 1) * (row + 2) / 2 <= sum) ++row;
  return row;
}
constexpr std::size_t column_of(std::size_t sum) {
  return sum - row_of(sum) * (row_of(sum) + 1) / 2;
}
/// Written out, since the compiler does not unroll a triangle.
template <std::size_t... kSum>
inline __attribute__((always_inline)) void add_products(const Lanes* row, Lanes* sum,
                                                        std::index_sequence<kSum...>) {
  ((sum[kSum] += row[row_of(kSum)] * row[column_of(kSum)]), ...);
}

/// The lower triangle of the sum of products of each row with each.
struct SetProducts {
  static inline __attribute__((always_inline)) void run(const Model* model, const ShellVoxels* voxels,
                                                        LaneNumbers* sums) {
    Lanes sum[kSums]{}, there = Lanes{} + 1.0;  // zero in lanes without a voxel
    for (std::size_t n = 0; n < voxels->size(); n += kLanes) {
      Lanes row[kRow];
      set_rows(*model, voxels->blocks()[n / kLanes], row);
      if (voxels->size() - n < kLanes)
        for (std::size_t lane = voxels->size() - n; lane < kLanes; ++lane) there[lane] = 0.0;
      for (Lanes& numbers : row) numbers *= there;
      add_products(row, sum, std::make_index_sequence<kSums>());
    }
    for (std::size_t k = 0; k < kSums; ++k) lanes_of(sums[k]) = sum[k];
  }
};

struct SetRests {
  static inline __attribute__((always_inline)) void run(const Model* model, const ShellVoxels* voxels,
                                                        LaneNumbers* rests) {
    for (std::size_t n = 0; n < voxels->size(); n += kLanes) {
      Lanes row[kRow];
      set_rows(*model, voxels->blocks()[n / kLanes], row);
      lanes_of(rests[n / kLanes]) = row[kRow - 1];
    }
  }
};

/// Adds, for each of the columns of weights, the weighted sums of the slopes.
struct AddWeighted {
  static inline __attribute__((always_inline)) void run(const Model* model, const ShellVoxels* voxels,
                                                        const std::vector<VoxelNumbers>* weights,
                                                        LaneNumbers* sums) {
    for (std::size_t n = 0; n < voxels->size(); n += kLanes) {
      Lanes row[kRow];
      set_rows(*model, voxels->blocks()[n / kLanes], row);
      for (std::size_t column = 0, sum = 0; column < weights->size(); ++column)
        for (std::size_t i = 0; i + 1 < kRow; ++i, ++sum)
          lanes_of(sums[sum]) += row[i] * lanes_of((*weights)[column].blocks()[n / kLanes]);
    }
  }
};

double total(const LaneNumbers& lanes) {
  double sum = 0.0;
  for (std::size_t lane = 0; lane < kLanes; ++lane) sum += lanes[lane];
  return sum;
}

}  // namespace

Equations equations(const ShellVoxels& voxels, const GreyBall& ball, const BallParameters& q, bool fit_blur) {
  const Model model{ball, q};
  LaneNumbers sums[kSums];
  run_widest<SetProducts>(&model, &voxels, &sums[0]);
  Eigen::Matrix<double, 8, 8> all;
  for (int i = 0, sum = 0; i < all.rows(); ++i)
    for (int j = 0; j <= i; ++j, ++sum) all(i, j) = all(j, i) = total(sums[sum]);
  Equations result{all.topLeftCorner<7, 7>(), all.col(7).head<7>(), all(7, 7)};
  if (!fit_blur) {
    result.matrix.row(6).setZero(), result.matrix.col(6).setZero();
    result.matrix(6, 6) = 1.0, result.right[6] = 0.0;
  }
  return result;
}

VoxelNumbers rests(const ShellVoxels& voxels, const GreyBall& ball, const BallParameters& q) {
  const Model model{ball, q};
  VoxelNumbers numbers(voxels);
  run_widest<SetRests>(&model, &voxels, numbers.blocks());
  return numbers;
}

std::vector<BallParameters> weighted_slopes(const ShellVoxels& voxels, const GreyBall& ball,
                                            const BallParameters& q,
                                            const std::vector<VoxelNumbers>& weights) {
  const Model model{ball, q};
  std::vector<LaneNumbers> sums((kRow - 1) * weights.size());
  run_widest<AddWeighted>(&model, &voxels, &weights, sums.data());
  std::vector<BallParameters> result(weights.size());
  for (std::size_t n = 0; n < sums.size(); ++n)
    result[n / (kRow - 1)][static_cast<Eigen::Index>(n % (kRow - 1))] = total(sums[n]);
  return result;
}

}  // namespace pendular::segmentation
