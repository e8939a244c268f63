#include "diagnosis_report/explanations.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "diagnosis/inference/evidence.h"
#include "diagnosis/words.h"
#include "viz/labels.h"

namespace pendular::diagnosis_report {
namespace {

constexpr double kShownPair = 0.01;  // probability from which a pair is shown by itself

constexpr std::size_t kLongestName = 16;

}  // namespace

bool is_pair(const std::string& id) {
  return id.find('+') != std::string::npos;
}

bool in_ambiguity_set(const diagnosis::Diagnosis& diagnosis, const std::string& id) {
  const auto& set = diagnosis.ambiguity_set;
  return std::find(set.begin(), set.end(), id) != set.end();
}

std::pair<double, double> told_from(const diagnosis::Diagnosis& diagnosis, const std::string& id) {
  constexpr double kNot = std::numeric_limits<double>::quiet_NaN();
  const auto& all = diagnosis.promise.correction.told_from;
  const auto from = all.find(id);
  if (from == all.end()) return {kNot, kNot};
  const auto learnt = [&](double least) { return least > 0.0 ? least : kNot; };
  return {learnt(from->second.negative), learnt(from->second.positive)};
}

bool is_suspect(const diagnosis::Diagnosis& diagnosis, const std::string& effect) {
  return std::any_of(diagnosis.ambiguity_set.begin(), diagnosis.ambiguity_set.end(),
                     [&](const std::string& id) {
                       const auto effects = diagnosis::effects_in(id);
                       return std::find(effects.begin(), effects.end(), effect) != effects.end();
                     });
}

std::string feature_label(const diagnosis::Feature& feature) {
  return fmt::format("{}: {}", viz::shortened(feature.observation, kLongestName),
                     diagnosis::name_in_words(feature.name));
}

Shown shown_of(const diagnosis::Diagnosis& diagnosis) {
  Shown shown;
  for (const auto& explanation : diagnosis.explanations) {
    if (!is_pair(explanation.id) || explanation.probability >= kShownPair ||
        in_ambiguity_set(diagnosis, explanation.id)) {
      shown.explanations.push_back(explanation);
    } else {
      ++shown.other_pairs;
      shown.other_probability += explanation.probability;
    }
  }
  return shown;
}

}  // namespace pendular::diagnosis_report
