#include "uav_landing/overlay/overlay.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "overlay/instrument_strip.h"
#include "overlay/overlay_canvas.h"
#include "uav_landing/geometry/ground_plane.h"

namespace uav_landing {
namespace {

constexpr double kBrightness = 0.75;
constexpr size_t kMostJoined = 60;  // matches joined by a line; more would hide the image

/// Colour per point: disparity from 0 (blue, far) to the largest one on the plane (red, near).
std::vector<cv::Scalar> disparityColours(const std::vector<StereoDepthResult::Point>& points) {
  double largest = 0;
  for (const auto& point : points) {
    if (point.on_plane) largest = std::max(largest, point.disparity);
  }
  cv::Mat levels(1, static_cast<int>(points.size()), CV_8U), colours;
  for (int i = 0; i < levels.cols; ++i) {
    levels.at<uchar>(i) = cv::saturate_cast<uchar>(largest > 0 ? 255 * points[i].disparity / largest : 0);
  }
  std::vector<cv::Scalar> result(points.size(), colour::kDim);
  if (points.empty()) return result;
  cv::applyColorMap(levels, colours, cv::COLORMAP_TURBO);
  for (size_t i = 0; i < points.size(); ++i) {
    if (points[i].on_plane) result[i] = cv::Scalar(colours.at<cv::Vec3b>(static_cast<int>(i)));
  }
  return result;
}

void drawLines(Canvas& canvas, const std::vector<ApproachAngleResult::Line>& lines) {
  for (const bool inliers : {false, true}) {  // inliers last, so that they are on top
    for (const auto& line : lines) {
      if (line.inlier == inliers)
        canvas.line(line.a, line.b, inliers ? colour::kLine : colour::kDim, inliers ? 2 : 1);
    }
  }
}

void drawPoints(Canvas& canvas, const std::vector<StereoDepthResult::Point>& points) {
  const std::vector<cv::Scalar> colours = disparityColours(points);
  for (size_t i = 0; i < points.size(); ++i) {
    canvas.circle({points[i].u, points[i].v}, points[i].on_plane ? 2.5 : 1.5, colours[i],
                  points[i].on_plane ? cv::FILLED : 1);
  }
}

void drawHorizons(Canvas& canvas, const StereoRig& rig, const StereoDepthResult& stereo,
                  const ApproachAngleResult& approach) {
  if (stereo.plane.valid()) canvas.infiniteLine(horizonLine(rig, stereo.plane.normal()), colour::kPlane, 2);
  if (approach.n.allFinite()) canvas.infiniteLine(horizonLine(rig, approach.n), colour::kNormal, 1);
}

void drawVanishingPoint(Canvas& canvas, const StereoRig& rig, const Eigen::Vector3d& direction) {
  if (!direction.allFinite() || direction.z() <= 0) return;
  const Eigen::Vector2d point = rig.project(direction);
  canvas.circle(point, 7, colour::kVanishing, 2);
  canvas.label(point, "VP", colour::kVanishing);
}

void drawFoe(Canvas& canvas, const Eigen::Vector2d& foe) {
  canvas.cross(foe, 10, colour::kFoe, 2);
  canvas.label(foe, "FOE", colour::kFoe);
}

cv::Mat stacked(const cv::Mat& picture, const cv::Mat& strip) {
  cv::Mat both;
  cv::vconcat(picture, strip, both);
  return both;
}

}  // namespace

int overlayScale(int width, const OverlayParameters& parameters) {
  constexpr int kReadableWidth = 640;
  if (parameters.scale > 0) return parameters.scale;
  return std::max(1, (kReadableWidth + width - 1) / width);
}

cv::Mat drawOverlay(const StereoRig& rig, const cv::Mat& left, const PairFindings& found,
                    const OverlayParameters& parameters) {
  const auto& [stereo, approach, landing] = found;
  Canvas canvas(left, overlayScale(left.cols, parameters), kBrightness);
  drawPoints(canvas, stereo.points);
  drawLines(canvas, approach.left.lines);
  drawHorizons(canvas, rig, stereo, approach);
  drawVanishingPoint(canvas, rig, approach.vanishing_direction);
  drawFoe(canvas, approach.foe);
  return stacked(canvas.picture(), drawInstrumentStrip(landing, canvas.picture().cols));
}

cv::Mat drawLines(const cv::Mat& image, const ApproachAngleResult::View& view,
                  const OverlayParameters& parameters) {
  Canvas canvas(image, overlayScale(image.cols, parameters), kBrightness);
  drawLines(canvas, view.lines);
  return canvas.picture();
}

cv::Mat drawMatches(const StereoRig& rig, const cv::Mat& left, const cv::Mat& right,
                    const StereoDepthResult& stereo, const OverlayParameters& parameters) {
  cv::Mat side_by_side;
  cv::hconcat(left, right, side_by_side);
  Canvas canvas(side_by_side, overlayScale(left.cols, parameters), kBrightness);
  const std::vector<cv::Scalar> colours = disparityColours(stereo.points);
  const size_t step = 1 + stereo.points.size() / kMostJoined;
  for (size_t i = 0; i < stereo.points.size(); ++i) {
    const StereoDepthResult::Point& point = stereo.points[i];
    const Eigen::Vector2d in_left(point.u, point.v);
    const Eigen::Vector2d in_right(left.cols + point.u - point.disparity - rig.principalOffset(), point.v);
    if (i % step == 0) canvas.line(in_left, in_right, colours[i] * 0.5);
    canvas.circle(in_left, 2.5, colours[i]);
    canvas.circle(in_right, 2.5, colours[i]);
  }
  return canvas.picture();
}

}  // namespace uav_landing
