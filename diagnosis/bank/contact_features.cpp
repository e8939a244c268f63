#include "diagnosis/bank/contact_features.h"

#include <algorithm>
#include <cmath>

#include "diagnosis/thresholds.h"
#include "effects/list.h"

namespace pendular::diagnosis {
namespace {

constexpr double kUm = 1e6;
constexpr const char* kBeads = "beads";

}  // namespace

std::vector<ContactFeature> contact_features(const ContactPeak& peak) {
  const double scatter = kUm * peak.scatter, stated = kUm * peak.stated, diameter = kUm * peak.diameter;
  std::vector<ContactFeature> features = {
      {{kBeads, "contact_gap_um", Scale::network, false, kUm * peak.position},
       std::hypot(kTouchingGap * diameter, kUm * peak.sigma_position())}};
  // Variances add: what touching beads are apart by themselves is no more than what was measured. The flank
  // of pairs that are apart hides part of a wide peak.
  const double measured = scatter * scatter, own = std::pow(kTouchingScatter * diameter, 2);
  if (stated > 0.0)
    features.push_back({{kBeads, "contact_variance_um2", Scale::network, false, measured},
                        std::hypot(std::min(own, measured), kThresholds.stated_variance * stated * stated,
                                   kThresholds.flank * measured)});
  return features;
}

bool is_of_beads(const Feature& feature) {
  return feature.observation == kBeads;
}

ContactPeak expected_contacts(ContactPeak observed, const Changes& changes) {
  observed.position = 0.0;
  observed.scatter = observed.stated;
  for (const auto& [id, theta] : changes)
    if (const auto* effect = effects::known_effect(id); effect && effect->contacts)
      effect->contacts(observed, theta);
  return observed;
}

}  // namespace pendular::diagnosis
