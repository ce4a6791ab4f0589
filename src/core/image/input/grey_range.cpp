#include "image/input/grey_range.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "base/text.h"
#include "estimation/robust.h"

namespace uav_landing {
namespace {

constexpr size_t kFirstPairs = 10;
constexpr int kValues = 65536;
constexpr double kTail = 0.001;          // share of the values, on either side
constexpr double kOutside = 0.01;        // share of the values; with more outside, the range is too small
constexpr double kSmallPart = 1.0 / 16;  // share of the values that the bits can have
constexpr double kMargin = 0.25;         // of the distance between the quantiles
constexpr int kPairsToGrow = 5;          // consecutive pairs outside the range

/// Number of pixels with each value.
cv::Mat histogramOf(const cv::Mat& values) {
  const cv::Mat samples = values.reshape(1);
  const int channels[] = {0}, sizes[] = {kValues};
  const float limits[] = {0, kValues};
  const float* ranges[] = {limits};
  cv::Mat histogram;
  cv::calcHist(&samples, 1, channels, cv::noArray(), histogram, 1, sizes, ranges);
  return histogram;
}

double largestOf(int bits) { return std::ldexp(1.0, bits) - 1; }

/// Share of the values above the range or below it, whichever is larger. values: one channel.
double outsideOf(const GreyRange& range, const cv::Mat& values) {
  const double all = static_cast<double>(values.total());
  return std::max(cv::countNonZero(values > range.white), cv::countNonZero(values < range.black)) / all;
}

GreyRange unionOf(const GreyRange& a, const GreyRange& b) {
  return {std::min(a.black, b.black), std::max(a.white, b.white)};
}

}  // namespace

void GreyRange::toMono8(const cv::Mat& grey, cv::Mat& mono) const {
  const double gain = 255. / (white - black);
  grey.convertTo(mono, CV_8U, gain, -black * gain);
}

std::string toText(const GreyRange& range) {
  return text("values ", std::lround(range.black), " to ", std::lround(range.white),
              " of 65535 become black to white");
}

std::string exceededText(int bits) {
  return text("rig/bits: ", bits, ": more than 1 % of an image's values are above ",
              std::lround(largestOf(bits)),
              " and become white: there are more bits, or they do not begin at the lowest one; with 0 the "
              "range is found");
}

GreyRangeFinder::GreyRangeFinder(int bits) : bits_(bits) { reset(); }

void GreyRangeFinder::reset() {
  range_ = {};
  if (bits_ > 0) range_.white = largestOf(bits_);
  lows_.clear();
  highs_.clear();
  outside_ = 0;
}

const GreyRange& GreyRangeFinder::follow(const cv::Mat& left, const cv::Mat& right) {
  std::vector<cv::Mat> images;
  for (const cv::Mat* values : {&left, &right})
    if (!values->empty()) images.push_back(values->reshape(1));
  if (images.empty()) return range_;
  if (bits_ > 0) {
    exceeded_ = exceeded_ || std::any_of(images.begin(), images.end(), [&](const cv::Mat& values) {
                  return outsideOf(range_, values) > kOutside;
                });
  } else if (lows_.size() < kFirstPairs) {
    learn(images);
  } else {
    grow(images);
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
  if (used >= kSmallPart * (largestOf(bits) + 1)) return {0, largestOf(bits)};
  return {std::max(0.0, seen.low - kMargin * used), std::min(largestOf(16), seen.high + kMargin * used)};
}

void GreyRangeFinder::learn(const std::vector<cv::Mat>& images) {
  Quantiles both{kValues, 0};
  for (const cv::Mat& values : images) {
    const Quantiles seen = quantilesOf(values);
    if (hasContent(seen)) both = {std::min(both.low, seen.low), std::max(both.high, seen.high)};
  }
  if (!hasContent(both)) return;
  lows_.push_back(both.low);
  highs_.push_back(both.high);
  range_ = rangeOf({medianOf(lows_), medianOf(highs_)});
}

void GreyRangeFinder::grow(const std::vector<cv::Mat>& images) {
  GreyRange now = range_;
  for (const cv::Mat& values : images) {
    if (outsideOf(range_, values) <= kOutside) continue;
    const Quantiles seen = quantilesOf(values);
    if (hasContent(seen)) now = unionOf(now, rangeOf(seen));
  }
  if (now == range_) {
    outside_ = 0;
    return;
  }
  wider_ =
      outside_ == 0 ? now : GreyRange{std::max(wider_.black, now.black), std::min(wider_.white, now.white)};
  if (++outside_ < kPairsToGrow) return;
  range_ = wider_;
  outside_ = 0;
}

}  // namespace uav_landing
