#include "viz/film.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "planted_run.h"
#include "scratch.h"
#include "viz/render_run.h"

namespace pendular {
namespace {

test::PlantedRun small() {
  test::PlantedRun planted;
  planted.specimen_diameter = 1.2e-3;
  planted.specimen_height = 1.0e-3;
  planted.frames = 3;
  return planted;
}

TEST(Film, IsNumberedAndReplacesALongerOne) {
  const test::ScratchFolder scratch;
  test::write_planted_run(scratch / "run", small());
  for (int k = 0; k < 6; ++k) {
    make_folder(scratch / "out/film");
    write_text(scratch / ("out/film/frame_000" + std::to_string(k) + ".png"), "old");
  }
  viz::RenderOptions options;
  options.view = "shear_strain";
  options.size = options.film_size = {320, 240};
  const auto summary = viz::render_run(scratch / "run", scratch / "out", options);
  for (int k = 0; k < 6; ++k) {
    const fs::path picture = scratch / ("out/film/frame_000" + std::to_string(k) + ".png");
    EXPECT_EQ(fs::exists(picture), k < 3);
    if (k < 3) {
      EXPECT_EQ(read_text(picture).substr(1, 3), "PNG");
    }
  }
  for (const auto& picture : summary.pictures) EXPECT_TRUE(fs::exists(picture.file)) << picture.file;
  EXPECT_TRUE(fs::exists(scratch / "out/stress_strain.png"));
  EXPECT_TRUE(fs::exists(scratch / "out/shear_strain_end.png"));
  EXPECT_TRUE(fs::exists(scratch / "out/shear_strain_peak.png"));
  if (std::system("ffmpeg -version >/dev/null 2>&1") == 0) {
    ASSERT_TRUE(summary.video);
    EXPECT_EQ(read_text(*summary.video).substr(4, 4), "ftyp");
  }
}

TEST(Film, WithoutFfmpegThePicturesAreThereAndAnOldFilmIsNot) {
  const test::ScratchFolder scratch;
  test::write_planted_run(scratch / "run", small());
  write_text(scratch / "film.mp4", "old");
  const RunFolder run = read_run_folder(scratch / "run");
  const viz::Frame first = viz::read_frame(run.frames.front()), last = viz::read_frame(run.frames.back());
  const viz::Display display;
  const std::string path = std::getenv("PATH");
  ::setenv("PATH", scratch.path().c_str(), 1);
  const viz::Film film =
      viz::make_film(display, viz::view_named("displacement"), run.frames,
                     viz::make_stage(first, last, run.result), {0.0, 100.0}, scratch / "film", {160, 120});
  ::setenv("PATH", path.c_str(), 1);
  EXPECT_EQ(film.pictures.size(), 3u);
  EXPECT_TRUE(fs::exists(film.pictures.back()));
  EXPECT_FALSE(film.video);
  EXPECT_FALSE(fs::exists(scratch / "film.mp4"));
}

TEST(Film, SameRunGivesSameBytes) {
  const test::ScratchFolder scratch;
  test::write_planted_run(scratch / "realisation_01", small());
  test::write_planted_run(scratch / "realisation_02", small());
  viz::RenderOptions options;
  options.size = {320, 240};
  options.view = "force_chains";
  options.film = false;
  const auto a = viz::render_run(scratch.path(), scratch / "a", options),
             b = viz::render_run(scratch.path(), scratch / "b", options);
  EXPECT_EQ(a.realisations, 2u);
  ASSERT_EQ(a.pictures.size(), 3u);
  for (std::size_t k = 0; k < a.pictures.size(); ++k)
    EXPECT_EQ(read_text(a.pictures[k].file), read_text(b.pictures[k].file));
}

}  // namespace
}  // namespace pendular
