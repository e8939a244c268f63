#pragma once

#include <string>
#include <vector>

#include "base/sample.h"

namespace pendular::blind {

/// Something that makes truth in place of the simulation that also diagnoses: another program, or the same
/// one under another reading of what the paper leaves open.
struct Engine {
  std::string name;
  std::string meaning;
  std::vector<SampleSetting> settings;  ///< of the project's own program
  std::string glass, breaking;          ///< of Yade (blind/yade/bonded.py); empty: the project's own program
  double local_damping = 0.0;           ///< likewise

  bool outside() const { return !glass.empty(); }
};

const std::vector<Engine>& engines();
std::vector<std::string> engine_names();

/// BadInput, opening with `where`, names the nearest one where there is none.
const Engine& find_engine(const std::string& name, const std::string& where);

/// Whether the engine has an effect of the library.
bool has_effect(const Engine& engine, const std::string& effect);

}  // namespace pendular::blind
