#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

#include "pipette/codecs.h"

namespace pendular::pipette {
namespace {

struct Reader : VideoReader {
  cv::VideoCapture video;
  bool read(cv::Mat& picture) override { return video.read(picture) && !picture.empty(); }
  double frames() override { return video.get(cv::CAP_PROP_FRAME_COUNT); }
};

struct Writer : VideoWriter {
  cv::VideoWriter video;
  void write(const cv::Mat& picture) override { video.write(picture); }
};

cv::Mat read(const std::string& path) try {
  return cv::imread(path, cv::IMREAD_UNCHANGED);
} catch (const cv::Exception&) {
  return {};
}

bool write(const std::string& path, const cv::Mat& picture) {
  return cv::imwrite(path, picture);
}

std::unique_ptr<VideoReader> open(const std::string& path) {
  auto reader = std::make_unique<Reader>();
  if (!reader->video.open(path, cv::CAP_FFMPEG)) return nullptr;
  return reader;
}

std::unique_ptr<VideoWriter> create(const std::string& path, double frame_rate, cv::Size size) {
  auto writer = std::make_unique<Writer>();
  const int codec = path.ends_with(".avi") ? cv::VideoWriter::fourcc('M', 'J', 'P', 'G')
                                           : cv::VideoWriter::fourcc('m', 'p', '4', 'v');
  if (!writer->video.open(path, cv::CAP_FFMPEG, codec, frame_rate, size)) return nullptr;
  return writer;
}

}  // namespace
}  // namespace pendular::pipette

extern "C" const pendular::pipette::Codecs pendular_image_codecs = {
    pendular::pipette::read, pendular::pipette::write, pendular::pipette::open, pendular::pipette::create};
