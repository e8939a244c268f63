#pragma once

// Distributions of statistics, by Boost.Math. NaN where an argument has no meaning.

namespace pendular {

/// Probability that χ² of `dof` degrees of freedom is `value` or more.
double chi_squared_tail(double value, double dof);

/// The value that χ² of `dof` degrees of freedom stays below with this probability.
double chi_squared_quantile(double probability, double dof);

/// Probability that Fisher's F of `above` and `below` degrees of freedom is `value` or more.
double f_tail(double value, double above, double below);

/// The value that F stays below with this probability.
double f_quantile(double probability, double above, double below);

/// The value that Student's t of `dof` degrees of freedom, which may be infinite, stays below with this
/// probability.
double student_quantile(double probability, double dof);

}  // namespace pendular
