#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/distributions.h"
#include "base/quantile.h"

namespace pendular {

TEST(Quantile, OfFewValues) {
  EXPECT_EQ(median({3.0, 1.0, 2.0}), 2.0);
  EXPECT_EQ(median({4.0, 1.0, 2.0, 3.0}), 3.0);
  EXPECT_EQ(median({}), 0.0);
  EXPECT_EQ(lower_quantile<float>({4.0F, 1.0F, 2.0F, 3.0F}, 0.5), 2.0F);
  EXPECT_EQ(lower_quantile<double>({4.0, 1.0, 2.0, 3.0}, 1.0), 4.0);
  EXPECT_EQ(lower_quantile<double>({}, 0.5), 0.0);
  const double shares[] = {0.0, 0.4, 0.4, 0.7, 1.0};
  EXPECT_EQ(lower_quantiles<double>({5.0, 1.0, 4.0, 3.0, 2.0, 6.0}, shares),
            (std::vector<double>{1.0, 3.0, 3.0, 4.0, 6.0}));
  EXPECT_EQ(lower_quantiles<double>({}, shares), std::vector<double>(5, 0.0));
  EXPECT_EQ(quantile({4.0, 1.0, 2.0, 3.0}, 0.5), 2.5);
  EXPECT_DOUBLE_EQ(quantile({4.0, 1.0, 2.0, 3.0}, 0.9), 3.7);
  EXPECT_EQ(quantile({4.0, 1.0}, 1.0), 4.0);
  EXPECT_EQ(quantile({HUGE_VAL, 1.0, 2.0}, 0.5), 2.0);
  EXPECT_TRUE(std::isnan(quantile({}, 0.5)));
}

// Tables of Abramowitz & Stegun (1964): 26.8 (χ²), 26.9 (F), 26.10 (t).
TEST(Distributions, AreThoseOfTheTables) {
  EXPECT_NEAR(chi_squared_quantile(0.95, 1), 3.84146, 1e-5);
  EXPECT_NEAR(chi_squared_quantile(0.95, 10), 18.3070, 1e-4);
  EXPECT_NEAR(chi_squared_tail(18.3070, 10), 0.05, 1e-6);
  EXPECT_NEAR(f_quantile(0.95, 3, 10), 3.71, 5e-3);
  EXPECT_NEAR(f_quantile(0.99, 2, 8), 8.65, 5e-3);
  EXPECT_NEAR(f_tail(f_quantile(0.95, 3, 10), 3, 10), 0.05, 1e-12);
  EXPECT_NEAR(student_quantile(0.95, 1), 6.314, 5e-4);
  EXPECT_NEAR(student_quantile(0.95, 8), 1.860, 5e-4);
  EXPECT_NEAR(student_quantile(0.975, 30), 2.042, 5e-4);
}

// F with two degrees of freedom above has a closed form; with many below it is χ² over those above; t of
// infinitely many is normal.
TEST(Distributions, MeetTheirLimits) {
  EXPECT_NEAR(f_quantile(0.99, 2, 14), 7.0 * (std::pow(0.01, -2.0 / 14) - 1.0), 1e-9);
  EXPECT_NEAR(f_tail(1.7, 6, 1e9), chi_squared_tail(6 * 1.7, 6), 1e-7);
  EXPECT_TRUE(std::isnan(student_quantile(0.95, std::nan(""))));
  EXPECT_NEAR(student_quantile(0.95, std::numeric_limits<double>::infinity()), 1.6448536269514722, 1e-12);
}

}  // namespace pendular
