#include "uav_landing/image/grey_range.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "base/text.h"

namespace uav_landing {
namespace {

constexpr size_t kFirstPairs = 10;
constexpr int kValues = 65536;
constexpr double kTail = 0.001;          // of the values, on either side
constexpr double kOutside = 0.01;        // of the values, from which on the range is too small
constexpr double kSmallPart = 1.0 / 16;  // of the values that the bits have
constexpr double kMargin = 0.25;         // of what is between the quantiles
constexpr double kFewest = 16;           // values from black to white: fewer are noise

/// How often each value occurs.
cv::Mat histogramOf(const cv::Mat& values) {
  const cv::Mat samples = values.reshape(1);
  const int channels[] = {0}, sizes[] = {kValues};
  const float limits[] = {0, kValues};
  const float* ranges[] = {limits};
  cv::Mat histogram;
  cv::calcHist(&samples, 1, channels, cv::noArray(), histogram, 1, sizes, ranges);
  return histogram;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double largestOf(int bits) { return std::ldexp(1.0, bits) - 1; }

}  // namespace

void GreyRange::toMono8(const cv::Mat& grey, cv::Mat& mono) const {
  const double gain = 255. / (white - black);
  grey.convertTo(mono, CV_8U, gain, -black * gain);
}

std::string toText(const GreyRange& range) {
  return text("values ", std::lround(range.black), " to ", std::lround(range.white),
              " of 65535 become black to white");
}

GreyRangeFinder::GreyRangeFinder(int bits) : known_(bits > 0) {
  if (known_) range_.white = largestOf(bits);
}

const GreyRange& GreyRangeFinder::follow(const cv::Mat& left, const cv::Mat& right) {
  for (const cv::Mat* values : {&left, &right}) {
    if (known_ || values->empty()) continue;
    if (lows_.size() < 2 * kFirstPairs) learn(quantilesOf(*values));
    grow(*values);
  }
  return range_;
}

GreyRangeFinder::Quantiles GreyRangeFinder::quantilesOf(const cv::Mat& values) {
  const cv::Mat histogram = histogramOf(values);
  const double tail = kTail * static_cast<double>(values.total() * values.channels());
  const auto first = [&](int begin, int step) {
    double counted = 0;
    int value = begin;
    while (value + step >= 0 && value + step < kValues && (counted += histogram.at<float>(value)) <= tail)
      value += step;
    return static_cast<double>(value);
  };
  return {first(0, 1), first(kValues - 1, -1)};
}

GreyRange GreyRangeFinder::rangeOf(const Quantiles& seen) {
  int bits = 8;
  while (seen.high > largestOf(bits)) bits += 2;
  const double used = seen.high - seen.low;
  if (used >= kSmallPart * (largestOf(bits) + 1) || used < kFewest) return {0, largestOf(bits)};
  return {std::max(0.0, seen.low - kMargin * used), std::min(largestOf(16), seen.high + kMargin * used)};
}

void GreyRangeFinder::learn(const Quantiles& seen) {
  lows_.push_back(seen.low);
  highs_.push_back(seen.high);
  range_ = rangeOf({median(lows_), median(highs_)});
}

void GreyRangeFinder::grow(const cv::Mat& values) {
  const cv::Mat samples = values.reshape(1);
  const double all = static_cast<double>(samples.total());
  const double above = cv::countNonZero(samples > range_.white) / all;
  const double below = cv::countNonZero(samples < range_.black) / all;
  if (std::max(above, below) <= kOutside) return;
  const Quantiles seen = quantilesOf(values);
  const GreyRange now = rangeOf(seen);
  range_ = {std::min(range_.black, now.black), std::max(range_.white, now.white)};
}

}  // namespace uav_landing
