#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/random.h"
#include "base/sample.h"
#include "dem_core/drive/bond_evolution.h"
#include "dem_core/observe/curve.h"
#include "dem_core/simulation.h"
#include "effects/direct_measurement.h"
#include "micromechanics/bridge_body.h"
#include "packing/contact_peak.h"
#include "packing/packing.h"

namespace pendular::effects {

/// The random numbers of one effect in one run. They follow from the run's seed, the effect's id and what is
/// drawn for, not from the magnitude: at a larger one the same specimen departs farther.
class Draws {
 public:
  Draws(std::uint64_t seed, std::string_view id) : stream_(seed) {
    for (const char c : id) stream_ = random_bits(stream_, static_cast<unsigned char>(c));
  }
  double uniform(std::uint64_t counter) const { return random_uniform(stream_, counter); }
  double normal(std::uint64_t counter) const { return random_normal(stream_, counter); }

 private:
  std::uint64_t stream_;
};

/// A counter for a pair of beads.
inline std::uint64_t of_pair(int i, int j) {
  return static_cast<std::uint64_t>(i) << 31 | static_cast<std::uint64_t>(j);
}

/// A specimen as its effects make it.
struct ActualSpecimen {
  Sample believed;  ///< as the experimenter states it
  Sample sample;    ///< what holds in truth
  Packing packing;  ///< likewise
  std::uint64_t seed = 1;
  /// Of each bond to be (Simulation::bonds): what its stiffness follows from, without and with the effects.
  std::vector<micromechanics::BridgeBody> believed_bodies, bodies;
};

/// What turns travel and force into strain and stress.
struct Gauge {
  double section, height;  ///< of the specimen before its test, m², m
};

/// What a sample says of single bridges without a specimen, µm.
struct BridgeSpread {
  double diameter_sd = 0.0;  ///< of necks
  double gap_excess = 0.0;   ///< mean gap over the stated one
};

/// Something that a real specimen, its test or its measurement may have and the paper's model has not.
/// θ is its magnitude in `unit`; at 0 there is no effect. Each hook is null where the effect does not enter;
/// effects are called in the order of the list, hooks in the order in which they stand here.
struct Effect {
  std::string id, unit;
  std::string name;           ///< plain, a few words in lower case
  std::string sentence;       ///< what a specimen, its test or its measurement then has
  std::string meaning;        ///< of θ, one line
  double lowest, highest;     ///< accepted θ
  double bank_from, bank_to;  ///< θ of a typical bank of runs
  bool of_the_ends = false;   ///< θ is a length that counts as a share of the specimen's size
  bool draws =
      false;  ///< what it does differs from specimen to specimen of one θ: which bridges, which beads

  /// Why it cannot act in any specimen of such a sample, to follow a colon; empty: it can.
  std::function<std::string(const Sample& sample)> inert_in = nullptr;
  /// What finds or rules it out by itself.
  std::optional<DirectMeasurement> settled_by = {};
  /// What becomes of the gaps of touching beads in tables of measured beads.
  std::function<void(ContactPeak& peak, double theta)> contacts = nullptr;
  /// θ that such tables show by themselves; nothing within their noise.
  std::function<std::optional<double>(const ContactPeak& peak)> shown_by_beads = nullptr;
  /// What becomes of single bridges, for whoever knows the sample only.
  std::function<void(BridgeSpread& spread, double theta)> single_bridges = nullptr;

  /// What the sample file states otherwise than it is.
  std::function<void(Sample& sample, double theta)> sample = nullptr;
  /// What beads that were measured are taken to be, with their standard errors: of effects on how single
  /// beads are measured, for whoever knows their table only (closed_contacts()).
  std::function<void(std::vector<Bead>& beads, double theta)> beads = nullptr;
  /// From the beads and bridges as measured to those that are, before diameters are drawn; and back, of those
  /// effects that say what measured beads are taken to be.
  std::function<void(Packing& packing, double theta, const Draws& draws)> truth = nullptr;
  std::function<void(Packing& packing, double theta, const Draws& draws)> reading = nullptr;
  /// What becomes of the packing that is.
  std::function<void(Packing& packing, double theta, const Draws& draws)> packing = nullptr;
  /// What becomes of one bridge; `pair` is its counter. Its stiffness changes by the ratio that finite
  /// elements give.
  std::function<void(micromechanics::BridgeBody& body, const Sample& sample, double theta, const Draws& draws,
                     std::uint64_t pair)>
      body = nullptr;
  /// What becomes of the specimen before its test.
  std::function<void(dem_core::Simulation& simulation, const ActualSpecimen& specimen, double theta,
                     const Draws& draws)>
      simulation = nullptr;
  /// How bonds change as the test goes on, and how many numbers each remembers for that.
  std::function<std::function<void(const dem_core::BondMoment&)>(const ActualSpecimen& specimen,
                                                                 double theta)>
      evolution = nullptr;
  std::size_t memory = 0;
  /// What the instruments make of the rows.
  std::function<void(std::vector<CurveRow>& rows, const Gauge& gauge, double theta)> rows = nullptr;
  /// Lengths that scans measure, over the true ones.
  std::function<double(double theta)> lengths = nullptr;

  /// The same as `evolution` of all standing bonds at once, sorted by their number, after that of single
  /// ones.
  std::function<std::function<void(std::span<const dem_core::BondMoment>)>(const ActualSpecimen& specimen,
                                                                           double theta)>
      evolution_of_all = nullptr;
  /// Of an effect that is no part of the library: what it does, as text or a digest; part of its runs' hash.
  std::string code = {};

  /// Whether it changes nothing but what instruments read.
  bool reads_only() const {
    return rows && !sample && !beads && !truth && !packing && !body && !simulation && !evolution &&
           !evolution_of_all;
  }
};

}  // namespace pendular::effects
