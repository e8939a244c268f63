#include "viz/gnuplot.h"

#include <gtest/gtest.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>

#include <cstdlib>

#include "base/error.h"
#include "scratch.h"
#include "svg.h"
#include "viz/row_plot.h"
#include "viz/series_plot.h"

namespace pendular {
namespace {

/// Rows, an axis, a note and a legend of these words.
viz::Figure figure_of(const std::string& words) {
  return viz::row_figure({{words}, {true}, {{words, {{words, {1.0}}}, {}, {words}}}});
}
viz::Figure series_of(const std::string& words) {
  const viz::Series series{words, {1.0, 2.0}, {1.0, 2.0}};
  return viz::series_figure(std::span(&series, 1), {words}, {words}, {400, 300});
}

TEST(Gnuplot, TakesNoTextForACommand) {
  const test::ScratchFolder scratch;
  const std::string victim = (scratch / "victim").string();
  const std::vector<std::string> nasty = {
      "`touch " + victim + "`",
      "$(touch " + victim + ")",
      "'.system('touch " + victim + "').'",
      "x'\nsystem 'touch " + victim + "'\nplot '",
      "x' ; ! touch " + victim + " ; '",
      "\nEND\n!touch " + victim,
      "< touch " + victim,
      "@ARG0 @victim",
      "back\\",
      "\\",
      "'",
      "''",
      "'; system \"touch " + victim + "\" #",
      "a''; system \"touch " + victim + "\" #",
      "\"; system 'touch " + victim + "' #",
      "\\\"; system 'touch " + victim + "' #",
      "\"",
      "{",
      "}}}",
      "#",
      "%d %s %% %.999f",
      "{/Bold a}^2_3 &{x} ~a{.8-}",
      "keyentry noenhanced",
      "</text></svg><script>alert(1)</script>",
      "a & b &amp; c",
      "\u00b5m \u2013 \u00b0 \u65e5\u672c",
  };
  std::vector<viz::FigureFiles> all;
  for (const std::string& text : nasty)
    for (const viz::Figure& figure : {figure_of(text), series_of(text)})
      all.push_back({figure, {scratch / (std::to_string(all.size()) + ".svg")}});
  viz::write_figures(all);
  EXPECT_FALSE(fs::exists(victim));
  for (const auto& one : all) {
    const std::string svg = read_text(one.files[0]);
    EXPECT_EQ(svg.find("<script"), std::string::npos);
    EXPECT_EQ(svg.find("</svg>"), svg.rfind("</svg>"));
  }
  for (const std::string text : {"`x` @y $z {/Bold a}^2_3 %d '' '12 \\", "</text><b> & &amp;"}) {
    std::size_t said = 0;
    for (const auto& words : test::words(test::svg_of(series_of(text)))) said += words.text == text;
    EXPECT_EQ(said, 3u) << text << ": two axes and the legend";
  }
}

TEST(Gnuplot, TurnsWhatIsNoTextIntoText) {
  const std::string svg =
      test::svg_of(series_of(std::string("a\x01\xff\xc3") + "\xed\xa0\x80" + "b\tc\x1b[31m"));
  EXPECT_NE(svg.find("a??????b c?[31m"), std::string::npos);
}

TEST(Gnuplot, WritesUnderWhateverName) {
  const test::ScratchFolder scratch;
  const fs::path file = scratch / "it's `touch x` \" \\ $y\n%d.svg";
  viz::write_figure(figure_of("words"), {file});
  EXPECT_NE(read_text(file).find("<svg"), std::string::npos);
  EXPECT_FALSE(fs::exists(scratch / "x"));
  EXPECT_THROW(viz::write_figure(figure_of("words"), {scratch / "a.gif"}), BadUsage);
}

TEST(Gnuplot, GivesTheSameBytesEachTime) {
  const test::ScratchFolder scratch;
  for (const char* kind : {".svg", ".pdf", ".png"}) {
    viz::write_figure(figure_of("a"), {scratch / (std::string("a") + kind)}, "comment");
    // Together with others, and in another order.
    viz::write_figures(std::vector<viz::FigureFiles>{{series_of("other"), {scratch / "other.png"}},
                                                     {figure_of("a"), {scratch / (std::string("b") + kind)}}},
                       "comment");
    EXPECT_EQ(read_text(scratch / (std::string("a") + kind)), read_text(scratch / (std::string("b") + kind)))
        << kind;
  }
  EXPECT_NE(read_text(scratch / "a.pdf").find("/CreationDate (D:00000000000000"), std::string::npos);
}

TEST(Gnuplot, PutsTheCommentIntoTheMetadata) {
  const test::ScratchFolder scratch;
  const std::string comment = R"x({"command":"bridge (<a> & \b)"})x";
  viz::write_figure(figure_of("a"), {scratch / "a.svg", scratch / "a.pdf", scratch / "a.png"}, comment);
  const std::string description = R"x(<desc>{"command":"bridge (&lt;a&gt; &amp; \b)"}</desc>)x";
  EXPECT_NE(read_text(scratch / "a.svg").find(description), std::string::npos);

  vtkNew<vtkPNGReader> reader;
  reader->SetFileName((scratch / "a.png").c_str());
  reader->Update();
  EXPECT_EQ(reader->GetErrorCode(), 0u);
  int chunks[2] = {0, 0};
  reader->GetTextChunks("Comment", chunks);
  ASSERT_EQ(chunks[1], chunks[0] + 1);
  EXPECT_EQ(reader->GetTextValue(chunks[0]), comment);

  // The table of the update says where the information is.
  const std::string pdf = read_text(scratch / "a.pdf");
  const auto number_at = [&](std::size_t at) { return std::stoul(pdf.substr(at, 20)); };
  const std::size_t table = number_at(pdf.rfind("startxref\n") + 10);
  ASSERT_EQ(pdf.substr(table, 5), "xref\n");
  const std::size_t object = number_at(pdf.find('\n', table + 5) + 1);
  EXPECT_EQ(number_at(object), number_at(table + 5)) << "its number, as in the table";
  const std::string subject = R"x(/Subject ({"command":"bridge \(<a> & \\b\)"}))x";
  EXPECT_EQ(pdf.find(subject, object), pdf.rfind("/Subject"));
  const std::size_t before = number_at(pdf.rfind("/Prev ") + 6);
  EXPECT_EQ(pdf.substr(before, 5), "xref\n");
}

TEST(Gnuplot, PicturesAreOfTheSizeThatWasAskedFor) {
  const test::ScratchFolder scratch;
  viz::write_figure(series_of("a"), {scratch / "a.png"});
  vtkNew<vtkPNGReader> reader;
  reader->SetFileName((scratch / "a.png").c_str());
  reader->Update();
  const int* extent = reader->GetDataExtent();
  EXPECT_EQ(extent[1] + 1, 400);
  EXPECT_EQ(extent[3] + 1, 300);
}

TEST(Gnuplot, IsTaughtEveryDigit) {
  const viz::Series series{"a", {0.1, 1.0 / 3.0}, {1.0, 2.0}};
  const std::string script = viz::series_figure(std::span(&series, 1), {"x"}, {"y"}).script;
  EXPECT_NE(script.find("0.10000000000000001 1\n0.33333333333333331 2\n"), std::string::npos);
}

TEST(Gnuplot, WhereItIsMissingThePackageIsNamedAndNothingIsWritten) {
  const test::ScratchFolder scratch;
  const std::string path = std::getenv("PATH");
  ::setenv("PATH", scratch.path().c_str(), 1);
  try {
    viz::write_figure(figure_of("a"), {scratch / "a.png"});
    ADD_FAILURE() << "drawn without gnuplot";
  } catch (const ComputationFailed& error) {
    EXPECT_NE(std::string(error.what()).find("package gnuplot-nox"), std::string::npos) << error.what();
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
  }
  ::setenv("PATH", path.c_str(), 1);
  EXPECT_FALSE(fs::exists(scratch / "a.png"));
}

TEST(Gnuplot, AFailureIsOneLineAndLeavesNothing) {
  const test::ScratchFolder scratch;
  try {
    viz::write_figures(std::vector<viz::FigureFiles>{{figure_of("a"), {scratch / "a.png"}},
                                                     {{{400, 300}, "plot nowhere\n"}, {scratch / "b.png"}}});
    ADD_FAILURE() << "a wrong script was drawn";
  } catch (const ComputationFailed& error) {
    EXPECT_NE(std::string(error.what()).find("nowhere"), std::string::npos) << error.what();
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
  }
  EXPECT_FALSE(fs::exists(scratch / "a.png"));
}

}  // namespace
}  // namespace pendular
