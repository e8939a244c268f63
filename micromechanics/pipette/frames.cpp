#include "pipette/frames.h"
#include "base/path_kind.h"

#include <algorithm>
#include <cctype>
#include <opencv2/imgproc.hpp>
#include <set>

#include "base/error.h"
#include "base/own_process.h"
#include "pipette/codecs.h"

namespace pendular::pipette {
namespace {

const std::set<std::string> kImages = {".png", ".tif", ".tiff", ".bmp", ".jpg", ".jpeg", ".pgm", ".pnm"};

struct Numbered {
  long long number;
  fs::path path;
};

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

/// The last run of digits in a file's stem, at most 18 of them.
std::optional<long long> number_of(const fs::path& path) {
  const std::string stem = path.stem().string();
  auto last = stem.find_last_of("0123456789");
  if (last == std::string::npos) return std::nullopt;
  auto first = last;
  while (first > 0 && std::isdigit(static_cast<unsigned char>(stem[first - 1])) && last - first < 17) --first;
  return std::stoll(stem.substr(first, last - first + 1));
}

bool matches(const std::string& name, const std::string& pattern) {
  const auto star = pattern.find('*');
  if (star == std::string::npos) return true;
  const std::string before = pattern.substr(0, star), after = pattern.substr(star + 1);
  return name.size() >= before.size() + after.size() && name.compare(0, before.size(), before) == 0 &&
         name.compare(name.size() - after.size(), after.size(), after) == 0;
}

std::vector<Numbered> numbered_images(const fs::path& folder, const std::string& pattern,
                                      const std::string& said) {
  std::vector<Numbered> images;
  if (!is_folder(folder)) bad_input("{}: no such file or folder", said);
  for (const auto& entry : fs::directory_iterator(folder)) {
    const fs::path& path = entry.path();
    if (!is_file(entry.path()) || !kImages.count(lower(path.extension().string())) ||
        !matches(path.filename().string(), pattern))
      continue;
    const auto number = number_of(path);
    if (!number) bad_input("{}: found no number in the name, expected numbered images", path.string());
    images.push_back({*number, path});
  }
  if (images.empty())
    bad_input("{}: found no images, expected numbered ones (png, tif, bmp, jpg, pgm)", said);
  std::sort(images.begin(), images.end(), [](const Numbered& a, const Numbered& b) {
    return std::tie(a.number, a.path) < std::tie(b.number, b.path);
  });
  for (std::size_t k = 1; k < images.size(); ++k)
    if (images[k].number == images[k - 1].number)
      bad_input("{}: has the number of {}, expected one image per number", images[k].path.string(),
                images[k - 1].path.filename().string());
  return images;
}

GreyImage to_grey(const cv::Mat& picture, const std::string& name) {
  const int depth = picture.depth();
  if (depth != CV_8U && depth != CV_16U) bad_input("{}: expected 8 or 16 bits per channel", name);
  cv::Mat grey = picture;
  if (picture.channels() == 3) cv::cvtColor(picture, grey, cv::COLOR_BGR2GRAY);
  if (picture.channels() == 4) cv::cvtColor(picture, grey, cv::COLOR_BGRA2GRAY);
  GreyImage image(grey.cols, grey.rows);
  const double full = depth == CV_8U ? 255.0 : 65535.0;
  for (int y = 0; y < grey.rows; ++y)
    for (int x = 0; x < grey.cols; ++x)
      image.at(x, y) = (depth == CV_8U ? grey.at<std::uint8_t>(y, x) : grey.at<std::uint16_t>(y, x)) / full;
  return image;
}

}  // namespace

struct FrameSource::State {
  fs::path path, origin;
  std::vector<Numbered> images;  ///< empty for a video
  std::unique_ptr<VideoReader> video;
  std::size_t given = 0;
  int width = 0, height = 0;
};

FrameSource::FrameSource(const fs::path& path) : state_(std::make_unique<State>()) {
  const SilentStandardError silent;  // what cannot be read is reported in one line of our own
  state_->path = state_->origin = path;
  const std::string name = path.filename().string();
  if (name.find('*') != std::string::npos) {
    state_->origin = path.has_parent_path() ? path.parent_path() : fs::path(".");
    state_->images = numbered_images(state_->origin, name, path.string());
    return;
  }
  require_readable(path, true);
  if (is_folder(path)) {
    state_->images = numbered_images(path, "*", path.string());
    return;
  }
  state_->video = codecs().open(path.string());
  if (!state_->video)
    bad_input("{}: cannot be read as a video, expected one, or a folder of numbered images", path.string());
}

FrameSource::~FrameSource() = default;
FrameSource::FrameSource(FrameSource&&) noexcept = default;

std::optional<Frame> FrameSource::next() {
  State& s = *state_;
  Frame frame;
  cv::Mat picture;
  const SilentStandardError silent;
  if (s.images.empty()) {
    if (!s.video->read(picture)) return std::nullopt;
    frame.number = static_cast<long long>(s.given);
    frame.name = fmt::format("{}: frame {}", s.path.string(), s.given);
  } else {
    if (s.given == s.images.size()) return std::nullopt;
    const Numbered& image = s.images[s.given];
    frame.number = image.number;
    frame.name = image.path.string();
    picture = codecs().read(frame.name);
    if (picture.empty()) bad_input("{}: cannot be read as an image", frame.name);
  }
  if (s.given++ == 0) {
    s.width = picture.cols;
    s.height = picture.rows;
  }
  if (picture.cols != s.width || picture.rows != s.height)
    bad_input("{}: found {} x {} pixels, expected {} x {} as in the first frame", frame.name, picture.cols,
              picture.rows, s.width, s.height);
  frame.image = to_grey(picture, frame.name);
  return frame;
}

std::size_t FrameSource::expected() const {
  if (!state_->images.empty()) return state_->images.size();
  return static_cast<std::size_t>(std::max(0.0, state_->video->frames()));
}

std::vector<fs::path> FrameSource::files() const {
  if (state_->images.empty()) return {state_->path};
  std::vector<fs::path> all;
  for (const auto& image : state_->images) all.push_back(image.path);
  return all;
}

fs::path FrameSource::origin() const {
  return state_->origin;
}

}  // namespace pendular::pipette
