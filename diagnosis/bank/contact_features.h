#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnosis/bank/bank.h"
#include "diagnosis/kinds/features.h"
#include "packing/contact_peak.h"

namespace pendular::diagnosis {

/// A feature of the tables of beads, and its standard error.
struct ContactFeature {
  Feature feature;
  double sigma;
};

/// The mean gap of touching beads and, where errors are stated, its variance: without errors of measurement
/// beyond those stated, zero and what is stated. Beads of a real or simulated packing overlap and part by
/// some thousandths of their diameter where they touch; the standard errors hold that.
std::vector<ContactFeature> contact_features(const ContactPeak& peak);

bool is_of_beads(const Feature& feature);

/// The peak that a table with these stated errors should have: diameters too large by θ draw it to −θ,
/// unreported noise θ of centres adds 2θ² to its variance.
ContactPeak expected_contacts(ContactPeak observed, const Changes& changes);

/// The magnitude of an effect that the peak shows by itself; nothing of other effects, or where it shows none
/// beyond noise.
std::optional<double> magnitude_shown(const std::string& effect, const ContactPeak& peak);

}  // namespace pendular::diagnosis
