#include "viz/labels.h"

#include <gtest/gtest.h>

namespace pendular {
namespace {

TEST(Labels, AreCountedInCharactersNotBytes) {
  EXPECT_EQ(viz::characters("\u00b5m"), 2u);
  EXPECT_EQ(viz::shortened("\u00b5\u00b5\u00b5\u00b5", 4), "\u00b5\u00b5\u00b5\u00b5");
  EXPECT_EQ(viz::shortened("\u00b5\u00b5\u00b5\u00b5\u00b5\u00b5\u00b5", 5), "\u00b5...\u00b5");
}

TEST(Labels, KeepBothEndsWhereShortened) {
  EXPECT_EQ(viz::shortened("observation A: linear modulus", 15), "observ...odulus");
  EXPECT_EQ(viz::shortened("short", 15), "short");
}

TEST(Labels, BreakBetweenWords) {
  EXPECT_EQ(viz::wrapped("twenty single bridges", 14, 3), "twenty single\nbridges");
  EXPECT_EQ(viz::wrapped("one two three four", 7, 2), "one two\nthr ...");
  EXPECT_EQ(viz::wrapped("one two to be or not to be", 7, 2), "one two\nto ...");
  EXPECT_EQ(viz::wrapped("", 7, 2), "");
}

TEST(Labels, WidthIsOfTheLongestLine) {
  const std::vector<std::string> labels = {"ab\nabcd", "abc"};
  EXPECT_DOUBLE_EQ(viz::label_width(labels, 10.0),
                   2.0 * viz::label_width(std::vector<std::string>{"ab"}, 10.0));
}

}  // namespace
}  // namespace pendular
