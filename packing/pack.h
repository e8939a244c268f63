#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/sample.h"
#include "packing/measurement.h"
#include "packing/packing.h"
#include "packing/statistics.h"
#include "packing/structure.h"

namespace pendular {

/// A packing and what is found of it.
struct Packed {
  Packing packing;
  PackingStatistics statistics;
  Structure structure;
  Diameters diameters{};          ///< diameters_used()
  std::optional<Closing> closed;  ///< where contacts were closed
};

/// What beads, bridges and sample are called in messages.
struct PackNames {
  std::string beads = "beads", bridges = "bridges", sample = "sample";
};

/// Measured beads in the sample's specimen, with candidate bridges (packing_of()) or, where measured ones are
/// given, those in state `bridge`. BadInput for beads in another unit than the sample's, for overlaps that
/// measurement does not explain where diameters are used as measured, and where no measured bridge is one.
/// Warns of beads outside the specimen, of a scale that does not fit, and of errors too small for the
/// contacts they close.
Packed pack_beads(const std::vector<Bead>& measured, const std::optional<std::vector<Bridge>>& bridges,
                  const Sample& sample, const PackNames& names = {});

/// A random packing with its candidate bridges (generate_packing()).
Packed pack_generated(const Sample& sample, std::uint64_t seed);

/// Statistics, structure, diameters and closed contacts; lengths in µm, as the keys say.
nlohmann::ordered_json to_json(const Packed& packed);

}  // namespace pendular
