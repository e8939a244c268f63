#include "diagnosis/kinds/displacement_signature.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace pendular::diagnosis {

std::vector<std::pair<std::string, double>> displacement_signature(const Columns& columns) {
  const auto& strains = columns.at("strain");
  if (strains.size() < 20 || strains.front() <= 0.0) return {};
  const double strain = strains.front();

  // Affine motion by least squares: u = (1, x, y, z) · coefficients.
  const auto count = static_cast<Eigen::Index>(strains.size());
  Eigen::MatrixXd place(count, 4), motion(count, 3);
  for (Eigen::Index r = 0; r < count; ++r) {
    const auto k = static_cast<std::size_t>(r);
    place.row(r) << 1.0, columns.at("x_um")[k], columns.at("y_um")[k], columns.at("z_um")[k];
    motion.row(r) << columns.at("ux_um")[k], columns.at("uy_um")[k], columns.at("uz_um")[k];
  }
  const Eigen::MatrixXd affine = place.colPivHouseholderQr().solve(motion);
  const Eigen::MatrixXd left = motion - place * affine;
  const Eigen::RowVectorXd extent = place.colwise().maxCoeff() - place.colwise().minCoeff();
  const double spacing = std::cbrt(extent[1] * extent[2] * extent[3] / static_cast<double>(count));
  return {{"deviatoric_share", (0.5 * (affine(1, 0) + affine(2, 1)) - affine(3, 2)) / strain},
          {"tilt_share", std::hypot(affine(1, 2), affine(2, 2)) / strain},
          {"wandering", std::sqrt(left.squaredNorm() / static_cast<double>(count)) / (strain * spacing)}};
}

}  // namespace pendular::diagnosis
