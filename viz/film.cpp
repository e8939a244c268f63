#include "viz/film.h"

#include <algorithm>

#include "base/error.h"
#include "base/interrupt.h"
#include "base/process.h"
#include "base/progress.h"

namespace pendular::viz {
namespace {

std::string picture_name(std::size_t k) {
  return fmt::format("frame_{:04d}.png", k);
}

std::optional<fs::path> make_video(const fs::path& folder, std::size_t pictures, const std::string& comment) {
  const fs::path video = folder.string() + ".mp4";
  // At least ten pictures a second, and no more than about ten seconds of film.
  const std::size_t rate = std::max<std::size_t>(10, pictures / 10);
  try {
    write_atomically(video, [&](const fs::path& temporary) {
      // Its folder's name may hold what the program would take for a pattern or a protocol.
      const int status = run({"ffmpeg",
                              {"-y",
                               "-nostdin",
                               "-framerate",
                               std::to_string(rate),
                               "-start_number",
                               "0",
                               "-i",
                               "frame_%04d.png",
                               "-threads",
                               "1",
                               "-c:v",
                               "libx264",
                               "-crf",
                               "18",
                               "-pix_fmt",
                               "yuv420p",
                               "-movflags",
                               "+faststart",
                               "-fflags",
                               "+bitexact",
                               "-flags:v",
                               "+bitexact",
                               "-metadata",
                               "comment=" + comment,
                               "-f",
                               "mp4",
                               "file:" + fs::absolute(temporary).string()}},
                             {.folder = folder});
      if (status == kCannotBeStarted)
        throw ComputationFailed("no film: ffmpeg not found; the pictures are in " + folder.string());
      if (status != 0)
        throw ComputationFailed(
            fmt::format("no film: ffmpeg ended with {}; the pictures are in {}", status, folder.string()));
    });
  } catch (const ComputationFailed& reason) {
    std::error_code ignored;
    fs::remove(video, ignored);  // of an earlier run: it would not show these pictures
    warn(reason.what());
    return std::nullopt;
  }
  return video;
}

}  // namespace

Film make_film(const Display& display, const View& view, const std::vector<fs::path>& frames,
               const Stage& stage, const ColourRange& range, const fs::path& folder, PictureSize size,
               const std::string& comment) {
  make_inner_folder(folder);
  Film film;
  Progress progress("film", static_cast<double>(frames.size()));
  ScenePainter painter(display, size);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    stop_if_interrupted();
    film.pictures.push_back(folder / picture_name(k));
    write_png(film.pictures.back(), painter.draw(view, read_frame(frames[k]), stage, range), comment);
    progress.update(static_cast<double>(k + 1), fmt::format("picture {} of {}", k + 1, frames.size()));
  }
  for (std::size_t k = frames.size(); fs::exists(folder / picture_name(k)); ++k) {
    remove_output(folder / picture_name(k));
  }
  film.video = make_video(folder, film.pictures.size(), comment);
  return film;
}

}  // namespace pendular::viz
