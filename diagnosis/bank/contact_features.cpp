#include "diagnosis/bank/contact_features.h"

#include <cmath>

namespace pendular::diagnosis {
namespace {

constexpr double kUm = 1e6;
constexpr const char *kBias = "diameter_bias", *kNoise = "position_error", *kBeads = "beads";
// What gaps of touching beads have without any error of measurement, over the diameter: mean, and deviation.
constexpr double kPosition = 0.0025, kScatter = 0.004;
constexpr double kFlank = 0.15;  // share of a measured variance
constexpr double kStated = 0.3;  // what stated variances may be off by

double change(const Changes& changes, const char* id) {
  const auto found = changes.find(id);
  return found != changes.end() ? found->second : 0.0;
}

}  // namespace

std::vector<ContactFeature> contact_features(const ContactPeak& peak) {
  const double scatter = kUm * peak.scatter, stated = kUm * peak.stated, diameter = kUm * peak.diameter;
  std::vector<ContactFeature> features = {
      {{kBeads, "contact_gap_um", Scale::network, false, kUm * peak.position},
       std::hypot(kPosition * diameter, kUm * peak.sigma_position())}};
  // The flank of pairs that are apart hides part of a wide peak.
  if (stated > 0.0)
    features.push_back({{kBeads, "contact_variance_um2", Scale::network, false, scatter * scatter},
                        std::hypot(std::hypot(std::pow(kScatter * diameter, 2), kStated * stated * stated),
                                   kFlank * scatter * scatter)});
  return features;
}

bool is_of_beads(const Feature& feature) {
  return feature.observation == kBeads;
}

ContactPeak expected_contacts(ContactPeak observed, const Changes& changes) {
  const double noise = change(changes, kNoise) / kUm;
  observed.position = -change(changes, kBias) / kUm;
  observed.scatter = std::hypot(observed.stated, M_SQRT2 * noise);
  return observed;
}

std::optional<double> magnitude_shown(const std::string& effect, const ContactPeak& peak) {
  const double own = kScatter * peak.diameter;
  if (effect == kBias && std::fabs(peak.position) > kPosition * peak.diameter) return -kUm * peak.position;
  const double excess = peak.scatter * peak.scatter - peak.stated * peak.stated;
  if (effect == kNoise && peak.stated > 0.0 && excess > own * own) return kUm * std::sqrt(0.5 * excess);
  return std::nullopt;
}

}  // namespace pendular::diagnosis
