#include "image/input/image_check.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <opencv2/imgproc.hpp>
#include <string>

namespace uav_landing {
namespace {

// Smallest standard deviation, in grey levels, of an image that shows something.
constexpr double kMinContrast = 1.5;

/// Every step-th row, without a copy.
cv::Mat someRows(const cv::Mat& all, int step) {
  return cv::Mat((all.rows + step - 1) / step, all.cols, all.type(), all.data, step * all.step);
}

struct Sums {
  double count = 0, grey = 0, squares = 0;

  double mean() const { return grey / std::max(count, 1.0); }
  /// Sum of the squared distances from the mean.
  double deviation() const { return squares - grey * mean(); }
};

/// Adds those pixels of a row whose mask is not 0 (it is 255).
void addRow(const uchar* row, const uchar* mask, int columns, Sums& sums) {
  std::uint32_t count = 0, grey = 0, squares = 0;
  for (int u = 0; u < columns; ++u) {
    const std::uint32_t value = row[u] & mask[u];
    count += mask[u] & 1U;
    grey += value;
    squares += value * value;
  }
  sums.count += count;
  sums.grey += grey;
  sums.squares += squares;
}

/// Whether the grey levels inside the mask have the smallest standard deviation; if not, mean is set. More
/// rows only add to the sum of squares, so the first rows are mostly enough.
bool hasContrast(const cv::Mat& image, const cv::Mat& mask, double& mean) {
  Sums sums;
  const double enough = kMinContrast * kMinContrast * static_cast<double>(image.total());
  for (int v = 0; v < image.rows; ++v) {
    addRow(image.ptr<uchar>(v), mask.ptr<uchar>(v), image.cols, sums);
    if (sums.deviation() >= enough) return true;
  }
  mean = sums.mean();
  return sums.count > 0 && sums.deviation() >= kMinContrast * kMinContrast * sums.count;
}

Failure checkImage(const cv::Mat& image, const cv::Mat& mask, const std::string& name) {
  if (image.type() != CV_8UC1 || image.size() != mask.size()) {
    return {Reason::kInputInvalid, name + " rectified image is " + std::to_string(image.cols) + " x " +
                                       std::to_string(image.rows) + ", expected mono8 of " +
                                       std::to_string(mask.cols) + " x " + std::to_string(mask.rows)};
  }
  constexpr int kStep = 4;  // every fourth row tells as much
  double mean = 0;
  if (!hasContrast(someRows(image, kStep), someRows(mask, kStep), mean)) {
    return {Reason::kUniformImage,
            name + " image has no contrast, mean grey level " + std::to_string(static_cast<int>(mean))};
  }
  return {};
}

}  // namespace

Failure checkPair(const RigModel& model, const cv::Mat& left, const cv::Mat& right) {
  const Failure failure = checkImage(left, model.left_mask, "left");
  return failure ? failure : checkImage(right, model.right_mask, "right");
}

bool RepeatedImage::check(const cv::Mat& image) {
  constexpr int kStep = 8;
  const cv::Mat now = someRows(image, kStep);
  bool repeated = before_.size() == now.size() && before_.type() == now.type();
  for (int v = 0; repeated && v < now.rows; ++v)
    repeated = std::memcmp(now.ptr(v), before_.ptr(v), now.cols * now.elemSize()) == 0;
  now.copyTo(before_);
  return repeated;
}

cv::Mat erodeMask(const cv::Mat& mask, int margin) {
  cv::Mat result;
  const cv::Mat kernel = cv::getStructuringElement(cv::MORPH_RECT, cv::Size(2 * margin + 1, 2 * margin + 1));
  cv::erode(mask, result, kernel, cv::Point(-1, -1), 1, cv::BORDER_CONSTANT, cv::Scalar(0));
  return result;
}

}  // namespace uav_landing
