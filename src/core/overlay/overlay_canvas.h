#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <string>

namespace uav_landing {

namespace colour {
const cv::Scalar kLine(60, 230, 255);        // yellow
const cv::Scalar kDim(205, 175, 135);        // light grey blue
const cv::Scalar kVanishing(255, 120, 255);  // pink
const cv::Scalar kPlane(255, 220, 60);       // cyan
const cv::Scalar kNormal(80, 255, 120);      // green
const cv::Scalar kFoe(60, 80, 255);          // red
const cv::Scalar kText(240, 240, 240);
const cv::Scalar kLabel(170, 160, 150);
const cv::Scalar kPanel(38, 30, 26);
}  // namespace colour

/// An enlarged image that is drawn on in the original's pixels, anti-aliased and to sub-pixel.
class Canvas {
 public:
  /// image: mono8 or BGR8; it is darkened by the factor brightness, so that marks stand out.
  Canvas(const cv::Mat& image, int scale, double brightness);

  void line(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const cv::Scalar& colour, int thickness = 1);
  /// Draws the part of the homogeneous line l.[u v 1] = 0 that is inside the image.
  void infiniteLine(const Eigen::Vector3d& l, const cv::Scalar& colour, int thickness = 1);
  /// radius: pixels of the enlarged image. Filled when thickness is negative.
  void circle(const Eigen::Vector2d& centre, double radius, const cv::Scalar& colour, int thickness = 1);
  /// size: half the length of the arms, pixels of the enlarged image.
  void cross(const Eigen::Vector2d& centre, double size, const cv::Scalar& colour, int thickness = 1);
  /// Outlined text with its lower left corner beside the point, moved to stay inside the image.
  void label(const Eigen::Vector2d& at, const std::string& text, const cv::Scalar& colour);

  const cv::Mat& picture() const { return picture_; }

 private:
  cv::Point fixedPoint(const Eigen::Vector2d& image_point) const;

  cv::Mat picture_;
  int scale_;
};

/// Width of a text in pixels, and a text with its lower left corner at a place. font_scale: as in OpenCV.
int textWidth(const std::string& text, double font_scale);
void drawText(cv::Mat& picture, const cv::Point& at, const std::string& text, double font_scale,
              const cv::Scalar& colour);

}  // namespace uav_landing
