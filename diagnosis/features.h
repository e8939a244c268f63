#pragma once

#include <string>
#include <vector>

#include "diagnosis/experiment.h"

namespace pendular::diagnosis {

/// The ladder from one bridge to the whole.
enum class Scale { bridge, network, aggregate };

std::string to_string(Scale scale);

/// One number in which observation and simulation are compared.
struct Feature {
  std::string observation, name;
  Scale scale = Scale::aggregate;
  bool logarithm = false;  ///< compared by ratio; else by difference
  double value = 0.0;
  double strain_from = 0.0, strain_to = 0.0;  ///< where it is read from, platen strain; 0, 0: no strain in it
};

using Columns = std::map<std::string, std::vector<double>>;

/// What columns of an observation's kind come to: measured ones, or ones that a simulation gives in their
/// place. The observation tells how far in strain to look. Features that the columns do not show are left
/// out.
std::vector<Feature> features_of(const Observation& observation, const Columns& columns);

/// Standard errors of the features of the measured columns (logarithms where compared so): their scatter when
/// the columns are perturbed by their stated uncertainties, by the noise seen in a curve where none is
/// stated, or drawn again where they are a sample.
std::vector<double> feature_sigmas(const Observation& observation, int rounds, unsigned long seed);

}  // namespace pendular::diagnosis
