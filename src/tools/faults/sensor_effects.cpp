#include "faults/sensor_effects.h"

#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace uav_landing {

void changeExposure(cv::Mat& image, double gain, double offset) {
  image.convertTo(image, CV_8U, gain, offset);
}

void smear(cv::Mat& image, int pixels) {
  cv::Mat smeared;
  cv::blur(image, smeared, cv::Size(pixels, 1));
  image = smeared;
}

void addNoise(cv::Mat& image, double sigma, cv::RNG& random) {
  cv::Mat noise(image.size(), CV_16S), sum;
  random.fill(noise, cv::RNG::NORMAL, 0, sigma);
  cv::add(image, noise, sum, cv::noArray(), CV_8U);
  image = sum;
}

void band(cv::Mat& image, double phase) {
  for (int v = 0; v < image.rows; ++v) {
    const double gain = 1 + 0.35 * std::sin(2 * M_PI * (6.0 * v / image.rows) + phase);
    cv::Mat row = image.row(v);
    row.convertTo(row, CV_8U, gain);
  }
}

void night(cv::Mat& image, uint64_t seed) {
  cv::RNG random(seed);
  changeExposure(image, 0.04, 2);
  addNoise(image, 2, random);
}

void killRows(cv::Mat& image, uint64_t seed) {
  cv::RNG random(seed);
  for (int i = 0; i < 4; ++i) image.row(random.uniform(0, image.rows)).setTo(i % 2 == 0 ? 0 : 255);
}

void stickPixels(cv::Mat& image, uint64_t seed) {
  cv::RNG random(seed);
  constexpr double kOffset = 4, kStuck = 0.005;  // grey levels, 1 sigma; share of the pixels
  for (int u = 0; u < image.cols; ++u) {
    cv::Mat column = image.col(u);
    column += cv::Scalar(random.gaussian(kOffset));
  }
  for (int i = 0; i < kStuck * static_cast<double>(image.total()); ++i)
    image.at<uchar>(random.uniform(0, image.rows), random.uniform(0, image.cols)) =
        static_cast<uchar>(random.uniform(0, 256));
}

void compress(cv::Mat& image, int quality) {
  std::vector<uchar> data;
  cv::imencode(".jpg", image, data, {cv::IMWRITE_JPEG_QUALITY, quality});
  image = cv::imdecode(data, cv::IMREAD_GRAYSCALE);
}

void leaveGhost(cv::Mat& image, const cv::Mat& before, const cv::Mat& lost) {
  cv::Mat change, ghost;
  cv::subtract(image, lost, change, cv::noArray(), CV_16S);
  cv::add(before, change, ghost, cv::noArray(), CV_8U);
  image = ghost;
}

void tear(cv::Mat& image, const cv::Mat& before, int rows) {
  before.rowRange(0, rows).copyTo(image.rowRange(0, rows));
}

}  // namespace uav_landing
