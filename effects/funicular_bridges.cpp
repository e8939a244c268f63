#include <fmt/format.h>

#include <cmath>

#include "effects/effect.h"
#include "effects/funicular.h"

namespace pendular::effects {
namespace {

void thin(micromechanics::BridgeBody& body, const Sample& sample, double theta, const Draws&, std::uint64_t) {
  const double content = sample.bridges.polymer_content, above = content - kFunicularContent;
  if (above > 0.0) body.neck_diameter *= std::sqrt((content - theta * above) / content);
}

std::string inert_in(const Sample& sample) {
  if (sample.bridges.polymer_content > kFunicularContent) return "";
  return fmt::format("no specimen has more polymer than the funicular transition, W* = {}",
                     kFunicularContent);
}

}  // namespace

/// The paper puts all polymer into bridges, W ∝ d². Above the funicular transition W* = 0.027 some of it
/// joins several beads and fills pores: the share θ of what is above W* carries no load, and d follows from
/// the rest. Lowers E above W*; below nothing changes.
Effect funicular_bridges() {
  return {.id = "funicular_bridges",
          .unit = "fraction",
          .name = "polymer outside the bridges",
          .sentence = "Above the funicular transition some polymer fills pores and carries no load.",
          .meaning = "share of the polymer above the funicular transition that carries no load",
          .lowest = 0.0,
          .highest = 1.0,
          .bank_from = 0.0,
          .bank_to = 1.0,
          .inert_in = inert_in,
          .body = thin};
}

}  // namespace pendular::effects
