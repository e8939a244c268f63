#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <vector>

// Reads what pictures show. Colours are blue, green, red, as OpenCV has them.

namespace pendular::test {

/// A picture as it was written, in colour.
inline cv::Mat picture(const std::filesystem::path& path) {
  const cv::Mat image = cv::imread(path.string(), cv::IMREAD_COLOR);
  EXPECT_FALSE(image.empty()) << path << " is no picture";
  return image.empty() ? cv::Mat(1, 1, CV_8UC3, cv::Scalar(0, 0, 0)) : image;
}

inline bool alike(const cv::Vec3b& a, const cv::Vec3b& b, int tolerance) {
  return std::abs(a[0] - b[0]) <= tolerance && std::abs(a[1] - b[1]) <= tolerance &&
         std::abs(a[2] - b[2]) <= tolerance;
}

/// The pixels of a colour.
inline std::vector<cv::Point2f> pixels_of(const cv::Mat& image, const cv::Vec3b& colour, int tolerance = 0) {
  std::vector<cv::Point2f> found;
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.cols; ++x)
      if (alike(image.at<cv::Vec3b>(y, x), colour, tolerance))
        found.emplace_back(static_cast<float>(x), static_cast<float>(y));
  return found;
}

/// Whether a pixel of the colour is no more than one pixel away.
inline bool shows(const cv::Mat& image, double x, double y, const cv::Vec3b& colour, int tolerance) {
  for (int row = static_cast<int>(std::lround(y)) - 1; row <= std::lround(y) + 1; ++row)
    for (int column = static_cast<int>(std::lround(x)) - 1; column <= std::lround(x) + 1; ++column)
      if (row >= 0 && column >= 0 && row < image.rows && column < image.cols &&
          alike(image.at<cv::Vec3b>(row, column), colour, tolerance))
        return true;
  return false;
}

/// Share of the pixels that differ from that in the upper left corner.
inline double drawn_share(const cv::Mat& image) {
  const auto paper = pixels_of(image, image.at<cv::Vec3b>(0, 0), 8).size();
  return 1.0 - static_cast<double>(paper) / static_cast<double>(image.total());
}

}  // namespace pendular::test
