#include "phantom/phantom_blur.h"

#include <algorithm>
#include <cmath>

namespace pendular::phantom {
namespace {

int wrapped(int k, int size) {
  return ((k % size) + size) % size;
}

/// out[i] = weight · in[i], or added to it. Contiguous, so that the compiler vectorises it.
void scale(float* out, const float* in, float weight, std::size_t size) {
  for (std::size_t i = 0; i < size; ++i) out[i] = weight * in[i];
}
void accumulate(float* out, const float* before, const float* after, float weight, std::size_t size) {
  for (std::size_t i = 0; i < size; ++i) out[i] += weight * (before[i] + after[i]);
}

}  // namespace

GaussianKernel::GaussianKernel(double sd) {
  const int reach = static_cast<int>(std::ceil(4.0 * sd));
  std::vector<double> exact;
  for (int k = 0; k <= reach; ++k) exact.push_back(k == 0 ? 1.0 : std::exp(-0.5 * k * k / (sd * sd)));
  double sum = exact[0];
  for (int k = 1; k <= reach; ++k) sum += 2.0 * exact[static_cast<std::size_t>(k)];
  for (double weight : exact) weights.push_back(static_cast<float>(weight / sum));
}

double GaussianKernel::sum_of_squares() const {
  double sum = 0.0;
  for (std::size_t k = 0; k < weights.size(); ++k)
    sum += (k == 0 ? 1.0 : 2.0) * static_cast<double>(weights[k]) * static_cast<double>(weights[k]);
  return sum;
}

void smooth_slice(std::span<float> slice, int nx, int ny, const GaussianKernel& kernel,
                  std::span<float> scratch) {
  const int reach = kernel.radius();
  if (reach == 0) return;
  const auto width = static_cast<std::size_t>(nx);
  std::vector<float> padded(width + 2 * static_cast<std::size_t>(reach));
  for (int y = 0; y < ny; ++y) {
    const float* row = slice.data() + static_cast<std::size_t>(y) * width;
    float* out = scratch.data() + static_cast<std::size_t>(y) * width;
    for (int k = 0; k < nx + 2 * reach; ++k)
      padded[static_cast<std::size_t>(k)] = row[wrapped(k - reach, nx)];
    const float* middle = padded.data() + reach;
    scale(out, middle, kernel.weights[0], width);
    for (int k = 1; k <= reach; ++k)
      accumulate(out, middle - k, middle + k, kernel.weights[static_cast<std::size_t>(k)], width);
  }
  const auto row_of = [&](int y) {
    return scratch.data() + static_cast<std::size_t>(wrapped(y, ny)) * width;
  };
  for (int y = 0; y < ny; ++y) {
    float* out = slice.data() + static_cast<std::size_t>(y) * width;
    scale(out, row_of(y), kernel.weights[0], width);
    for (int k = 1; k <= reach; ++k)
      accumulate(out, row_of(y - k), row_of(y + k), kernel.weights[static_cast<std::size_t>(k)], width);
  }
}

void SliceRing::smoothed(int z, std::size_t first, const GaussianKernel& kernel, std::span<float> out) {
  scale(out.data(), slice(z).data() + first, kernel.weights[0], out.size());
  for (int k = 1; k <= kernel.radius(); ++k)
    accumulate(out.data(), slice(z - k).data() + first, slice(z + k).data() + first,
               kernel.weights[static_cast<std::size_t>(k)], out.size());
}

}  // namespace pendular::phantom
