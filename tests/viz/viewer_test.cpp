#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "base/error.h"
#include "browser.h"
#include "packing/polydata.h"
#include "planted_run.h"
#include "viz/image.h"
#include "viz/report.h"
#include "viz/viewer/run_view.h"

namespace pendular {
namespace {

using viz::run_view;
using viz::to_html;

RunFolder planted(const test::ScratchFolder& scratch, int frames = 4) {
  test::PlantedRun run;
  run.frames = frames;
  test::write_planted_run(scratch / "run", run);
  return read_run_folder(scratch / "run");
}

/// A page with one specimen and one picture.
std::string page_of(const test::ScratchFolder& scratch, const viz::SpecimenView& view) {
  const viz::Image white{64, 64, std::vector<std::uint8_t>(3 * 64 * 64, 255)};
  write_png(scratch / "p.png", white);
  viz::ReportSection section{"h", "", {}, {{scratch / "p.png", "c"}}};
  section.specimens = {view};
  viz::write_report(scratch / "r.html", {"t", "s", {section}, nullptr});
  return read_text(scratch / "r.html");
}

/// Turns, clicks, slides and cuts as a reader does, and counts what is drawn each time.
constexpr const char* kProbe = R"(
  const canvas = document.querySelector("canvas.stage"), gl = canvas.getContext("webgl2");
  const drawn = () => {
    const pixels = new Uint8Array(4 * canvas.width * canvas.height);
    gl.readPixels(0, 0, canvas.width, canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    let inked = 0, sum = 0;
    for (let k = 0; k < pixels.length; k += 4) {
      if (pixels[k] < 250 || pixels[k + 1] < 250 || pixels[k + 2] < 250) ++inked;
      sum = (31 * sum + pixels[k] + 3 * pixels[k + 1] + 7 * pixels[k + 2]) >>> 0;
    }
    return {share: inked / canvas.width / canvas.height, sum};
  };
  const set = (selector, value, event) => {
    const input = document.querySelector(selector);
    input.value = value;
    input.dispatchEvent(new Event(event));
  };
  const numbers = () => [...document.querySelectorAll(".numbers dd")].map(e => e.textContent);
  const seen = {first: drawn(), label: document.querySelector(".label").textContent};
  seen.fields = [...document.querySelectorAll("select.field option")].map(e => e.textContent);
  canvas.setPointerCapture = () => {};
  const box = canvas.getBoundingClientRect();
  const at = {clientX: box.left + box.width / 2, clientY: box.top + box.height / 2, pointerId: 1, buttons: 1};
  canvas.dispatchEvent(new PointerEvent("pointerdown", at));
  canvas.dispatchEvent(new PointerEvent("pointerup", at));
  seen.picked = numbers();
  set(".find", 5, "change");
  seen.found = numbers();
  canvas.dispatchEvent(new PointerEvent("pointerdown", at));
  canvas.dispatchEvent(new PointerEvent("pointermove", {...at, clientX: at.clientX + 80}));
  canvas.dispatchEvent(new PointerEvent("pointerup", {...at, clientX: at.clientX + 80}));
  seen.turned = drawn();
  set(".field", 1, "change");
  seen.coloured = drawn();
  set(".moment", 0, "input");
  seen.slid = drawn();
  seen.slid_label = document.querySelector(".label").textContent;
  set(".section", "y", "change");
  seen.cut = drawn();
  set(".swell", 0, "input");
  seen.bonds = drawn();
  seen.error = gl.getError();
  return seen;)";

TEST(SpecimenView, HasEveryArrayOfTheFramesAndTheUnionOfTheirPairs) {
  const test::ScratchFolder scratch;
  const RunFolder run = planted(scratch);
  const viz::SpecimenView view = run_view(run);
  ASSERT_EQ(view.moments.size(), 4u);
  EXPECT_EQ(view.fields.front().name, "local shear strain");
  std::set<std::string> names;
  for (const auto& field : view.fields) names.insert(field.name + " " + field.unit);
  for (const char* name :
       {"displacement \u00b5m", "displacement along z \u00b5m", "damage ", "coordination ", "broken bonds "})
    EXPECT_TRUE(names.contains(name)) << name;
  const PolyTable last = read_polydata(run.frames.back());
  double broken = 0.0, of_beads = 0.0;
  for (const auto state : integers(last, false, "state", run.frames.back())) broken += state == 1;
  for (const double count : view.moments.back().values.back()) of_beads += count;
  EXPECT_GT(broken, 0.0);
  EXPECT_EQ(of_beads, 2.0 * broken);
  for (const auto& moment : view.moments) {
    EXPECT_EQ(moment.states.size(), view.pairs.size());
    EXPECT_EQ(moment.values.size(), view.fields.size());
  }
  EXPECT_LT(view.fields[0].low, view.fields[0].high);
}

TEST(SpecimenView, TakesFramesEvenlyWhereAPageDoesNotHoldThemAll) {
  const test::ScratchFolder scratch;
  const RunFolder run = planted(scratch, 9);
  const auto all = run_view(run);
  const auto few = run_view(run, 3 * (to_html(all).size() / 9));
  ASSERT_GE(few.moments.size(), 2u);
  ASSERT_LT(few.moments.size(), 9u);
  EXPECT_EQ(few.moments.front().label, all.moments.front().label);
  EXPECT_EQ(few.moments.back().label, all.moments.back().label);
  EXPECT_EQ(run_view(run, 1).moments.size(), 1u);
}

TEST(SpecimenView, AFrameWithOtherBeadsIsBadInput) {
  const test::ScratchFolder scratch;
  const RunFolder run = planted(scratch);
  PolyTable frame = read_polydata(run.frames[1]);
  for (auto& [name, array] : frame.point_data)
    if (name == "bead_id") std::get<std::vector<std::int64_t>>(array)[0] = 999999;
  write_polydata(run.frames[1], frame);
  EXPECT_THROW(run_view(run), BadInput);
}

TEST(SpecimenView, EscapesEveryText) {
  const std::string nasty = "</script><script>alert('x')</script>";
  viz::SpecimenView view;
  view.caption = nasty;
  view.ids = {1};
  view.diameters = {2e-4};
  view.fields = {{nasty, nasty}};
  view.moments = {{nasty, {Vec3::Zero()}, {{1.0}}, {}, {}}};
  const std::string html = to_html(view);
  EXPECT_EQ(html.find("<script>"), std::string::npos);
  EXPECT_EQ(html.find("</script>"), html.rfind("</script>"));
}

TEST(SpecimenInBrowser, DrawsPicksSlidesTurnsAndCuts) {
  SKIP_WITHOUT_CHROMIUM();
  const test::ScratchFolder scratch;
  const viz::SpecimenView view = run_view(planted(scratch));
  const test::Seen seen =
      test::open_in_browser(scratch, page_of(scratch, view), kProbe, "--window-size=700,600");
  EXPECT_EQ(seen.log, "");
  ASSERT_TRUE(seen.page.is_object());
  ASSERT_FALSE(seen.page.contains("error") && seen.page["error"].is_string()) << seen.page["error"];
  EXPECT_EQ(seen.page["error"], 0);
  EXPECT_GT(seen.page["first"]["share"], 0.1);
  EXPECT_LT(seen.page["first"]["share"], 0.9);
  EXPECT_EQ(seen.page["label"], view.moments.back().label);
  EXPECT_EQ(seen.page["slid_label"], view.moments.front().label);
  EXPECT_EQ(seen.page["fields"].size(), view.fields.size());
  const auto sum = [&](const char* name) { return seen.page[name]["sum"].get<std::int64_t>(); };
  EXPECT_NE(sum("turned"), sum("first"));
  EXPECT_NE(sum("coloured"), sum("turned"));
  EXPECT_NE(sum("slid"), sum("coloured"));
  EXPECT_NE(sum("cut"), sum("slid"));
  EXPECT_GT(seen.page["bonds"]["share"], 0.0);
  EXPECT_LT(seen.page["bonds"]["share"], seen.page["cut"]["share"]);
  EXPECT_EQ(seen.page["picked"].size(), 3 + view.fields.size());

  const auto bead =
      static_cast<std::size_t>(std::find(view.ids.begin(), view.ids.end(), 5) - view.ids.begin());
  ASSERT_LT(bead, view.ids.size());
  ASSERT_EQ(seen.page["found"].size(), 3 + view.fields.size());
  EXPECT_EQ(seen.page["found"][0], "5");
  Vec3 at;
  ASSERT_EQ(std::sscanf(seen.page["found"][2].get<std::string>().c_str(), "%lf, %lf, %lf", &at.x(), &at.y(),
                        &at.z()),
            3);
  EXPECT_LT((1e-3 * at - view.moments.back().centres[bead]).norm(), 0.2e-6);
  const double shear = view.moments.back().values[0][bead];
  EXPECT_NEAR(std::stod(seen.page["found"][3].get<std::string>()), shear, 6e-3 * std::fabs(shear));
}

TEST(SpecimenInBrowser, WithoutWebGlOneLineSaysSoAndThePicturesRemain) {
  SKIP_WITHOUT_CHROMIUM();
  const test::ScratchFolder scratch;
  const auto seen =
      test::open_in_browser(scratch, page_of(scratch, run_view(planted(scratch))),
                            "return {note: document.querySelector(\".note\").textContent,"
                            "pictures: [...document.images].filter(p => p.naturalWidth > 0).length};",
                            "--disable-3d-apis");
  ASSERT_TRUE(seen.page.is_object());
  EXPECT_EQ(seen.page["note"], "The specimen cannot be turned here (no WebGL 2); the pictures remain.");
  EXPECT_EQ(seen.page["pictures"], 1);
}

}  // namespace
}  // namespace pendular
