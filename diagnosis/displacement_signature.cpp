#include "diagnosis/displacement_signature.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace pendular::diagnosis {

std::vector<std::pair<std::string, double>> displacement_signature(const Columns& columns) {
  const auto& strain = columns.at("strain");
  const double last = *std::max_element(strain.begin(), strain.end());
  std::vector<std::size_t> rows;
  for (std::size_t k = 0; k < strain.size(); ++k)
    if (strain[k] >= last * (1.0 - 1e-9)) rows.push_back(k);
  if (rows.size() < 20 || last <= 0.0) return {};

  // Affine motion by least squares: u = (1, x, y, z) · coefficients.
  const auto count = static_cast<Eigen::Index>(rows.size());
  Eigen::MatrixXd place(count, 4), motion(count, 3);
  for (Eigen::Index r = 0; r < count; ++r) {
    const std::size_t k = rows[static_cast<std::size_t>(r)];
    place.row(r) << 1.0, columns.at("x_um")[k], columns.at("y_um")[k], columns.at("z_um")[k];
    motion.row(r) << columns.at("ux_um")[k], columns.at("uy_um")[k], columns.at("uz_um")[k];
  }
  const Eigen::MatrixXd affine = place.colPivHouseholderQr().solve(motion);
  const Eigen::MatrixXd left = motion - place * affine;
  const Eigen::RowVectorXd extent = place.colwise().maxCoeff() - place.colwise().minCoeff();
  const double spacing = std::cbrt(extent[1] * extent[2] * extent[3] / static_cast<double>(count));
  return {{"bulk_strain_share", -affine(3, 2) / last},
          {"radial_share", 0.5 * (affine(1, 0) + affine(2, 1)) / last},
          {"tilt_share", std::hypot(affine(1, 2), affine(2, 2)) / last},
          {"wandering", std::sqrt(left.squaredNorm() / static_cast<double>(count)) / (last * spacing)}};
}

}  // namespace pendular::diagnosis
