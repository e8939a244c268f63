#include "reproduction/report.h"

#include <gtest/gtest.h>

namespace pendular::reproduction {
namespace {

TEST(Report, HoldsTablesFiguresAndWhatIsNotMatched) {
  Section section{"Sample A", "Some words."};
  section.comparisons = {{"E", "10", "11", true, "never shown"}, {"Z", "7.4", "7.0", false, "Too loose."}};
  section.table = Table{{"gap", "E"}, {{"1", "2"}, {"3", "4"}}};
  section.figures = {{"a.png", "a.csv", "Curves."}, {"b.png", "", "Band."}};
  const std::string text = to_markdown({section}, {});
  for (const char* part :
       {"## Sample A\n\nSome words.\n", "| E | 10 | 11 | yes |\n", "| Z | 7.4 | 7.0 | **no** |\n",
        "| gap | E |\n| --- | --- |\n| 1 | 2 |\n| 3 | 4 |\n", "![Curves.](a.png)", "[a.csv](a.csv)",
        "![Band.](b.png)", "- Sample A: Z: 7.4 in the paper, 7.0 here. Too loose.\n"})
    EXPECT_NE(text.find(part), std::string::npos) << part;
  EXPECT_EQ(text.find("never shown"), std::string::npos);
}

TEST(Report, WithinNeedsANumber) {
  EXPECT_TRUE(within(1.0, 1.0, 2.0));
  EXPECT_FALSE(within(2.1, 1.0, 2.0));
  EXPECT_FALSE(within(std::nan(""), 0.0, 1.0));
}

}  // namespace
}  // namespace pendular::reproduction
