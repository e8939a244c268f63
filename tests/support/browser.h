#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "base/files.h"
#include "program.h"
#include "scratch.h"

#define SKIP_WITHOUT_CHROMIUM()                           \
  if (std::system("command -v chromium >/dev/null") != 0) \
  GTEST_SKIP() << "chromium (Debian package chromium) is not installed"

namespace pendular::test {

struct Seen {
  nlohmann::json page;  ///< what the probe says; null where the page did not load
  std::string log;      ///< what the browser complains of
};

/// Lines of a browser's log that are about the page, but for what it says of drawing without a GPU.
inline std::string complaints(const std::string& log) {
  std::string found;
  std::istringstream lines(log);
  for (std::string line; std::getline(lines, line);) {
    const bool of_page =
        line.find("CONSOLE") != std::string::npos || line.find("net::ERR") != std::string::npos;
    if (of_page && line.find("GPU stall due to ReadPixels") == std::string::npos) found += line + '\n';
  }
  return found;
}

/// Loads a page in headless Chromium, WebGL drawn in software. `probe` is JavaScript that runs when all is
/// loaded and returns an object.
inline Seen open_in_browser(const ScratchFolder& scratch, std::string html, const std::string& probe,
                            const std::string& flags = "") {
  // Before the page's policy, which would forbid it.
  const std::size_t head = html.find("<head>") + 6;
  html.insert(head,
              "<script>window.requestAnimationFrame = draw => { draw(performance.now()); return 0; };\n"
              "addEventListener(\"load\", () => { let seen; try { seen = (() => {" +
                  probe +
                  "})(); } catch (error) { seen = {error: String(error.stack)}; }\n"
                  "document.title = \"PROBE\" + JSON.stringify(seen) + \"EBORP\"; });</script>");
  write_text(scratch / "probed.html", html);
  const auto outcome =
      shell(scratch.path(),
            "timeout 240 chromium --headless --no-sandbox --disable-gpu --enable-unsafe-swiftshader "
            "--disable-dev-shm-usage --no-first-run --disable-background-networking --user-data-dir=profile "
            "--window-size=1280,900 --enable-logging=stderr --v=0 " +
                flags + " --dump-dom \"file://$PWD/probed.html\" >dom.html");
  const std::string dom = content(scratch / "dom.html"), start = "<title>PROBE";
  const std::size_t from = dom.find(start), to = dom.find("EBORP</title>");
  Seen seen{nullptr, complaints(outcome.errors)};
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  if (from == std::string::npos || to == std::string::npos) return seen;
  std::string text = dom.substr(from + start.size(), to - from - start.size());
  for (const auto& [code, sign] : {std::pair("&lt;", "<"), std::pair("&gt;", ">"), std::pair("&amp;", "&")})
    for (std::size_t at = text.find(code); at != std::string::npos; at = text.find(code, at + 1))
      text.replace(at, std::string(code).size(), sign);
  seen.page = nlohmann::json::parse(text, nullptr, false);
  return seen;
}

}  // namespace pendular::test
