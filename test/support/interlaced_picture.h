#pragma once

#include <opencv2/imgproc.hpp>

namespace uav_landing::test {

/// Two pictures of a moving pattern, the rows of one between those of the other; no shift: one picture.
inline cv::Mat interlaced(int shift, double noise = 1) {
  cv::Mat pattern(120, 200, CV_8UC1);
  cv::RNG random(3);
  random.fill(pattern, cv::RNG::UNIFORM, 0, 256);
  cv::GaussianBlur(pattern, pattern, {}, 1.5);
  cv::normalize(pattern, pattern, 20, 220, cv::NORM_MINMAX);
  cv::Mat grey = pattern(cv::Rect(0, 0, 160, 120)).clone();
  for (int y = 1; y < grey.rows; y += 2) pattern(cv::Rect(shift, y, 160, 1)).copyTo(grey.row(y));
  cv::Mat more(grey.size(), CV_16SC1);
  random.fill(more, cv::RNG::NORMAL, 0, noise);
  cv::add(grey, more, grey, cv::noArray(), CV_8U);
  return grey;
}

/// A noisy grey area as cameras sharpen it: each row minus a share of those above and below.
inline cv::Mat sharpened(double centre) {
  cv::Mat noise(240, 320, CV_32FC1);
  cv::RNG(5).fill(noise, cv::RNG::NORMAL, 128 / (centre - 2), 10 / centre);
  const cv::Mat kernel = (cv::Mat_<float>(3, 1) << -1, centre, -1);
  cv::filter2D(noise, noise, -1, kernel);
  noise.convertTo(noise, CV_8U);
  return noise;
}

}  // namespace uav_landing::test
