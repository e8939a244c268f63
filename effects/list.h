#pragma once

#include <list>
#include <string>

#include "effects/effect.h"

namespace pendular::effects {

/// Every effect, in the order in which they are applied: the library's, then those that were added.
/// References stay as others come and go.
const std::list<Effect>& all_effects();

/// An effect that is no part of the library, at the end of the list as long as this lives. Add it before
/// anything reads the list and remove it after, on one thread. Runs that other processes make do not know it.
class AddedEffect {
 public:
  /// BadInput where its id is no key of a sample or known already, a text is empty, or the ranges do not hold
  /// one another: lowest ≤ bank_from ≤ 0 < bank_to ≤ highest.
  explicit AddedEffect(Effect effect);
  ~AddedEffect();
  AddedEffect(const AddedEffect&) = delete;
  AddedEffect& operator=(const AddedEffect&) = delete;

  const Effect& effect() const { return *place_; }

 private:
  std::list<Effect>::const_iterator place_;
};

/// By its id; nullptr where there is none.
const Effect* known_effect(const std::string& id);

/// By its id; BadInput, opening with `where`, names the nearest one where there is none.
const Effect& find_effect(const std::string& id, const std::string& where);

/// Names and ranges of a sample's effects. BadInput, opening with `where`.
void check_effects(const Sample& sample, const std::string& where);

}  // namespace pendular::effects
