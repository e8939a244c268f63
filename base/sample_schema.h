#pragma once

// The list of keys of the sample file, shared by its reader, its writer and set_sample_key(). Internal to
// base.

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

  /// BadInput, opening with `where`, out of range.
  void set(Sample& sample, double value, const std::string& where) const;
  std::optional<double> in_si(const Sample& sample) const;  ///< the field's value
  std::optional<double> get(const Sample& sample) const;    ///< in the key's unit
};

struct WordKey {
  std::string name;
  std::vector<std::string> allowed;  ///< in the order of the type's values
  std::string (*field)(const Sample&);
  void (*assign)(Sample&, std::size_t which);  ///< of `allowed`

  /// BadInput, opening with `where`, for a word that is not allowed.
  void set(Sample& sample, const std::string& word, const std::string& where) const;
};

struct StrainsKey {
  std::string name;
  std::vector<double>& (*field)(Sample&);
};

struct SwitchKey {
  std::string name;
  bool& (*field)(Sample&);
};

/// Keys that a sample file has to state: what the specimen is and how far its test goes.
const std::vector<std::string>& required_keys();

/// Keys that samples of earlier versions do not state, though results depend on them.
const std::vector<std::string>& later_keys();

const std::vector<NumberKey>& number_keys();
const std::vector<WordKey>& word_keys();
const std::vector<StrainsKey>& strains_keys();
const std::vector<SwitchKey>& switch_keys();

}  // namespace pendular
