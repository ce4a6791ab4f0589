#include "uav_landing/stereo/stereo_matching.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "base/image_memory.h"
#include "base/thinned.h"
#include "base/touch_ahead.h"
#include "stereo/shift_model.h"
#include "uav_landing/geometry/half_plane.h"
#include "uav_landing/image/corners.h"
#include "uav_landing/image/image_check.h"
#include "uav_landing/image/match_image.h"
#include "uav_landing/stereo/row_matching.h"
#include "uav_landing/stereo/row_refinement.h"

namespace uav_landing {
namespace {

// Columns to both sides that are scored in the full-size pass, where the plane is known to about a pixel.
constexpr int kFineSteps = 3;
// Error of a match that is common to neighbouring windows or not seen in its residuals, pixels.
constexpr double kStddevFloor = 0.03;
// 1 sigma of a match that is only as good as a parabola through three scores, pixels.
constexpr double kParabolaStddev = 0.15;

// Matches one corner within steps of the predicted place.
class CornerMatcher {
 public:
  CornerMatcher(const StereoLevel& level, const Eigen::Vector3d& g, const StereoDepthParameters& parameters,
                int steps)
      : level_(level),
        parameters_(parameters),
        shift_(level.rig, g),
        steps_(steps),
        forward_(level.left, level.right, parameters.window_radius, parameters.matching_cost),
        backward_(level.right, level.left, parameters.window_radius, parameters.matching_cost),
        forward_warp_(parameters.warp_window ? shift_.forward() : RowWarp{}),
        backward_warp_(parameters.warp_window ? shift_.backward() : RowWarp{}) {}

  // Touches the right mask where the match of a corner is expected.
  void touch(int u, int v) const { touchPixel(level_.right_mask, u - shift_.at(u, v), v); }

  // Column in the right image and its stddev; not converged when there is no trustworthy match. across:
  // whether to find where it is when its row may move, besides.
  RowRefinement match(int u, int v, bool across) {
    const double predicted = u - shift_.at(u, v);
    if (!forward_.run(u, v, predicted, steps_, forward_warp_)) return {};
    double second = 0;
    const RowCandidate best = forward_.best(&second);
    if (best.score < parameters_.min_zncc || second > parameters_.uniqueness * best.score) return {};
    // A peak at the end of the range is not known to be a peak.
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
    RowRefinement refined = refineAlongRow(level_.left, level_.right, u, v, found, forward_warp_,
                                           parameters_.window_radius, across);
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

// most_across: corners that are looked for across their rows, too, spread as the corners are.
RowMatches matchAll(const StereoLevel& level, const std::vector<cv::Point>& corners, const Eigen::Vector3d& g,
                    const StereoDepthParameters& parameters, int steps, size_t most_across) {
  CornerMatcher matcher(level, g, parameters, steps);
  RowMatches matches;
  matches.samples.reserve(corners.size());
  matches.across.reserve(corners.size());
  // All at once, as each is in another line of the cache.
  for (const cv::Point& corner : corners) matcher.touch(corner.x, corner.y);
  ThinnedPlaces chosen(corners.size(), most_across);
  for (size_t i = 0; i < corners.size(); ++i) {
    const cv::Point& corner = corners[i];
    const bool across = chosen.has(i);
    const RowRefinement match = matcher.match(corner.x, corner.y, across);
    if (!match.converged) continue;
    matches.samples.push_back({double(corner.x),
                               double(corner.y),
                               match.stddev,
                               {corner.x - match.position - level.rig.principalOffset()}});
    matches.across.push_back(across && parameters.warp_window ? std::optional(match.across) : std::nullopt);
  }
  return matches;
}

// Columns to both sides of the predicted place that are scored where a plane is followed.
int trackingSteps(const StereoDepthParameters& parameters) {
  return static_cast<int>(std::ceil(parameters.search_radius));
}

// Where a plane is seen by both cameras: half planes a u + b v + c >= 0.
struct GroundLimits {
  std::array<Eigen::Vector3d, 3> sides;

  GroundLimits(const StereoLevel& level, const Eigen::Vector3d& g) {
    // Ground nearer the horizon than this disparity (pixels) says nothing about the height.
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

// So many of the corners of the full size, from all of the image, where they are at a level reduced by this
// factor.
std::vector<cv::Point> spread(const StereoLevel& level, const std::vector<cv::Point>& corners, int factor,
                              size_t most) {
  std::vector<cv::Point> places;
  for (const cv::Point& corner : thinned(corners, most)) {
    const cv::Point place(cvRound(toCoarse(corner.x, factor)), cvRound(toCoarse(corner.y, factor)));
    if (isSet(level.left_mask, place.x, place.y)) places.push_back(place);
  }
  return places;
}

// All places along the whole row that resemble each corner, with windows sheared for one height.
std::vector<DisparitySample> candidates(const StereoLevel& level, const std::vector<cv::Point>& corners,
                                        double slope, const StereoDepthParameters& parameters) {
  constexpr double kMinScore = 0.6, kShareOfBest = 0.85;
  constexpr int kMostPeaks = 5;
  constexpr double kNearestToHorizon = -2.0;
  const double largest = parameters.max_disparity * level.rig.size.width;
  const double offset = level.rig.principalOffset();
  const int steps = static_cast<int>((largest - kNearestToHorizon) / 2) + 1;
  RowSearch search(level.left, level.right, parameters.window_radius, parameters.matching_cost);
  std::vector<DisparitySample> samples;
  for (const cv::Point& corner : corners) {
    const double centre = corner.x - offset - (largest + kNearestToHorizon) / 2;
    if (!search.run(corner.x, corner.y, centre, steps, RowWarp{1.0, -slope})) continue;
    std::vector<double> disparities;
    double strongest = -1;
    for (const RowCandidate& peak : search.peaks(kMinScore, kMostPeaks)) {
      strongest = std::max(strongest, peak.score);
      if (peak.score < kShareOfBest * strongest) break;
      if (!isSet(level.right_mask, peak.position, corner.y)) continue;
      disparities.push_back(corner.x - peak.position - offset);
    }
    if (disparities.empty()) continue;
    samples.push_back({double(corner.x),
                       double(corner.y),
                       0.5,
                       disparities.front(),
                       {disparities.begin() + 1, disparities.end()}});
  }
  return samples;
}

// A plane with how well each corner correlates where it says, in a window warped as it says; below 0 where
// that is outside the right image.
struct Hypothesis {
  Consensus plane;
  std::vector<double> correlation;
};

Hypothesis makeHypothesis(const StereoLevel& level, const std::vector<cv::Point>& corners,
                          const Consensus& plane, const StereoDepthParameters& parameters) {
  constexpr int kSteps = 1;
  const ShiftModel shift(level.rig, plane.g);
  const RowWarp warp = parameters.warp_window ? shift.forward() : RowWarp{};
  RowSearch search(level.left, level.right, parameters.window_radius, parameters.matching_cost);
  Hypothesis hypothesis{plane, std::vector<double>(corners.size(), -1)};
  for (size_t i = 0; i < corners.size(); ++i) {
    const double column = corners[i].x - shift.at(corners[i].x, corners[i].y);
    if (!isSet(level.right_mask, column, corners[i].y)) continue;
    if (!search.run(corners[i].x, corners[i].y, column, kSteps, warp)) continue;
    hypothesis.correlation[i] = search.best(nullptr).score;
  }
  return hypothesis;
}

// Whether the corners that match on both planes match better on the second. Only repeated texture matches on
// two: where much of it is outside the other view on the right plane, the one that is a bar off may have more
// votes, but it does not look quite the same. Sign test, so that a few corners do not decide.
bool matchesBetter(const Hypothesis& first, const Hypothesis& second, int least) {
  constexpr double kMatches = 0.6, kSigmas = 3.0;
  int both = 0, better = 0;
  for (size_t i = 0; i < first.correlation.size(); ++i) {
    if (first.correlation[i] < kMatches || second.correlation[i] < kMatches) continue;
    ++both;
    better += second.correlation[i] > first.correlation[i];
  }
  return both >= least && 2 * better - both > kSigmas * std::sqrt(both);
}

}  // namespace

std::vector<cv::Point> findGroundCorners(const StereoLevel& level, const Eigen::Vector3d& g, int count,
                                         const StereoDepthParameters& parameters) {
  static thread_local ImageMemory memory;
  cv::Mat mask = level.left_mask, kept = memory.image(mask.size());
  for (const Eigen::Vector3d& side : GroundLimits(level, g).sides) {
    keepHalfPlane(mask, side.x(), side.y(), side.z(), kept);
    mask = kept;
  }
  return findCorners(level.left, mask, count, parameters.corner_quality, parameters.min_corner_distance,
                     parameters.harris_k);
}

RowMatches matchCorners(const StereoLevel& level, const std::vector<cv::Point>& corners,
                        const Eigen::Vector3d& g, const StereoDepthParameters& parameters) {
  return matchAll(level, corners, g, parameters, kFineSteps,
                  parameters.vertical_disparities ? kCornersAcross : 0);
}

std::vector<cv::Point> cornersOnGround(const StereoLevel& level, const std::vector<cv::Point>& corners,
                                       const Eigen::Vector3d& g) {
  const GroundLimits limits(level, g);
  std::vector<cv::Point> inside;
  std::copy_if(corners.begin(), corners.end(), std::back_inserter(inside),
               [&](const cv::Point& corner) { return limits.hold(corner); });
  return inside;
}

Consensus trackPlane(const StereoLevel& level, const Eigen::Vector3d& predicted,
                     const StereoDepthParameters& parameters, const PlaneLimits& limits) {
  constexpr int kCorners = 250, kIterations = 150;
  constexpr double kLeastShare = 0.2;
  const std::vector<cv::Point> corners = findGroundCorners(level, predicted, kCorners, parameters);
  const std::vector<DisparitySample> samples =
      matchAll(level, corners, predicted, parameters, trackingSteps(parameters), 0).samples;
  Consensus consensus = findPlane(level.rig, samples, limits, kIterations, nullptr);
  consensus.found &= consensus.support >= std::max<double>(limits.min_points, kLeastShare * samples.size());
  return consensus;
}

Consensus trackPlaneByScouts(const StereoLevel& level, const std::vector<cv::Point>& corners, int factor,
                             const Eigen::Vector3d& predicted, const StereoDepthParameters& parameters,
                             const PlaneLimits& limits) {
  // Enough for a plane good to half a pixel at full size; the search there reaches farther.
  constexpr size_t kScouts = 64;
  constexpr int kIterations = 150;
  // Votes of all scouts, those without a match included: with the majority on a plane no other has as many.
  constexpr double kLeastShare = 0.5;
  const std::vector<cv::Point> scouts = spread(level, corners, factor, kScouts);
  const std::vector<DisparitySample> samples =
      matchAll(level, scouts, predicted, parameters, trackingSteps(parameters), 0).samples;
  Consensus consensus = findPlane(level.rig, samples, limits, kIterations, nullptr, true);
  consensus.found &= consensus.support >=
                     std::max<double>(limits.min_points, kLeastShare * static_cast<double>(scouts.size()));
  return consensus;
}

Consensus searchPlane(const StereoLevel& level, const StereoDepthParameters& parameters,
                      const PlaneLimits& limits) {
  constexpr int kCorners = 500, kIterations = 400;
  // Votes of a rival plane as a share of those of the strongest: a bar off has about as many.
  constexpr double kRivalShare = 0.8;
  // Changes of disparity per row that windows are sheared for; each serves the range to its neighbours.
  const std::vector<double> slopes = {0.0, 0.04, 0.09, 0.16, 0.25, 0.37, 0.52, 0.72, 1.0, 1.4};
  const std::vector<cv::Point> corners =
      findCorners(level.left, level.left_mask, kCorners, parameters.corner_quality,
                  parameters.min_corner_distance, parameters.harris_k);
  std::vector<Hypothesis> hypotheses;
  for (size_t i = 0; i < slopes.size(); ++i) {
    const Eigen::Vector2d range(i == 0 ? 0.0 : slopes[i - 1],
                                i + 1 == slopes.size() ? 2.0 * slopes[i] : slopes[i + 1]);
    const std::vector<DisparitySample> samples =
        candidates(level, corners, parameters.warp_window ? slopes[i] : 0.0, parameters);
    const Consensus found = findPlane(level.rig, samples, limits, kIterations, &range);
    if (!found.found || found.support < limits.min_points) continue;
    hypotheses.push_back(makeHypothesis(level, corners, found, parameters));
  }
  if (hypotheses.empty()) return {};
  std::stable_sort(hypotheses.begin(), hypotheses.end(),
                   [](const Hypothesis& a, const Hypothesis& b) { return a.plane.score > b.plane.score; });
  const Hypothesis* best = &hypotheses.front();
  for (const Hypothesis& other : hypotheses) {
    if (other.plane.score < kRivalShare * hypotheses.front().plane.score) break;
    if (matchesBetter(*best, other, limits.min_points)) best = &other;
  }
  return best->plane;
}

}  // namespace uav_landing
