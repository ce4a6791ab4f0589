#include "stereo/matching/corner_matching.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "base/thinned.h"
#include "base/touch_ahead.h"
#include "geometry/half_plane.h"
#include "image/input/image_check.h"
#include "stereo/matching/row_matching.h"
#include "stereo/matching/row_refinement.h"
#include "stereo/matching/shift_model.h"

namespace uav_landing {
namespace {

// Columns scored on both sides in the full-size pass, where the plane is known to about a pixel.
constexpr int kFineSteps = 3;
// Error of a match in pixels that neighbouring windows share or that residuals do not show.
constexpr double kStddevFloor = 0.03;
// 1 sigma in pixels of a match that comes from a parabola through three scores only.
constexpr double kParabolaStddev = 0.15;

// Matches one corner within some steps of its predicted place.
class CornerMatcher {
 public:
  CornerMatcher(const StereoLevel& level, const PlaneVector& g, const StereoDepthParameters& parameters,
                int steps)
      : level_(level),
        parameters_(parameters),
        shift_(level.rig, g, level.drift),
        steps_(steps),
        forward_(level.left, level.right, parameters.window_radius, parameters.matching_cost),
        backward_(level.right, level.left, parameters.window_radius, parameters.matching_cost),
        forward_warp_(parameters.warp_window ? shift_.forward() : RowWarp{}),
        backward_warp_(parameters.warp_window ? shift_.backward() : RowWarp{}) {}

  // Touches the right mask at the predicted place, so that it is in the cache when it is needed.
  void touch(int u, int v) const { touchPixel(level_.right_mask, u - shift_.at(u, v), v); }

  // Column in the right image and its stddev. Not converged when no match can be trusted. across: also find
  // the place when the row may move.
  RowRefinement match(int u, int v, bool across) {
    const double predicted = u - shift_.at(u, v);
    if (!forward_.run(u, v, predicted, steps_, forward_warp_)) return {};
    double second = 0;
    const RowCandidate best = forward_.best(&second);
    if (best.score < parameters_.min_zncc || second > parameters_.uniqueness * best.score) return {};
    // At the end of the range nothing shows whether the score falls again, so this may be no peak.
    if (std::abs(best.position - predicted) > (steps_ - 0.5) * forward_warp_.scale) return {};
    if (!isSet(level_.right_mask, best.position, v) || !agreesBackward(u, v, best.position)) return {};
    return subpixel(u, v, best.position, across);
  }

 private:
  bool agreesBackward(int u, int v, double found) {
    const int column = cvRound(found);
    const double expected = u + backward_warp_.scale * (column - found);
    if (!backward_.run(column, v, expected, steps_, backward_warp_)) return false;
    const RowCandidate back = backward_.best(nullptr);
    return std::abs(back.position - expected) <= parameters_.left_right_tolerance;
  }

  RowRefinement subpixel(int u, int v, double found, bool across) {
    if (!parameters_.warp_window) {
      RowRefinement parabola;
      parabola.converged = true;
      parabola.position = found;
      parabola.stddev = kParabolaStddev;
      return parabola;
    }
    RowRefinement refined = refineAlongRow(level_.left, level_.right, {u, v, parameters_.window_radius},
                                           {found, forward_warp_}, across);
    refined.converged &= refined.score >= parameters_.min_zncc;
    refined.stddev = std::hypot(refined.stddev, kStddevFloor);
    return refined;
  }

  const StereoLevel& level_;
  const StereoDepthParameters& parameters_;
  ShiftModel shift_;
  int steps_;
  RowSearch forward_, backward_;
  RowWarp forward_warp_, backward_warp_;
};

// The part of the image in which both cameras see the plane: half planes a u + b v + c >= 0.
struct GroundLimits {
  std::array<Eigen::Vector3d, 3> sides;

  GroundLimits(const StereoLevel& level, const PlaneVector& g) {
    // Ground with a smaller disparity (pixels) is too near the horizon to tell the height.
    constexpr double kLeastDisparity = 0.3;
    const ShiftModel shift(level.rig, g);
    sides[0] = {shift.a, shift.b, shift.c - level.rig.principalOffset() - kLeastDisparity};
    // The place in the right image must be inside it: 0 <= u - shift <= cols - 1.
    sides[1] = {1 - shift.a, -shift.b, -shift.c};
    sides[2] = {shift.a - 1, shift.b, shift.c + level.left_mask.cols - 1};
  }
  bool hold(const cv::Point& pixel) const {
    const Eigen::Vector3d place(pixel.x, pixel.y, 1);
    return std::all_of(sides.begin(), sides.end(),
                       [&](const Eigen::Vector3d& side) { return side.dot(place) >= 0; });
  }
};

}  // namespace

std::vector<cv::Point> findGroundCorners(const StereoLevel& level, const PlaneVector& g, int count,
                                         const StereoDepthParameters& parameters,
                                         GroundCornerMemory& memory) {
  cv::Mat mask = level.left_mask, kept = memory.ground.image(mask.size());
  for (const Eigen::Vector3d& side : GroundLimits(level, g).sides) {
    keepHalfPlane(mask, side.x(), side.y(), side.z(), kept);
    mask = kept;
  }
  return findCorners(level.left, mask,
                     {count, parameters.corner_quality, parameters.min_corner_distance, parameters.harris_k},
                     memory.corners);
}

std::vector<cv::Point> findGroundCorners(const StereoLevel& level, const PlaneVector& g, int count,
                                         const StereoDepthParameters& parameters) {
  GroundCornerMemory memory;
  return findGroundCorners(level, g, count, parameters, memory);
}

std::vector<cv::Point> cornersOnGround(const StereoLevel& level, const std::vector<cv::Point>& corners,
                                       const PlaneVector& g) {
  const GroundLimits limits(level, g);
  std::vector<cv::Point> inside;
  std::copy_if(corners.begin(), corners.end(), std::back_inserter(inside),
               [&](const cv::Point& corner) { return limits.hold(corner); });
  return inside;
}

RowMatches matchCorners(const StereoLevel& level, const std::vector<cv::Point>& corners, const PlaneVector& g,
                        const StereoDepthParameters& parameters, const CornerReach& reach) {
  CornerMatcher matcher(level, g, parameters, reach.steps);
  RowMatches matches;
  matches.samples.reserve(corners.size());
  matches.across.reserve(corners.size());
  // All at once, because each lies in another cache line and the processor can then load them together.
  for (const cv::Point& corner : corners) matcher.touch(corner.x, corner.y);
  ThinnedPlaces chosen(corners.size(), reach.most_across);
  for (size_t i = 0; i < corners.size(); ++i) {
    const cv::Point& corner = corners[i];
    const bool across = chosen.has(i);
    const RowRefinement match = matcher.match(corner.x, corner.y, across);
    if (!match.converged) continue;
    matches.samples.push_back({double(corner.x), double(corner.y), match.stddev,
                               corner.x - match.position - level.rig.principalOffset()});
    matches.across.push_back(across && parameters.warp_window ? std::optional(match.across) : std::nullopt);
  }
  return matches;
}

RowMatches matchCorners(const StereoLevel& level, const std::vector<cv::Point>& corners, const PlaneVector& g,
                        const StereoDepthParameters& parameters) {
  return matchCorners(level, corners, g, parameters,
                      {kFineSteps, parameters.vertical_disparities ? kCornersAcross : 0});
}

}  // namespace uav_landing
