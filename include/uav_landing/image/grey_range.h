#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace uav_landing {

/// Which values of 16 bit become black and white.
struct GreyRange {
  double black = 0, white = 65535;

  /// grey: CV_16UC1. 255 is white.
  void toMono8(const cv::Mat& grey, cv::Mat& mono) const;
  bool operator==(const GreyRange& other) const { return black == other.black && white == other.white; }
  bool operator!=(const GreyRange& other) const { return !(*this == other); }
};
/// For example "values 0 to 1023 of 65535 become black to white".
std::string toText(const GreyRange& range);
/// What to say when a GreyRangeFinder's given bits are exceeded.
std::string exceededText(int bits);

/// Finds the range that a camera of 10, 12 or 14 bits uses, or a thermal camera, of whose bits the scene
/// takes up a small part. One range serves both cameras, so that they remain comparable.
///
/// It is the median over the first pairs of what is between the 0.1 % and the 99.9 % quantile of both images.
/// If that is at least a sixteenth of the values that its bits have, the range is these bits; else it is what
/// is between the quantiles, and a quarter of it on both sides. The range is kept from then on. It grows only
/// where more than 1 % of an image's values are outside in five pairs in a row: the scene has become brighter
/// than the first pairs told. Images without content (a closed shutter, a broken transfer) count nowhere.
class GreyRangeFinder {
 public:
  /// bits: used, from the lowest one on; 0: to be found.
  explicit GreyRangeFinder(int bits);

  /// left, right: the values of a pair, CV_16U, any number of channels. Empty where an image has 8 bit, or
  /// cannot be used.
  const GreyRange& follow(const cv::Mat& left, const cv::Mat& right);
  const GreyRange& range() const { return range_; }
  /// Whether more than 1 % of an image's values were beyond the given bits, once.
  bool exceeded() const { return exceeded_; }
  /// Begins anew, as for another recording.
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

  static constexpr double kFewest = 16;  // values from black to white: fewer are noise

  int bits_;
  GreyRange range_;
  std::vector<double> lows_, highs_;  // of the first pairs
  GreyRange wider_;                   // that all pairs of the row ask for, whose values are outside
  int outside_ = 0;                   // such pairs in a row
  bool exceeded_ = false;
};

}  // namespace uav_landing
