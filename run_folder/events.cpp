#include "run_folder/events.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/csv.h"

namespace pendular {
namespace {

constexpr double kUm = 1e6;  // µm per m

}  // namespace

void write_events(const fs::path& path, const std::vector<BreakRow>& breaks, const Provenance& provenance) {
  std::string text =
      to_comment(provenance) + "strain,bead_i,bead_j,x_um,y_um,z_um,mode,stretch_um,shear_um,energy_j\n";
  for (const auto& e : breaks)
    text += fmt::format("{:.9g},{},{},{:.4f},{:.4f},{:.4f},{},{:.6g},{:.6g},{:.6g}\n", e.strain, e.bead_i,
                        e.bead_j, kUm * e.place.x(), kUm * e.place.y(), kUm * e.place.z(), e.mode,
                        kUm * e.stretch, kUm * e.shear, e.energy);
  write_text(path, text);
}

void write_avalanches(const fs::path& path, const std::vector<Avalanche>& avalanches,
                      const Provenance& provenance) {
  std::string text =
      to_comment(provenance) + "first_strain,last_strain,breaks,energy_j,x_um,y_um,z_um,extent_um\n";
  for (const auto& a : avalanches)
    text += fmt::format("{:.9g},{:.9g},{},{:.6g},{:.4f},{:.4f},{:.4f},{:.4f}\n", a.first_strain,
                        a.last_strain, a.breaks, a.energy, kUm * a.centre.x(), kUm * a.centre.y(),
                        kUm * a.centre.z(), kUm * a.extent);
  write_text(path, text);
}

std::vector<double> read_break_strains(const fs::path& path) {
  std::vector<double> strains = read_csv(path, {"strain"}).numbers("strain");
  std::sort(strains.begin(), strains.end());
  return strains;
}

}  // namespace pendular
