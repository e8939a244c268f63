#include "base/csv.h"

#include <gtest/gtest.h>
#include <malloc.h>

#include <cmath>
#include <limits>
#include <string>

#include "base/error.h"
#include "base/number_cell.h"
#include "scratch.h"

namespace pendular {
namespace {

using test::ScratchFolder;

TEST(Csv, ReadsColumnsByNameInAnyOrder) {
  ScratchFolder folder;
  write_text(folder / "t.csv", "# a comment\nb,unknown, a \n2,x,1\n# between\n4.5e-3,y,-3\n");
  const CsvTable table = read_csv(folder / "t.csv", {"a", "b"}, {"c"});
  EXPECT_EQ(table.rows(), 2u);
  EXPECT_EQ(table.numbers("a"), (std::vector<double>{1.0, -3.0}));
  EXPECT_EQ(table.numbers("b"), (std::vector<double>{2.0, 4.5e-3}));
  EXPECT_FALSE(table.has("c"));
}

// Large blocks are mapped anew, full of zeros, unless the allocator is told not to, as others do not.
TEST(Csv, EndsWithTheFileWhateverLiesBeyondIt) {
  ::mallopt(M_MMAP_MAX, 0);
  ::mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
  ScratchFolder folder;
  write_text(folder / "other.csv", "c,d\n1,2\n3,4\n");
  write_text(folder / "unended.csv", "a,b\n1,2");
  EXPECT_THROW(read_csv(folder / "other.csv", {"a", "b"}), BadInput);
  EXPECT_EQ(read_csv(folder / "unended.csv", {"a", "b"}).numbers("b"), std::vector<double>{2.0});
}

struct BadTable {
  const char* name;
  const char* text;
  const char* expected;  ///< part of the message
};

class CsvBadInput : public testing::TestWithParam<BadTable> {};

TEST_P(CsvBadInput, SaysWhereAndWhat) {
  ScratchFolder folder;
  write_text(folder / "t.csv", GetParam().text);
  try {
    read_csv(folder / "t.csv", {"a", "b"}).numbers("a");
    FAIL() << "accepted";
  } catch (const BadInput& error) {
    EXPECT_NE(std::string(error.what()).find(GetParam().expected), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("t.csv"), std::string::npos) << error.what();
  }
}

INSTANTIATE_TEST_SUITE_P(
    Table, CsvBadInput,
    testing::Values(BadTable{"missing", "a,c\n1,2\n", "column b is missing"},
                    BadTable{"word", "a,b\n1,2\nx,2\n", ":3: column a: found \"x\""},
                    BadTable{"nan", "a,b\nnan,2\n", "finite"}, BadTable{"inf", "a,b\n-inf,2\n", "finite"},
                    BadTable{"trailing", "a,b\n1.5um,2\n", "1.5um"}, BadTable{"short", "a,b\n1\n", "column"},
                    BadTable{"long", "a,b\n1,2,3\n", "column"}, BadTable{"twice", "a,a,b\n1,2,3\n", "a"},
                    BadTable{"empty", "", "Header missing"}, BadTable{"blank", "a,b\n,2\n", "found \"\""}),
    [](const auto& test) { return test.param.name; });

TEST(Csv, MissingFile) {
  EXPECT_THROW(read_csv("/nonexistent/t.csv", {"a"}), BadInput);
}

TEST(Csv, NumbersThatMeanNothingAreEmptyCells) {
  EXPECT_EQ(fmt::format("{:.3f},{},{:.2e},{:.6g}", NumberCell{1.5}, NumberCell{std::nan("")},
                        NumberCell{-HUGE_VAL}, NumberCell{2.0}),
            "1.500,,,2");
}

TEST(Csv, CellsReadBackAsTheyWereWritten) {
  const ScratchFolder folder;
  const std::string text = "a \"b\", c # d";
  write_text(folder / "t.csv", "number,none,text,after\n" + csv_cell(0.1) + ',' + csv_cell(std::nan("")) +
                                   ',' + csv_cell(text) + ',' + csv_cell("two\nlines") + '\n');
  const CsvTable table = read_csv(folder / "t.csv", {"number", "none", "text", "after"});
  ASSERT_EQ(table.rows(), 1u);
  EXPECT_EQ(table.numbers("number")[0], 0.1);
  EXPECT_TRUE(std::isnan(table.numbers("none", true)[0]));
  EXPECT_EQ(table.texts("text")[0], text);
  EXPECT_EQ(table.texts("after")[0], "two lines");
}

}  // namespace
}  // namespace pendular
