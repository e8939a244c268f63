#include "dem_core/observe/frame.h"

#include <cmath>

#include "dem_core/observe/frame_observers.h"
#include "run_folder/frame.h"

namespace pendular::dem_core {
void write_frame(const fs::path& path, const Simulation& simulation,
                 const std::vector<std::int64_t>& bead_ids, double stress, const Sample::Observe& observe) {
  const auto& beads = simulation.beads;
  RunFrame frame;
  frame.strain = simulation.strain(), frame.stress = stress;
  frame.platen_bottom = simulation.bottom.z, frame.platen_top = simulation.top.z;
  frame.specimen_diameter = std::sqrt(4.0 / M_PI * simulation.section);
  frame.ids = bead_ids;
  frame.position = beads.position;
  for (std::size_t k = 0; k < beads.size(); ++k) {
    frame.displacement.push_back(beads.position[k] - beads.start[k]);
    frame.diameter.push_back(2.0 * beads.radius[k]);
  }
  const auto lines = links(simulation);
  for (const auto& line : lines) {
    frame.pairs.push_back({line.i, line.j});
    frame.lines.push_back(static_cast<RunFrame::Line>(line.state));
  }
  PolyTable table = table_of(frame);
  for (const auto& observer : frame_observers())
    if (observe.*observer.switched_on) observer.add(simulation, lines, table);
  write_polydata(path, table);
}

}  // namespace pendular::dem_core
