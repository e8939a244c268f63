#include "tracking/motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "packing/bridges.h"

namespace pendular {
namespace {

double extent(const std::vector<Bead>& beads) {
  std::vector<double> heights;
  for (const auto& bead : beads) heights.push_back(bead.centre.z());
  std::sort(heights.begin(), heights.end());
  const auto at = [&](double share) {
    return heights[static_cast<std::size_t>(share * static_cast<double>(heights.size() - 1))];
  };
  return at(0.99) - at(0.01);
}

}  // namespace

Motion motion_of(const std::vector<Bead>& before, const std::vector<Bead>& after,
                 std::vector<BeadMatch> matches, double strain) {
  Motion motion;
  motion.strain = strain;
  motion.matches = std::move(matches);
  std::vector<Vec3> now;
  std::vector<double> radii, shear;
  for (const auto& match : motion.matches) {
    const Bead &a = before[static_cast<std::size_t>(match.before)],
               &b = after[static_cast<std::size_t>(match.after)];
    motion.start.push_back(a.centre);
    motion.displacement.push_back(b.centre - a.centre);
    now.push_back(b.centre);
    radii.push_back(0.5 * a.diameter);
  }
  motion.local = local_strains(motion.start, now, radii);
  for (const auto& local : motion.local) shear.push_back(local.shear);
  motion.band = find_shear_band(motion.start, shear, mean_diameter(before));
  return motion;
}

double shortening(const std::vector<Bead>& before, const std::vector<Bead>& after) {
  const double height = extent(before);
  return height > 0.0 ? 1.0 - extent(after) / height : 0.0;
}

void write_motion(const fs::path& path, const std::vector<Bead>& before, const std::vector<Bead>& after,
                  const Motion& motion, const Provenance& provenance) {
  std::string text = to_comment(provenance);
  text +=
      "strain,bead_id,x_um,y_um,z_um,ux_um,uy_um,uz_um,bead_id_after,score,shear_strain,volumetric_strain\n";
  for (std::size_t k = 0; k < motion.matches.size(); ++k) {
    const BeadMatch& match = motion.matches[k];
    const Vec3 at = 1e6 * motion.start[k], moved = 1e6 * motion.displacement[k];
    fmt::format_to(std::back_inserter(text),
                   "{},{},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{},{:.3f},{:.6g},{:.6g}\n", motion.strain,
                   before[static_cast<std::size_t>(match.before)].id, at.x(), at.y(), at.z(), moved.x(),
                   moved.y(), moved.z(), after[static_cast<std::size_t>(match.after)].id, match.score,
                   motion.local[k].shear, motion.local[k].volumetric);
  }
  write_text(path, text);
}

}  // namespace pendular
