#include "overlay/overlay_canvas.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace uav_landing {
namespace {

constexpr int kShift = 4;         // OpenCV draws at 1/16 pixel
constexpr double kFarAway = 1e6;  // pixels; beyond it fixed-point coordinates would overflow
constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;

}  // namespace

Canvas::Canvas(const cv::Mat& image, int scale, double brightness) : scale_(scale) {
  cv::Mat enlarged, dimmed;
  cv::resize(image, enlarged, cv::Size(), scale, scale, scale > 1 ? cv::INTER_CUBIC : cv::INTER_NEAREST);
  enlarged.convertTo(dimmed, -1, brightness);
  if (dimmed.channels() == 1) {
    cv::cvtColor(dimmed, picture_, cv::COLOR_GRAY2BGR);
  } else {
    picture_ = dimmed;
  }
}

cv::Point Canvas::fixedPoint(const Eigen::Vector2d& image_point) const {
  // The middle of an image pixel is the middle of its enlarged square.
  const Eigen::Array2d picture_point =
      ((image_point.array() + 0.5) * scale_ - 0.5).cwiseMax(-kFarAway).cwiseMin(kFarAway);
  const Eigen::Array2d fixed = picture_point * (1 << kShift);
  return {static_cast<int>(std::lround(fixed.x())), static_cast<int>(std::lround(fixed.y()))};
}

void Canvas::line(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const cv::Scalar& colour,
                  int thickness) {
  if (!a.allFinite() || !b.allFinite()) return;
  cv::line(picture_, fixedPoint(a), fixedPoint(b), colour, thickness, cv::LINE_AA, kShift);
}

void Canvas::infiniteLine(const Eigen::Vector3d& l, const cv::Scalar& colour, int thickness) {
  const double norm = l.head<2>().norm();
  if (!l.allFinite() || norm == 0) return;
  const Eigen::Vector2d normal = l.head<2>() / norm;
  const Eigen::Vector2d along(-normal.y(), normal.x());
  const Eigen::Vector2d middle = 0.5 * Eigen::Vector2d(picture_.cols, picture_.rows) / scale_;
  const Eigen::Vector2d foot = middle - (normal.dot(middle) + l.z() / norm) * normal;
  const double reach = middle.norm() * 2;
  if ((foot - middle).norm() > reach) return;
  line(foot - reach * along, foot + reach * along, colour, thickness);
}

void Canvas::circle(const Eigen::Vector2d& centre, double radius, const cv::Scalar& colour, int thickness) {
  if (!centre.allFinite()) return;
  const int fixed_radius = static_cast<int>(std::lround(radius * (1 << kShift)));
  cv::circle(picture_, fixedPoint(centre), fixed_radius, colour, thickness, cv::LINE_AA, kShift);
}

void Canvas::cross(const Eigen::Vector2d& centre, double size, const cv::Scalar& colour, int thickness) {
  const double arm = size / scale_;
  line(centre - Eigen::Vector2d(arm, 0), centre + Eigen::Vector2d(arm, 0), colour, thickness);
  line(centre - Eigen::Vector2d(0, arm), centre + Eigen::Vector2d(0, arm), colour, thickness);
}

void Canvas::label(const Eigen::Vector2d& at, const std::string& text, const cv::Scalar& colour) {
  if (!at.allFinite()) return;
  constexpr double kFontScale = 0.42;
  constexpr int kMargin = 4, kHeight = 12;
  const cv::Point beside = fixedPoint(at) / (1 << kShift) + cv::Point(9, -7);
  const cv::Point place(
      std::clamp(beside.x, kMargin, std::max(kMargin, picture_.cols - textWidth(text, kFontScale) - kMargin)),
      std::clamp(beside.y, kHeight, std::max(kHeight, picture_.rows - kMargin)));
  cv::putText(picture_, text, place, kFont, kFontScale, cv::Scalar::all(0), 3, cv::LINE_AA);
  drawText(picture_, place, text, kFontScale, colour);
}

int textWidth(const std::string& text, double font_scale) {
  return cv::getTextSize(text, kFont, font_scale, 1, nullptr).width;
}

void drawText(cv::Mat& picture, const cv::Point& at, const std::string& text, double font_scale,
              const cv::Scalar& colour) {
  cv::putText(picture, text, at, kFont, font_scale, colour, font_scale > 0.8 ? 2 : 1, cv::LINE_AA);
}

}  // namespace uav_landing
