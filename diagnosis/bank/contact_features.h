#pragma once

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
/// beyond those stated, zero and what is stated. The standard errors hold what touching beads overlap and
/// part by (kTouchingGap, kTouchingScatter).
std::vector<ContactFeature> contact_features(const ContactPeak& peak);

bool is_of_beads(const Feature& feature);

/// The peak that a table with these stated errors should have: at zero and as wide as they say, but for
/// effects on the measurement (Effect::contacts).
ContactPeak expected_contacts(ContactPeak observed, const Changes& changes);

}  // namespace pendular::diagnosis
