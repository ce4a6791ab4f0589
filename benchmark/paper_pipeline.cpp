#include "paper_pipeline.h"

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <random>

namespace uav_landing {
namespace benchmark {
namespace {

constexpr int kCorners = 400, kRadius = 5, kTemporalReach = 12;
constexpr double kLargestDisparity = 0.25;  // of the image's width

cv::Rect windowAround(const cv::Point& p) {
  return {p.x - kRadius, p.y - kRadius, 2 * kRadius + 1, 2 * kRadius + 1};
}

/// Place in `area` of the other image where a window looks most alike by the sum of squared differences.
cv::Point bestMatch(const cv::Mat& image, const cv::Point& corner, const cv::Mat& other,
                    const cv::Rect& area) {
  cv::Mat score;
  cv::matchTemplate(other(area), image(windowAround(corner)), score, cv::TM_SQDIFF);
  cv::Point best;
  cv::minMaxLoc(score, nullptr, nullptr, &best);
  return best + area.tl() + cv::Point(kRadius, kRadius);
}

}  // namespace

PaperPipeline::PaperPipeline(const StereoRig& rig, const CameraCalibration& left,
                             const CameraCalibration& right)
    : rig_(rig), left_rectifier_(left), right_rectifier_(right) {}

PaperPipeline::Result PaperPipeline::process(const cv::Mat& left, const cv::Mat& right, double duration) {
  left_rectifier_.rectify(left, left_);
  right_rectifier_.rectify(right, right_);
  const cv::Point2d in_left = vanishingPoint(left_), in_right = vanishingPoint(right_);
  std::vector<cv::Point2f> corners;
  cv::goodFeaturesToTrack(left_, corners, kCorners, 0.001, 4, cv::noArray(), 3, true, 0.04);
  const double H = rig_.cy - 0.5 * (in_left.y + in_right.y);
  Result result;
  if (!last_left_.empty()) {
    const cv::Point2d foe = focusOfExpansion(corners);
    result.approach_angle = std::atan(H / rig_.fy) - std::atan((rig_.cy - foe.y) / rig_.fy);
  }
  result.height = filter(meanHeight(corners, std::atan(H / rig_.fy)), duration);
  left_.copyTo(last_left_);
  return result;
}

cv::Point2d PaperPipeline::vanishingPoint(const cv::Mat& image) {
  constexpr int kIterations = 500;
  constexpr double kTolerance = 3;
  cv::Canny(image, edges_, 40, 110);
  std::vector<cv::Vec2f> lines;
  cv::HoughLines(edges_, lines, 1, CV_PI / 180, std::max(30, image.rows / 8));
  cv::Point2d best(rig_.cx, rig_.cy);
  if (lines.size() < 2) return best;
  std::mt19937 random(1);
  int most = 0;
  for (int i = 0; i < kIterations; ++i) {
    const cv::Vec2f &a = lines[random() % lines.size()], &b = lines[random() % lines.size()];
    const double determinant = std::sin(b[1] - a[1]);
    if (std::abs(determinant) < 0.05) continue;
    const cv::Point2d point((a[0] * std::sin(b[1]) - b[0] * std::sin(a[1])) / determinant,
                            (b[0] * std::cos(a[1]) - a[0] * std::cos(b[1])) / determinant);
    int votes = 0;
    for (const cv::Vec2f& line : lines)
      votes += std::abs(point.x * std::cos(line[1]) + point.y * std::sin(line[1]) - line[0]) < kTolerance;
    if (votes <= most) continue;
    most = votes;
    best = point;
  }
  return best;
}

/// Point nearest to all lines of motion, by least squares.
cv::Point2d PaperPipeline::focusOfExpansion(const std::vector<cv::Point2f>& corners) const {
  cv::Matx22d A = cv::Matx22d::zeros();
  cv::Vec2d b;
  const cv::Rect image(0, 0, left_.cols, left_.rows);
  for (const cv::Point corner : corners) {
    const int reach = kRadius + kTemporalReach;
    const cv::Rect area(corner.x - reach, corner.y - reach, 2 * reach + 1, 2 * reach + 1);
    if ((area & image) != area) continue;
    const cv::Point2d step = corner - bestMatch(left_, corner, last_left_, area);
    const double length = cv::norm(step);
    if (length < 1) continue;
    const cv::Vec2d normal(-step.y / length, step.x / length);
    A += normal * normal.t();
    b += normal * (normal[0] * corner.x + normal[1] * corner.y);
  }
  cv::Vec2d point;
  cv::solve(A, b, point, cv::DECOMP_SVD);
  return {point[0], point[1]};
}

double PaperPipeline::meanHeight(const std::vector<cv::Point2f>& corners, double angle) const {
  const int reach = static_cast<int>(kLargestDisparity * left_.cols);
  double sum = 0;
  int count = 0;
  for (const cv::Point corner : corners) {
    const cv::Rect window = windowAround(corner);
    const int first = std::max(0, window.x - reach);
    if (window.y < 0 || window.x < 0 || window.y + window.height > left_.rows ||
        window.x + window.width > left_.cols)
      continue;
    const cv::Rect area(first, window.y, window.x + window.width - first, window.height);
    const double disparity = corner.x - bestMatch(left_, corner, right_, area).x - rig_.principalOffset();
    if (disparity < 1) continue;
    const double depth = rig_.fb() / disparity, below = depth * (corner.y - rig_.cy) / rig_.fy;
    sum += depth * std::sin(angle) + below * std::cos(angle);
    ++count;
  }
  return count > 0 ? sum / count : 0;
}

double PaperPipeline::filter(double height, double duration) {
  constexpr double kHeightVariance = 0.01, kAcceleration = 1.5;
  if (!started_) {
    started_ = true;
    state_ = {height, 0};
    covariance_ = {kHeightVariance, 0, 0, 25};
    return height;
  }
  const cv::Matx22d F(1, duration, 0, 1);
  const cv::Vec2d G(0.5 * duration * duration, duration);
  state_ = F * state_;
  covariance_ = F * covariance_ * F.t() + kAcceleration * kAcceleration * G * G.t();
  const cv::Vec2d gain =
      cv::Vec2d(covariance_(0, 0), covariance_(1, 0)) / (covariance_(0, 0) + kHeightVariance);
  state_ += gain * (height - state_[0]);
  covariance_ = (cv::Matx22d::eye() - gain * cv::Matx12d(1, 0)) * covariance_;
  return state_[0];
}

}  // namespace benchmark
}  // namespace uav_landing
