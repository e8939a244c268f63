#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "base/lanes.h"

namespace pendular::segmentation {

/// A voxel of a shell: its place relative to the ball's first centre, and its grey value.
struct ShellVoxel {
  float x, y, z, grey;
};

/// Voxels of a shell, in blocks of which each column fills a register.
class ShellVoxels {
 public:
  struct alignas(64) Block {
    std::array<float, kLanes> x, y, z, grey;
  };

  std::size_t size() const { return size_; }
  /// All of them; of the last one only the first size() % kLanes voxels are there.
  const Block* blocks() const { return blocks_.data(); }

  ShellVoxel operator[](std::size_t n) const {
    const Block& block = blocks_[n / kLanes];
    const std::size_t lane = n % kLanes;
    return {block.x[lane], block.y[lane], block.z[lane], block.grey[lane]};
  }
  void push_back(const ShellVoxel& voxel) {
    if (size_ % kLanes == 0) blocks_.push_back(kNothing);
    set(size_++, voxel);
  }
  void clear() { blocks_.clear(), size_ = 0; }

  /// Keeps the voxels n for which keep(n), in their order; returns how many it does not.
  template <typename Keep>
  std::size_t keep_if(const Keep& keep) {
    std::size_t kept = 0;
    for (std::size_t n = 0; n < size_; ++n)
      if (keep(n)) set(kept++, (*this)[n]);
    const std::size_t dropped = size_ - kept;
    size_ = kept;
    blocks_.resize((kept + kLanes - 1) / kLanes);
    return dropped;
  }

 private:
  /// What is computed in lanes without a voxel is finite: they are far from the centre.
  static constexpr Block kNothing = [] {
    Block block{};
    block.x.fill(1e6F);
    return block;
  }();

  void set(std::size_t n, const ShellVoxel& voxel) {
    Block& block = blocks_[n / kLanes];
    const std::size_t lane = n % kLanes;
    block.x[lane] = voxel.x, block.y[lane] = voxel.y, block.z[lane] = voxel.z, block.grey[lane] = voxel.grey;
  }

  std::vector<Block> blocks_;
  std::size_t size_ = 0;
};

/// A number of each voxel, zero at first.
class VoxelNumbers {
 public:
  explicit VoxelNumbers(const ShellVoxels& voxels) : blocks_((voxels.size() + kLanes - 1) / kLanes) {}

  double& operator[](std::size_t n) { return blocks_[n / kLanes][n % kLanes]; }
  LaneNumbers* blocks() { return blocks_.data(); }
  const LaneNumbers* blocks() const { return blocks_.data(); }

 private:
  std::vector<LaneNumbers> blocks_;
};

/// A column of a block in double precision.
inline __attribute__((always_inline)) void load(const std::array<float, kLanes>& column, Lanes& numbers) {
  for (std::size_t lane = 0; lane < kLanes; ++lane) numbers[lane] = static_cast<double>(column[lane]);
}

}  // namespace pendular::segmentation
