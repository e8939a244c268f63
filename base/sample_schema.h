#pragma once

// The list of keys of the sample file, shared by its reader and by set_sample_key(). Internal to base.

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/sample.h"

namespace pendular {

struct NumberKey {
  using PlainField = double& (*)(Sample&);
  using OptionalField = std::optional<double>& (*)(Sample&);

  std::string name;        ///< dotted
  double unit;             ///< SI value of one unit of the key
  double lowest, highest;  ///< in the key's unit
  std::variant<PlainField, OptionalField> field;
  std::string meaning;

  void set(Sample& sample, double value) const;           ///< BadInput out of range
  std::optional<double> get(const Sample& sample) const;  ///< in the key's unit
};

struct WordKey {
  std::string name;
  std::vector<std::string> allowed;
  std::string& (*field)(Sample&);
};

const std::vector<NumberKey>& number_keys();
const std::vector<WordKey>& word_keys();
std::vector<std::string> all_key_names();
std::string nearest_key(const std::string& name);

}  // namespace pendular
