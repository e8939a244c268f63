#pragma once

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include <cmath>
#include <string>

#include "diagnosis/bank/feature_values.h"
#include "diagnosis/kinds/kind.h"

namespace pendular::diagnosis::test {

/// An observation as read_experiment() gives it where the experiment says nothing of the kind's own keys.
inline Observation observation(const Kind& kind, const std::string& name, Columns columns) {
  Observation made;
  made.kind = &kind;
  made.name = made.file = name;
  made.columns = std::move(columns);
  for (const auto& key : kind.keys)
    if (key.words.empty())
      made.numbers[key.name] = key.otherwise;
    else
      made.words[key.name] = key.words.front();
  return made;
}

/// NaN where there is none of that name.
inline double value(const std::vector<Feature>& features, const std::string& name) {
  for (const auto& feature : features)
    if (feature.name == name) return feature.value;
  return std::nan("");
}

inline double value(const Observation& of, const std::string& name, Level level = Level::landmarks) {
  return value(features_of(level, of, of.columns), name);
}

/// The standard error that the measurement leaves, as the feature is compared.
inline double sigma(const Observation& of, const std::string& name, Level level = Level::landmarks) {
  Experiment experiment;
  experiment.observations = {of};
  const auto observed = observed_features(level, experiment);
  for (std::size_t k = 0; k < observed.features.size(); ++k)
    if (observed.features[k].name == name) return observed.sigma(k);
  return std::nan("");
}

inline void expect_covariance(const Eigen::MatrixXd& matrix, std::size_t size) {
  ASSERT_EQ(static_cast<std::size_t>(matrix.rows()), size);
  EXPECT_LT((matrix - matrix.transpose()).norm(), 1e-12 * matrix.norm());
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix).eigenvalues().minCoeff(), 0.0);
}

}  // namespace pendular::diagnosis::test
