#include "faults/lens_effects.h"

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "faults/sensor_effects.h"

namespace uav_landing {
namespace {

/// Multiplies by the share of the light that gets through. sigma: of its edges, which are out of focus, px.
void darken(cv::Mat& image, cv::Mat& cover, double sigma) {
  cv::GaussianBlur(cover, cover, cv::Size(), sigma);
  cv::Mat grey;
  image.convertTo(grey, CV_32F);
  cv::Mat(grey.mul(cover)).convertTo(image, CV_8U);
}

/// Draws a straight arm of this share of light. angle: from upright, rad; length and width: px.
void arm(cv::Mat& cover, const cv::Point2d& foot, double angle, double length, double width, double share) {
  const cv::Point2d end = foot + length * cv::Point2d(std::sin(angle), -std::cos(angle));
  cv::line(cover, foot, end, cv::Scalar(share), static_cast<int>(width));
}

}  // namespace

void blur(cv::Mat& image, double sigma) { cv::GaussianBlur(image, image, cv::Size(), sigma); }

void fogLens(cv::Mat& image, cv::RNG& random) {
  blur(image, 8);
  changeExposure(image, 0.3, 120);
  addNoise(image, 2, random);
}

void condense(cv::Mat& image, double share) {
  if (share <= 0) return;
  blur(image, 6 * share);
  changeExposure(image, 1 - 0.7 * share, 100 * share);
}

void soil(cv::Mat& image, uint64_t seed) {
  cv::RNG random(seed);
  cv::Mat cover(image.size(), CV_32F, cv::Scalar(1));
  for (int i = 0; i < 25; ++i) {
    const cv::Point at(random.uniform(0, image.cols), random.uniform(image.rows / 3, image.rows));
    cv::circle(cover, at, random.uniform(image.cols / 60, image.cols / 20), cv::Scalar(0.25), cv::FILLED);
  }
  darken(image, cover, image.cols / 160.0);
}

void wet(cv::Mat& image, uint64_t seed, double way) {
  cv::RNG random(seed);
  cv::Mat blurred;
  cv::GaussianBlur(image, blurred, cv::Size(), image.cols / 100.0);
  const int top = image.rows / 3;
  for (int i = 0; i < 20; ++i) {
    const int radius = random.uniform(image.cols / 50, image.cols / 16);
    cv::Point at(random.uniform(radius, image.cols - radius), random.uniform(top, image.rows - radius));
    // Large drops run faster. At the lower edge they begin anew.
    const int ran = static_cast<int>(way * 16 * radius / image.cols);
    at.y = top + (at.y - top + ran) % (image.rows - radius - top);
    // A drop is a lens, so it shows its surroundings upside down.
    const cv::Rect box(at.x - radius, at.y - radius, 2 * radius, 2 * radius);
    if ((box & cv::Rect(cv::Point(), image.size())) != box) continue;
    cv::Mat flipped, mask(box.size(), CV_8U, cv::Scalar(0));
    cv::flip(blurred(box), flipped, 0);
    cv::circle(mask, cv::Point(radius, radius), radius - 1, cv::Scalar(255), cv::FILLED);
    flipped.copyTo(image(box), mask);
  }
}

void hitByInsects(cv::Mat& image, uint64_t seed, int count) {
  cv::RNG random(seed);
  cv::Mat cover(image.size(), CV_32F, cv::Scalar(1));
  for (int i = 0; i < count; ++i) {
    const cv::Point at(random.uniform(0, image.cols), random.uniform(image.rows / 4, image.rows));
    const cv::Size axes(random.uniform(image.cols / 30, image.cols / 10), image.cols / 40);
    cv::ellipse(cover, at, axes, random.uniform(0, 180), 0, 360, cv::Scalar(0.15), cv::FILLED);
  }
  darken(image, cover, image.cols / 50.0);
}

void glare(cv::Mat& image) {
  const cv::Point2d sun(0.6 * image.cols, 0.3 * image.rows);
  for (int v = 0; v < image.rows; ++v) {
    uchar* row = image.ptr<uchar>(v);
    for (int u = 0; u < image.cols; ++u) {
      const double r = std::hypot(u - sun.x, v - sun.y) / image.cols;
      row[u] = cv::saturate_cast<uchar>(0.7 * row[u] + 60 + 300 * std::exp(-r / 0.12));
    }
  }
}

void spinPropeller(cv::Mat& image, const cv::Point2d& hub, double angle) {
  cv::Mat cover(image.size(), CV_32F, cv::Scalar(1));
  for (const double blade : {angle, angle + M_PI})
    arm(cover, hub, blade, 1.1 * image.rows, image.cols / 10.0, 0.5);
  darken(image, cover, image.cols / 40.0);
}

void wipe(cv::Mat& image, double angle) {
  cv::Mat cover(image.size(), CV_32F, cv::Scalar(1));
  arm(cover, {0.5 * image.cols, 1.1 * image.rows}, angle, 1.2 * image.rows, image.cols / 25.0, 0.05);
  darken(image, cover, image.cols / 200.0);
}

}  // namespace uav_landing
