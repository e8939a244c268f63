#pragma once

#include <functional>
#include <string>
#include <vector>

#include "dem_core/drive/bond_evolution.h"
#include "dem_core/observe/curve.h"
#include "dem_core/simulation.h"
#include "effects/effect.h"
#include "packing/packing.h"

namespace pendular::blind {

/// Something that a specimen, its test or its measurement may have and that the library of effects has not:
/// what a diagnosis must call unknown. Hooks are null where the mechanism does not enter.
struct Mechanism {
  std::string id;
  std::string kind;  ///< specimen, polymer, contacts, loading, instrument or bookkeeping
  std::string unit;  ///< of its magnitude θ; 0: there is none
  std::string meaning;
  double from, to;  ///< θ that cases draw from
  /// What becomes of the specimen that is. Bridges that it adds are in state `bridge`: they carry load and
  /// are no bridges to who counts them.
  void (*packing)(Packing& packing, double theta) = nullptr;
  void (*simulation)(dem_core::Simulation& simulation, double theta) = nullptr;
  std::function<void(const dem_core::BondMoment&)> (*evolution)(double theta) = nullptr;
  std::size_t memory = 0;  ///< numbers of that for each bond
  /// What the instruments, or who reads them, make of the rows.
  void (*rows)(std::vector<CurveRow>& rows, const dem_core::Simulation& simulation, double theta) = nullptr;
};

const std::vector<Mechanism>& all_mechanisms();

/// BadInput, opening with `where`, for an unknown one.
const Mechanism& find_mechanism(const std::string& id, const std::string& where);

}  // namespace pendular::blind
