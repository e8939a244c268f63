#pragma once

#include <optional>
#include <span>

#include "reproduction/ensemble.h"
#include "reproduction/report.h"
#include "sweep/store.h"

namespace pendular::reproduction {

/// The parts of the report, each from the points of one sweep, with its figures written to the desk.

/// Table 1 and Fig. 2(e,f): stiffness of single bridges by finite elements.
Section bridges_section(const Desk& desk);

/// Stress–strain curves of one whole specimen (`name` "A" or "B"), modulus, linear limit, breaks, shear band.
Section specimen_section(const Desk& desk, const std::string& name, const Point& point);

/// Bridges per interior bead against the cut-off, diameters drawn, of the specimens that `store` holds the
/// packings of.
Section coordination_section(const Desk& desk, sweep::Store& store, std::span<const Point> specimens);

/// A specimen whole beside the smaller cylinder of the series: the point of `series` with its polymer and
/// gap, or nothing where there is none.
std::optional<Section> size_section(const Point& whole, std::span<const Point> series);

/// Modulus and limit at the points of a sweep over what the paper leaves open.
Section sensitivity_section(const std::vector<Point>& points);

/// E against E_p for each gap, and the limit strain against E_p.
Section stiffness_section(const Desk& desk, const std::vector<Point>& points);

/// E against W.
Section content_section(const Desk& desk, const std::vector<Point>& points);

/// How failure depends on the volume fraction, with a picture of each.
Section volume_fraction_section(const Desk& desk, const std::vector<Point>& points);

}  // namespace pendular::reproduction
