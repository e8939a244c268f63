#include "base/text_line.h"

#include <gtest/gtest.h>

namespace pendular {
namespace {

TEST(TextLine, IsOneLineThatATerminalMayShow) {
  EXPECT_EQ(text_line("3 \u00b5m\nof 4\r\n"), "3 \u00b5m of 4  ");
  EXPECT_EQ(text_line("\x1b[31mred\x07\x7f"), "?[31mred??");
  EXPECT_EQ(text_line("a\xff\xc3(b\xe2\x82"), std::string("a?") + "?(b??");
  EXPECT_EQ(text_line("\u202egnp.exe \u0085"), "?gnp.exe ?");
  EXPECT_EQ(text_line("\xc0\xaf\xed"), "???");
}

TEST(TextLine, LeavesOutTheMiddleOfALongOne) {
  const std::string line = text_line("head " + std::string(70000, 'x') + " tail");
  EXPECT_LE(line.size(), 600u);
  EXPECT_TRUE(line.starts_with("head x"));
  EXPECT_TRUE(line.ends_with("x tail"));
  EXPECT_EQ(text_line(std::string(600, 'x')).size(), 600u);
}

}  // namespace
}  // namespace pendular
