#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "base/files.h"
#include "diagnosis_report/report_folder.h"
#include "planted_diagnosis.h"
#include "program.h"
#include "scratch.h"

namespace pendular {
namespace {

/// Writes what the loaded page is into its title: its pictures, those that did not decode, whether it is
/// wider than the window, and how much it wants from the network or the disc.
constexpr const char* kProbe = R"(<script>
addEventListener("load", () => {
  const pictures = [...document.images];
  document.title = "PROBE" + JSON.stringify({
    pictures: pictures.length,
    broken: pictures.filter(p => !p.complete || p.naturalWidth == 0).length,
    too_wide: document.documentElement.scrollWidth > innerWidth,
    height: document.body.scrollHeight,
    outside: [...document.querySelectorAll("[src], link[href]")]
      .map(e => e.getAttribute("src") || e.getAttribute("href")).filter(n => !n.startsWith("data:")).length
  }) + "EBORP";
});
</script>)";

const std::string kChromium =
    "timeout 120 chromium --headless --no-sandbox --disable-gpu --disable-dev-shm-usage --no-first-run "
    "--disable-background-networking --user-data-dir=profile --window-size=1280,900 ";

struct Seen {
  nlohmann::json page;  ///< what the probe says; null where the page did not load
  std::string log;      ///< what the browser complains of
};

/// Lines of a browser's log that are about the page.
std::string complaints(const std::string& log) {
  std::string found;
  std::istringstream lines(log);
  for (std::string line; std::getline(lines, line);)
    if (line.find("CONSOLE") != std::string::npos || line.find("net::ERR") != std::string::npos)
      found += line + '\n';
  return found;
}

Seen open_in_browser(const test::ScratchFolder& scratch, std::string html) {
  html.insert(html.find("<title>"), kProbe);
  write_text(scratch / "probed.html", html);
  const auto outcome = test::shell(
      scratch.path(),
      kChromium + "--enable-logging=stderr --v=0 --dump-dom \"file://$PWD/probed.html\" >dom.html");
  const std::string dom = test::content(scratch / "dom.html"), start = "<title>PROBE";
  const std::size_t from = dom.find(start), to = dom.find("EBORP</title>");
  Seen seen{nullptr, complaints(outcome.errors)};
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  if (from != std::string::npos && to != std::string::npos)
    seen.page =
        nlohmann::json::parse(dom.substr(from + start.size(), to - from - start.size()), nullptr, false);
  return seen;
}

#define SKIP_WITHOUT_CHROMIUM()                           \
  if (std::system("command -v chromium >/dev/null") != 0) \
  GTEST_SKIP() << "chromium (Debian package chromium) is not installed"

TEST(ReportInBrowser, RendersWithoutErrors) {
  SKIP_WITHOUT_CHROMIUM();
  const test::ScratchFolder scratch;
  diagnosis_report::write_report_folder(scratch / "report", test::planted_diagnosis());
  const Seen seen = open_in_browser(scratch, read_text(scratch / "report" / "report.html"));
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
  const Seen seen = open_in_browser(
      scratch,
      "<!DOCTYPE html><html><head><title>t</title></head><body><img src=\"data:image/png;base64,AAAA\">"
      "<img src=\"beside.png\"><div "
      "style=\"width:3000px\">wide</div><script>nowhere();</script></body></html>");
  ASSERT_TRUE(seen.page.is_object());
  EXPECT_EQ(seen.page["broken"], 2);
  EXPECT_EQ(seen.page["outside"], 1);
  EXPECT_EQ(seen.page["too_wide"], true);
  EXPECT_NE(seen.log.find("nowhere"), std::string::npos);
}

}  // namespace
}  // namespace pendular
