#include "viz/report.h"

#include <gtest/gtest.h>

#include <vtkImageData.h>
#include <vtkJPEGReader.h>
#include <vtkNew.h>

#include <regex>

#include "base/error.h"
#include "scratch.h"
#include "viz/html_text.h"
#include "viz/image.h"
#include "viz/thumbnail.h"

namespace pendular {
namespace {

/// A picture of two halves, blue and white.
fs::path picture_in(const test::ScratchFolder& scratch, const std::string& name, int width = 1600) {
  viz::Image image{width, width / 2, {}};
  for (int k = 0; k < width * (width / 2); ++k)
    image.rgb.insert(image.rgb.end(), {static_cast<std::uint8_t>(k % width < width / 2 ? 0 : 255),
                                       static_cast<std::uint8_t>(k % width < width / 2 ? 0 : 255), 255});
  fs::create_directories((scratch / name).parent_path());
  write_png(scratch / name, image);
  return scratch / name;
}

TEST(HtmlText, EncodesAsTheStandardsSay) {
  EXPECT_EQ(viz::base64(""), "");  // RFC 4648, section 10
  EXPECT_EQ(viz::base64("f"), "Zg==");
  EXPECT_EQ(viz::base64("fo"), "Zm8=");
  EXPECT_EQ(viz::base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(viz::base64("\xff\xfe"), "//4=");
  EXPECT_EQ(viz::link_to("a b/\xc3\xa9\"#.png"), "a%20b/%C3%A9%22%23.png");
  EXPECT_EQ(viz::policy_hash(""), "'sha256-47DEQpj8HBSa+/TImW+5JCeuQeRkm5NMpJWZG3hSuFU='");
}

TEST(Thumbnail, IsASmallerJpegOfTheSamePicture) {
  const test::ScratchFolder scratch;
  write_text(scratch / "small.jpg", viz::thumbnail(picture_in(scratch, "p.png"), 200));
  vtkNew<vtkJPEGReader> reader;
  ASSERT_NE(reader->CanReadFile((scratch / "small.jpg").c_str()), 0);
  reader->SetFileName((scratch / "small.jpg").c_str());
  reader->Update();
  vtkImageData* image = reader->GetOutput();
  EXPECT_EQ(image->GetDimensions()[0], 200);
  EXPECT_EQ(image->GetDimensions()[1], 100);
  EXPECT_NEAR(image->GetScalarComponentAsDouble(50, 50, 0, 0), 0.0, 8.0);
  EXPECT_NEAR(image->GetScalarComponentAsDouble(150, 50, 0, 0), 255.0, 8.0);
}

TEST(Report, APictureIsAThumbnailThatOpensItsFileBesideThePage) {
  const test::ScratchFolder scratch;
  viz::Report report{"t",
                     "s",
                     {{"h",
                       "",
                       {},
                       {{picture_in(scratch, "out/in/a b.png"), "below"},
                        {picture_in(scratch, "elsewhere.png"), "elsewhere"}}}},
                     nullptr};
  viz::write_report(scratch / "out" / "r.html", report);
  const std::string html = read_text(scratch / "out" / "r.html");
  EXPECT_NE(html.find("<a href=\"in/a%20b.png\""), std::string::npos);
  EXPECT_EQ(html.find("elsewhere.png"), std::string::npos);
  EXPECT_EQ(html.find("image/png"), std::string::npos);
  EXPECT_LT(html.size(), 60000u);
}

TEST(Report, AnSvgIsEmbeddedWhole) {
  const test::ScratchFolder scratch;
  const std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\"/>";
  write_text(scratch / "p.svg", svg);
  viz::write_report(scratch / "r.html", {"t", "s", {{"h", "", {}, {{scratch / "p.svg", "c"}}}}, nullptr});
  EXPECT_NE(read_text(scratch / "r.html").find("data:image/svg+xml;base64," + viz::base64(svg)),
            std::string::npos);
}

TEST(Report, EscapesEveryTextAndRefersToNothingOutside) {
  const test::ScratchFolder scratch;
  const fs::path picture = picture_in(scratch, "p.png");
  const std::string nasty = "<script src='http://e.org'>&\"</script>";
  viz::Report report{
      nasty, nasty, {{nasty, nasty, {{nasty, nasty, nasty}}, {{picture, nasty}}}}, {{"command", nasty}}};
  viz::write_report(scratch / "r.html", report);
  const std::string html = read_text(scratch / "r.html");
  EXPECT_EQ(html.find("<script"), std::string::npos);
  EXPECT_FALSE(std::regex_search(html, std::regex("(src|href)=[\"'](?!data:|p\\.png)")));
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

TEST(Report, APictureThatIsNoneIsBadInput) {
  const test::ScratchFolder scratch;
  write_text(scratch / "p.png", "x");
  const std::string good = read_text(picture_in(scratch, "good.png", 64));
  for (const std::string& bytes : {std::string("x"), good.substr(0, 20), std::string()}) {
    write_text(scratch / "p.png", bytes);
    EXPECT_THROW(viz::thumbnail(scratch / "p.png", 100), BadInput) << bytes.size();
  }
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
