#pragma once

#include <string>
#include <vector>

namespace pendular {

// Keys of the sample file that hold one of a few words, as types. Words are read and written in one place,
// base/sample.cpp; here they stand behind their values.

/// Of the beads that are compressed.
enum class Diameters {
  automatic,  ///< "auto": measured where their errors are stated, else drawn (packing/measurement.h)
  measured,   ///< as they are in the packing
  drawn,      ///< anew, as the paper does
};

/// Of bonds.
enum class StiffnessOf {
  one,         ///< all the same, as the paper
  per_bridge,  ///< each from its own gap and diameter
};

/// When a bond breaks.
enum class Breaking {
  griffith,  ///< at an energy of tension, compression and shear together, as the paper
  limits,    ///< at a limit of tension or one of shear: where that criterion has its ends
};

/// The normal force of glass on glass.
enum class Glass {
  linear,  ///< k_glass times the overlap
  hertz,   ///< after Hertz, the same at an overlap of D/200
};

/// Of a pair that is bonded and in contact.
enum class TangentialSprings {
  one,  ///< one whose stiffness jumps at touch
  two,  ///< bond kt and contact 10 kt apart
};

/// Of the moving platen.
enum class Control {
  speed,
  stress,      ///< a ramp
  relaxation,  ///< increments, each followed by rest
};

/// All words of a type, in the order of its values; and the word of one.
template <typename Word>
const std::vector<std::string>& words_for();
template <>
const std::vector<std::string>& words_for<Diameters>();
template <>
const std::vector<std::string>& words_for<StiffnessOf>();
template <>
const std::vector<std::string>& words_for<Breaking>();
template <>
const std::vector<std::string>& words_for<Glass>();
template <>
const std::vector<std::string>& words_for<TangentialSprings>();
template <>
const std::vector<std::string>& words_for<Control>();

std::string to_string(Diameters value);
std::string to_string(StiffnessOf value);
std::string to_string(Breaking value);
std::string to_string(Glass value);
std::string to_string(TangentialSprings value);
std::string to_string(Control value);

}  // namespace pendular
