#pragma once

#include "blind/verdict.h"

namespace pendular::blind {

/// What counts as a right answer: the name alone, or every answer that an ideal observer could not tell from
/// the truth on the case's observations.
enum class Counting { by_name, by_class };

/// Standard deviations of the noise below which two answers are one to an ideal observer, who knows all
/// responses and all noise.
inline constexpr double kTold = 3.0;

/// Distance of an answer from the truth of a case, in standard deviations of the noise: by the separation
/// matrix of its diagnosis, whose distances are those of an effect at its usual magnitude from the nearest
/// that another can do, and are taken to grow in proportion to θ. Every effect that is true must be stood for
/// by an effect of the answer, or by `none` where the answer is that, and every effect of the answer must
/// stand for one; the distances of what stands for what add up, over the best way to do so. Infinite for
/// `unknown`, where the truth is outside of the library, and where the diagnosis has no distance. Where
/// nothing is withheld it is the distance of the answer, at its usual magnitude, from none.
double distance_from_truth(const Verdict& verdict, const std::string& answer);

/// By class, an answer nearer to the truth than kTold is right, too; and, of a single effect and none, either
/// where the other is true and the replay of the diagnosis told the effect from none in less than half of its
/// runs.
bool is_right(const Verdict& verdict, const std::string& answer, Counting counting);

/// The single effects, and `none`, that count as the truth beside its name.
std::vector<std::string> class_of(const Verdict& verdict);

}  // namespace pendular::blind
