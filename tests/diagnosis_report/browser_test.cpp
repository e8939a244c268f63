#include <gtest/gtest.h>

#include "base/files.h"
#include "browser.h"
#include "diagnosis_report/report_folder.h"
#include "planted_diagnosis.h"

namespace pendular {
namespace {

/// What the loaded page is: its pictures, those that did not decode, whether it is wider than the window, and
/// how much it wants from the network or the disc.
constexpr const char* kProbe = R"(
  const pictures = [...document.images];
  return {
    pictures: pictures.length,
    broken: pictures.filter(p => !p.complete || p.naturalWidth == 0).length,
    too_wide: document.documentElement.scrollWidth > innerWidth,
    height: document.body.scrollHeight,
    outside: [...document.querySelectorAll("[src], link[href]")]
      .map(e => e.getAttribute("src") || e.getAttribute("href")).filter(n => !n.startsWith("data:")).length
  };)";

TEST(ReportInBrowser, RendersWithoutErrors) {
  SKIP_WITHOUT_CHROMIUM();
  const test::ScratchFolder scratch;
  diagnosis_report::write_report_folder(scratch / "report", test::planted_diagnosis());
  const test::Seen seen =
      test::open_in_browser(scratch, read_text(scratch / "report" / "report.html"), kProbe);
  EXPECT_EQ(seen.log, "");
  ASSERT_TRUE(seen.page.is_object());
  EXPECT_EQ(seen.page["pictures"], 15);
  EXPECT_EQ(seen.page["broken"], 0);
  EXPECT_EQ(seen.page["outside"], 0);
  EXPECT_EQ(seen.page["too_wide"], false);
  EXPECT_GT(seen.page["height"], 5000);
}

TEST(ReportInBrowser, SuchAnOpeningSeesErrors) {
  SKIP_WITHOUT_CHROMIUM();
  const test::ScratchFolder scratch;
  write_text(scratch / "beside.png", "no picture");
  const test::Seen seen = test::open_in_browser(
      scratch,
      "<!DOCTYPE html><html><head><title>t</title></head><body><img src=\"data:image/png;base64,AAAA\">"
      "<img src=\"beside.png\"><div "
      "style=\"width:3000px\">wide</div><script>nowhere();</script></body></html>",
      kProbe);
  ASSERT_TRUE(seen.page.is_object());
  EXPECT_EQ(seen.page["broken"], 2);
  EXPECT_EQ(seen.page["outside"], 1);
  EXPECT_EQ(seen.page["too_wide"], true);
  EXPECT_NE(seen.log.find("nowhere"), std::string::npos);
}

}  // namespace
}  // namespace pendular
