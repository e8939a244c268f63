#pragma once

#include <vector>

#include "diagnosis/repair/place.h"
#include "diagnosis_report/drawn.h"
#include "packing/polydata.h"
#include "viz/viewer/specimen_view.h"

namespace pendular::diagnosis_report {

/// Where experiment and simulation part, and what change of stiffness would mend it: specimens cut through
/// their axis. Draws on a display of its own where there is a place (viz/display.h).
std::vector<Drawn> place_figures(const std::vector<diagnosis::Place>& places);

/// Both fields on the whole specimen, to turn.
viz::SpecimenView place_view(const diagnosis::Place& place);

/// Beads at rest with both fields, for ParaView: bead_id, diameter_um, difference_um (measured less
/// simulated), misfit (over noise), stands_out, stiffness_change_percent, stiffness_change_sigma_percent.
PolyTable place_polydata(const diagnosis::Place& place);

}  // namespace pendular::diagnosis_report
