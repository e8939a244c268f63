#include "base/distributions.h"

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/students_t.hpp>

namespace pendular {
namespace {

namespace math = boost::math;
using math::policies::ignore_error;

/// No exceptions: NaN where a distribution has no such parameters.
using Quiet = math::policies::policy<math::policies::domain_error<ignore_error>,
                                     math::policies::overflow_error<ignore_error>,
                                     math::policies::evaluation_error<ignore_error>>;
using ChiSquared = math::chi_squared_distribution<double, Quiet>;
using FisherF = math::fisher_f_distribution<double, Quiet>;
using StudentT = math::students_t_distribution<double, Quiet>;

}  // namespace

double chi_squared_tail(double value, double dof) {
  return math::cdf(math::complement(ChiSquared(dof), value));
}

double chi_squared_quantile(double probability, double dof) {
  return math::quantile(ChiSquared(dof), probability);
}

double f_tail(double value, double above, double below) {
  return math::cdf(math::complement(FisherF(above, below), value));
}

double f_quantile(double probability, double above, double below) {
  return math::quantile(FisherF(above, below), probability);
}

double student_quantile(double probability, double dof) {
  return math::quantile(StudentT(dof), probability);
}

}  // namespace pendular
