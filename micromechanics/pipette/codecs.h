#pragma once

#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>

// Images and videos in files, by OpenCV. Internal to pipette.

namespace pendular::pipette {

struct VideoReader {
  virtual ~VideoReader() = default;
  virtual bool read(cv::Mat& picture) = 0;  ///< false at the end
  virtual double frames() = 0;              ///< as the file states; may be wrong
};

struct VideoWriter {
  virtual ~VideoWriter() = default;
  virtual void write(const cv::Mat& picture) = 0;
};

/// OpenCV's codecs bring the libraries of GDAL and FFmpeg: 0.2 s and 40 MB of every start, so that they are
/// in a shared object of their own, loaded with the first image.
struct Codecs {
  cv::Mat (*read)(const std::string& path);  ///< as it is in the file; empty where it cannot be read
  bool (*write)(const std::string& path, const cv::Mat& picture);
  std::unique_ptr<VideoReader> (*open)(const std::string& path);  ///< none where it is no video
  /// .avi (Motion JPEG) or .mp4 (MPEG-4), frames per second; none where there is no encoder.
  std::unique_ptr<VideoWriter> (*create)(const std::string& path, double frame_rate, cv::Size size);
};

const Codecs& codecs();

/// Whole or not at all; the name says the format. ComputationFailed where it cannot be written.
void write_picture(const std::string& path, const cv::Mat& picture);

}  // namespace pendular::pipette

extern "C" const pendular::pipette::Codecs pendular_image_codecs;
