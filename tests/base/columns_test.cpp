#include "base/columns.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/csv.h"
#include "base/error.h"
#include "scratch.h"

namespace pendular {
namespace {

TEST(Columns, RangesFollowFromUnitAndMeaning) {
  EXPECT_TRUE(range_of("x_um").holds(-4000.0));
  EXPECT_FALSE(range_of("x_um").holds(1e7));
  EXPECT_FALSE(range_of("diameter_um").holds(0.0));
  EXPECT_FALSE(range_of("sigma_centre_um").holds(-1e-9));
  EXPECT_FALSE(range_of("stress_sigma_pa").holds(-1.0));
  EXPECT_FALSE(range_of("probability").holds(1.01));
  EXPECT_TRUE(range_of("stress_pa").holds(-2e9));
  for (const char* name : {"x_um", "quality", "strain", "anything"})
    for (const double value : {std::nan(""), HUGE_VAL, -HUGE_VAL, 1e300})
      EXPECT_FALSE(range_of(name).holds(value)) << name << ' ' << value;
}

TEST(Columns, ATableIsHeldToThem) {
  const test::ScratchFolder folder;
  for (const char* cell : {"1e7", "nan", "inf", "-1e300"}) {
    write_text(folder / "t.csv", std::string("x_um\n0\n") + cell + "\n");
    EXPECT_THROW(read_csv(folder / "t.csv", {"x_um"}).numbers("x_um"), BadInput) << cell;
  }
}

}  // namespace
}  // namespace pendular
