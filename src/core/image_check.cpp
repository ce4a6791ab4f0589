#include "uav_landing/image_check.h"

#include <opencv2/imgproc.hpp>
#include <string>

namespace uav_landing {
namespace {

// Standard deviation, in grey levels, below which an image holds nothing.
constexpr double kMinContrast = 1.5;

/// Every so manyth row, without a copy.
cv::Mat someRows(const cv::Mat& all, int step) {
  return cv::Mat((all.rows + step - 1) / step, all.cols, all.type(), all.data, step * all.step);
}

Failure checkImage(const cv::Mat& image, const cv::Mat& mask, const std::string& name) {
  if (image.type() != CV_8UC1 || image.size() != mask.size()) {
    return {Reason::kInputInvalid, name + " rectified image is " + std::to_string(image.cols) + " x " +
                                       std::to_string(image.rows) + ", expected mono8 of " +
                                       std::to_string(mask.cols) + " x " + std::to_string(mask.rows)};
  }
  constexpr int kStep = 4;  // every fourth row tells as much
  cv::Scalar mean, stddev;
  cv::meanStdDev(someRows(image, kStep), mean, stddev, someRows(mask, kStep));
  if (stddev[0] < kMinContrast) {
    return {Reason::kUniformImage,
            name + " image has no contrast, mean grey level " + std::to_string(static_cast<int>(mean[0]))};
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
  const bool repeated = before_.size() == now.size() && before_.type() == now.type() &&
                        cv::norm(now, before_, cv::NORM_INF) == 0;
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
