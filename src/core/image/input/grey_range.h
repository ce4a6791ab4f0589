#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace uav_landing {

/// The 16-bit values that become black and white.
struct GreyRange {
  double black = 0, white = 65535;

  /// grey: CV_16UC1. White becomes 255.
  void toMono8(const cv::Mat& grey, cv::Mat& mono) const;
  bool operator==(const GreyRange& other) const { return black == other.black && white == other.white; }
  bool operator!=(const GreyRange& other) const { return !(*this == other); }
};
/// For example "values 0 to 1023 of 65535 become black to white".
std::string toText(const GreyRange& range);
/// Message for values that exceed the given bits of a GreyRangeFinder.
std::string exceededText(int bits);

/// Finds the range of values that a camera uses. The camera may have 10, 12 or 14 bits, or be a thermal
/// camera, whose scene needs only a small part of its bits. Both cameras get the same range, so that they
/// stay comparable.
///
/// For each pair, the range reaches from the 0.1 % to the 99.9 % quantile of both images. The median over the
/// first pairs counts. If this range is at least a sixteenth of what its bits can hold, the result is the
/// range of these bits. Otherwise the result is the range plus a quarter of it on both sides.
///
/// From then on the range stays. It grows only when the scene becomes brighter: more than 1 % of an image's
/// values are outside in five consecutive pairs. Images without content (a closed shutter, a broken transfer)
/// do not count.
class GreyRangeFinder {
 public:
  /// bits: used bits, counted from the lowest one; 0: they are found.
  explicit GreyRangeFinder(int bits);

  /// left, right: the values of a pair, CV_16U, any number of channels. Pass an empty image when it has 8
  /// bits or cannot be used.
  const GreyRange& follow(const cv::Mat& left, const cv::Mat& right);
  const GreyRange& range() const { return range_; }
  /// Whether more than 1 % of an image's values were ever beyond the given bits.
  bool exceeded() const { return exceeded_; }
  /// Starts anew, for another recording.
  void reset();

 private:
  struct Quantiles {
    double low, high;
  };
  static Quantiles quantilesOf(const cv::Mat& values);
  static bool hasContent(const Quantiles& seen) { return seen.high - seen.low >= kFewest; }
  static GreyRange rangeOf(const Quantiles& seen);
  void learn(const std::vector<cv::Mat>& images);
  void grow(const std::vector<cv::Mat>& images);

  static constexpr double kFewest = 16;  // values from black to white; a smaller range is noise

  int bits_;
  GreyRange range_;
  std::vector<double> lows_, highs_;  // of the first pairs
  GreyRange wider_;                   // range that fits all pairs of the current row of outside pairs
  int outside_ = 0;                   // outside pairs in a row
  bool exceeded_ = false;
};

}  // namespace uav_landing
