#include "dem_core/linear/spring_network.h"

#include <fmt/format.h>
#include <Eigen/Dense>

#include "base/error.h"
#include "base/parallel.h"

namespace pendular::dem_core {
namespace {

using Block = Eigen::Matrix<double, 6, 6>;
constexpr std::size_t kNodeBlock = 512, kDotBlock = 4096;

Vec3 shift(const NodeVector& x, int node) {
  return x.segment<3>(6 * node);
}
Vec3 turn(const NodeVector& x, int node) {
  return x.segment<3>(6 * node + 3);
}

/// k along n and t across it.
Vec3 along_and_across(const Vec3& v, const Vec3& n, double k, double t) {
  return t * v + ((k - t) * v.dot(n)) * n;
}

/// Blocks and the order of their sums do not depend on the number of threads.
double dot(const Eigen::Ref<const NodeVector>& a, const Eigen::Ref<const NodeVector>& b) {
  const std::size_t size = static_cast<std::size_t>(a.size());
  std::vector<double> parts((size + kDotBlock - 1) / kDotBlock);
  for_blocks(size, kDotBlock, [&](std::size_t first, std::size_t last) {
    const auto from = static_cast<Eigen::Index>(first), count = static_cast<Eigen::Index>(last - first);
    parts[first / kDotBlock] = a.segment(from, count).dot(b.segment(from, count));
  });
  double sum = 0.0;
  for (double part : parts) sum += part;
  return sum;
}

}  // namespace

SpringNetwork::SpringNetwork(std::vector<double> radius, std::vector<NetworkSpring> springs)
    : radius_(std::move(radius)), springs_(std::move(springs)), first_end_(radius_.size() + 1, 0) {
  for (const auto& s : springs_) {
    ++first_end_[s.i + 1], ++first_end_[s.j + 1];
    bending_ |= s.bend > 0.0 || s.twist > 0.0;
  }
  for (std::size_t k = 1; k < first_end_.size(); ++k) first_end_[k] += first_end_[k - 1];
  ends_.resize(2 * springs_.size());
  std::vector<int> next(first_end_.begin(), first_end_.end() - 1);
  for (int s = 0; s < static_cast<int>(springs_.size()); ++s) {
    const NetworkSpring& p = springs_[s];
    ends_[next[p.i]++] = {p.j, s, p.n, p.arm_i, p.arm_j, p.normal, p.tangential};
    ends_[next[p.j]++] = {p.i, s, -p.n, p.arm_j, p.arm_i, p.normal, p.tangential};
  }
}

Vec3 SpringNetwork::relative(const NetworkSpring& s, const NodeVector& x) const {
  return shift(x, s.i) - shift(x, s.j) + s.n.cross(s.arm_i * turn(x, s.i) + s.arm_j * turn(x, s.j));
}

void SpringNetwork::multiply(const NodeVector& x, NodeVector& out) const {
  out.resize(x.size());
  // Each node works out the forces of its own springs: twice the arithmetic, but nothing to share or to keep.
  for_blocks(radius_.size(), kNodeBlock, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      const int node = static_cast<int>(k);
      const Vec3 here = shift(x, node), turned = turn(x, node);
      Vec3 force = Vec3::Zero(), torque = Vec3::Zero(), moment = Vec3::Zero();
      for (int e = first_end_[k]; e < first_end_[k + 1]; ++e) {
        const End& end = ends_[e];
        const Vec3 moved =
            here - shift(x, end.other) + end.n.cross(end.arm * turned + end.other_arm * turn(x, end.other));
        force += along_and_across(moved, end.n, end.normal, end.tangential);
        torque -= (end.arm * end.tangential) * end.n.cross(moved);
        if (bending_)
          moment += along_and_across(turned / radius_[k] - turn(x, end.other) / radius_[end.other], end.n,
                                     springs_[end.spring].twist, springs_[end.spring].bend);
      }
      out.segment<3>(6 * node) = force;
      out.segment<3>(6 * node + 3) = torque + moment / radius_[k];
    }
  });
}

NodeVector SpringNetwork::pushes() const {
  NodeVector load = NodeVector::Zero(6 * nodes());
  for (const auto& s : springs_) {
    load.segment<3>(6 * s.i) += s.push * s.n;
    load.segment<3>(6 * s.j) -= s.push * s.n;
  }
  return load;
}

std::vector<Block> SpringNetwork::diagonal_blocks() const {
  std::vector<Block> blocks(radius_.size(), Block::Zero());
  for (const auto& s : springs_) {
    const Eigen::Matrix3d along = s.n * s.n.transpose(), across = Eigen::Matrix3d::Identity() - along;
    const Eigen::Matrix3d stiffness = s.normal * along + s.tangential * across;
    const Eigen::Matrix3d bending = s.twist * along + s.bend * across;
    Eigen::Matrix3d cross_n;  // cross_n v = n × v
    cross_n << 0.0, -s.n.z(), s.n.y(), s.n.z(), 0.0, -s.n.x(), -s.n.y(), s.n.x(), 0.0;
    const auto add = [&](int node, double side, double arm) {
      const Eigen::Matrix3d coupling = side * arm * s.tangential * cross_n;
      Block& block = blocks[node];
      block.topLeftCorner<3, 3>() += stiffness;
      block.topRightCorner<3, 3>() += coupling;
      block.bottomLeftCorner<3, 3>() += coupling.transpose();
      block.bottomRightCorner<3, 3>() +=
          arm * arm * s.tangential * across + bending / (radius_[node] * radius_[node]);
    };
    add(s.i, 1.0, s.arm_i);
    add(s.j, -1.0, s.arm_j);
  }
  return blocks;
}

bool SpringNetwork::spans() const {
  std::vector<char> seen(radius_.size(), 0);
  std::vector<int> waiting = {bottom()};
  seen[bottom()] = 1;
  while (!waiting.empty()) {
    const int node = waiting.back();
    waiting.pop_back();
    for (int e = first_end_[node]; e < first_end_[node + 1]; ++e) {
      const int other = ends_[e].other;
      if (!seen[other]) waiting.push_back(other);
      seen[other] = 1;
    }
  }
  return seen[top()];
}

Solution solve(const SpringNetwork& network, const NodeVector& load, double tolerance, NodeVector& x) {
  const Eigen::Index free = 6 * network.free_nodes();
  auto blocks = network.diagonal_blocks();
  double stiffest = 0.0;
  for (const auto& block : blocks) stiffest = std::max(stiffest, block.diagonal().maxCoeff());
  if (stiffest == 0.0) return {};
  for (auto& block : blocks) {
    // A bead that can spin, or is loose, has a singular block of its own; this touches the preconditioner
    // only.
    block.diagonal().array() += 1e-6 * stiffest;
    block = block.inverse().eval();
  }
  const auto precondition = [&](const NodeVector& r, NodeVector& z) {
    for_blocks(static_cast<std::size_t>(network.free_nodes()), kNodeBlock,
               [&](std::size_t first, std::size_t last) {
                 for (std::size_t k = first; k < last; ++k) {
                   const auto at = 6 * static_cast<Eigen::Index>(k);
                   z.segment<6>(at).noalias() = blocks[k] * r.segment<6>(at);
                 }
               });
  };
  NodeVector product(x.size()), r = NodeVector::Zero(x.size()), z = r, p = r;
  // What the held nodes alone exert is the scale of the residual.
  NodeVector held = x;
  held.head(free).setZero();
  network.multiply(held, product);
  const double scale = (load - product).head(free).norm();
  if (scale == 0.0) return {};
  network.multiply(x, product);
  r.head(free) = (load - product).head(free);
  precondition(r, z);
  p.head(free) = z.head(free);
  double rz = dot(r.head(free), z.head(free));
  Solution found;
  const int most = 20 * static_cast<int>(free);
  for (;; ++found.iterations) {
    found.residual = std::sqrt(dot(r.head(free), r.head(free))) / scale;
    if (found.residual <= tolerance) return found;
    if (found.iterations == most || !std::isfinite(found.residual))
      throw ComputationFailed(
          fmt::format("linear response: found a residual of {:.1e} after {} iterations, expected {:.1e}",
                      found.residual, found.iterations, tolerance));
    network.multiply(p, product);
    const double step = rz / dot(p.head(free), product.head(free));
    x.head(free) += step * p.head(free);
    r.head(free) -= step * product.head(free);
    precondition(r, z);
    const double next = dot(r.head(free), z.head(free));
    p.head(free) = z.head(free) + (next / rz) * p.head(free);
    rz = next;
  }
}

}  // namespace pendular::dem_core
