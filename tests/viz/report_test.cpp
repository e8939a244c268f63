#include "viz/report.h"

#include <gtest/gtest.h>

#include <regex>

#include "base/error.h"
#include "scratch.h"

namespace pendular {
namespace {

std::string decoded(const std::string& base64) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  unsigned bits = 0;
  int have = 0;
  for (char c : base64) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<unsigned>(digits.find(c));
    have += 6;
    if (have >= 8) {
      have -= 8;
      out += static_cast<char>(bits >> have & 255u);
    }
  }
  return out;
}

TEST(Report, EmbedsPicturesByteByByte) {
  const test::ScratchFolder scratch;
  for (std::size_t length : {0u, 1u, 2u, 3u, 256u}) {
    std::string bytes;
    for (std::size_t k = 0; k < length; ++k) bytes += static_cast<char>(255 - k);
    write_text(scratch / "p.png", bytes);
    viz::write_report(scratch / "r.html", {"t", "s", {{"h", "", {}, {{scratch / "p.png", "c"}}}}, nullptr});
    const std::string html = read_text(scratch / "r.html"), start = "data:image/png;base64,";
    const std::size_t from = html.find(start) + start.size();
    EXPECT_EQ(decoded(html.substr(from, html.find('"', from) - from)), bytes) << length;
  }
}

TEST(Report, EscapesEveryTextAndRefersToNothingOutside) {
  const test::ScratchFolder scratch;
  write_text(scratch / "p.png", "x");
  const std::string nasty = "<script src='http://e.org'>&\"</script>";
  viz::Report report{nasty,
                     nasty,
                     {{nasty, nasty, {{nasty, nasty, nasty}}, {{scratch / "p.png", nasty}}}},
                     {{"command", nasty}}};
  viz::write_report(scratch / "r.html", report);
  const std::string html = read_text(scratch / "r.html");
  EXPECT_EQ(html.find("<script"), std::string::npos);
  EXPECT_FALSE(std::regex_search(html, std::regex("(src|href)=[\"'](?!data:)")));
  EXPECT_EQ(html.find("<link"), std::string::npos);
  EXPECT_EQ(html.find("url("), std::string::npos);
  EXPECT_NE(html.find("&lt;script src=&#39;http://e.org&#39;&gt;&amp;&quot;"), std::string::npos);
}

TEST(Report, TheSummaryComesFirstThenWarningsThenFigures) {
  const test::ScratchFolder scratch;
  viz::Report report{"t", "summary", {}, nullptr};
  report.warnings = {"warning"};
  report.figures = {{"quantity", "12", ""}};
  const auto html = [&] {
    viz::write_report(scratch / "r.html", report);
    return read_text(scratch / "r.html");
  };
  EXPECT_LT(html().find(">summary<"), html().find(">warning<"));
  EXPECT_LT(html().find(">warning<"), html().find(">quantity<"));
  EXPECT_EQ(html().find("Unit"), std::string::npos);
  report.figures.push_back({"other", "1", "m"});
  EXPECT_NE(html().find("Unit"), std::string::npos);
}

TEST(Report, MissingPictureIsBadInputAndLeavesNoReport) {
  const test::ScratchFolder scratch;
  EXPECT_THROW(viz::write_report(scratch / "r.html",
                                 {"t", "s", {{"h", "", {}, {{scratch / "no.png", "c"}}}}, nullptr}),
               BadInput);
  EXPECT_FALSE(fs::exists(scratch / "r.html"));
}

}  // namespace
}  // namespace pendular
