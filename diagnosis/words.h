#pragma once

#include "diagnosis/diagnosis.h"

namespace pendular::diagnosis {

/// The plain name of an explanation: an effect's own, of a pair both, "no effect", "something not in the
/// library". What is none of these stays as it is.
std::string plain_name(const std::string& id);

/// What it means in one sentence; of a pair in two. Empty for what has no plain name.
std::string sentence_of(const std::string& id);

/// "bridges missing between near beads (missing_bridges)".
std::string name_and_id(const std::string& id);

/// "20 % (18 to 21 %)", of a pair "20 % (18 to 21 %) and 0.30 (0.21 to 0.39)"; empty without a magnitude.
std::string magnitudes_in_words(const Explanation& explanation);

/// "bridges missing between near beads (missing_bridges), 20 % (18 to 21 %)".
std::string in_words(const Explanation& explanation);

/// "contact gap": the name of a feature without the unit that it ends with.
std::string name_in_words(std::string feature);

/// "linear modulus of A".
std::string in_words(const Feature& feature);

/// What a feature is told in: fraction, um, um2, Pa, N/m or 1.
std::string unit_of(const Feature& feature);

/// The unit that a key of the sample ends with: Pa, um or 1.
std::string unit_of_key(const std::string& key);

/// A magnitude that is a limit, to about a tenth of itself.
std::string limit_in_words(double limit, const std::string& unit);

/// The part of a gap that is closed, "74 % (61 to 83 %)", or that there is nothing to close.
std::string in_words(const Shrinkage& shrinkage);

/// What a further measurement is expected to do: "leave 1.4 explanations of 3.2", or, where a set stays as
/// large, what it does to its probabilities.
std::string outlook_in_words(const Outlook& with, const Outlook& without);

/// "a, b and c"; of more than `most` that many and "3 more".
std::string joined(const std::vector<std::string>& words, std::size_t most, const char* last = " and ");

}  // namespace pendular::diagnosis
