#pragma once

#include <vector>

#include "diagnosis/bank/bank.h"
#include "diagnosis/diagnosis.h"

namespace pendular::diagnosis {

/// The places of all scans of specimens whose beads were measured, each at its least strain: with the best
/// explanation's runs where there are three or more, else with those as believed. Scans that cannot be placed
/// are left out and warned of.
std::vector<Place> places_in(const Experiment& experiment, const BankPlan& plan, MemberPackings& packings,
                             const std::vector<Overlay>& overlays, std::vector<std::string>& warnings);

}  // namespace pendular::diagnosis
