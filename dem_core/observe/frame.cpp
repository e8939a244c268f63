#include "dem_core/observe/frame.h"

#include <cmath>

#include "dem_core/observe/frame_observers.h"

namespace pendular {
namespace {

constexpr double kUm = 1e6;  // µm per m

}  // namespace

void write_frame(const fs::path& path, const Simulation& simulation,
                 const std::vector<std::int64_t>& bead_ids, double stress, const Sample::Observe& observe) {
  const auto& beads = simulation.beads;
  PolyTable table;
  std::vector<Vec3> displacement;
  std::vector<double> diameter;
  for (std::size_t k = 0; k < beads.size(); ++k) {
    table.points.push_back(kUm * beads.position[k]);
    displacement.push_back(kUm * (beads.position[k] - beads.start[k]));
    diameter.push_back(kUm * 2.0 * beads.radius[k]);
  }
  table.point_data = {{"bead_id", bead_ids}, {"diameter_um", diameter}, {"displacement_um", displacement}};
  const auto lines = links(simulation);
  std::vector<std::int64_t> state;
  for (const auto& line : lines) {
    table.lines.push_back({line.i, line.j});
    state.push_back(line.state);
  }
  table.line_data = {{"state", state}};
  for (const auto& observer : frame_observers())
    if (observe.*observer.switched_on) observer.add(simulation, lines, table);
  table.number_fields = {{"strain", simulation.strain()},
                         {"stress_pa", stress},
                         {"platen_bottom_um", kUm * simulation.bottom.z},
                         {"platen_top_um", kUm * simulation.top.z},
                         {"specimen_diameter_um", kUm * std::sqrt(4.0 / M_PI * simulation.section)}};
  table.text_fields = {{"units", "coordinates in um; SI or the unit in an array's name otherwise"},
                       {"line_states", "0 bond, 1 broken bond, 2 contact without bond"}};
  write_polydata(path, table);
}

}  // namespace pendular
