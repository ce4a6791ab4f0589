#include "stereo/plane/plane_search.h"

#include <algorithm>
#include <cmath>

#include "base/thinned.h"
#include "image/image_check.h"
#include "image/match_image.h"
#include "stereo/matching/row_matching.h"
#include "stereo/matching/shift_model.h"

namespace uav_landing {
namespace {

// Where a plane is followed, corners are looked for within the search radius of the predicted place.
CornerReach trackingReach(const StereoDepthParameters& parameters) {
  return {static_cast<int>(std::ceil(parameters.search_radius)), 0};
}

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

Consensus trackPlane(const StereoLevel& level, const Eigen::Vector3d& predicted,
                     const StereoDepthParameters& parameters, const PlaneLimits& limits,
                     GroundCornerMemory& memory) {
  constexpr int kCorners = 250, kIterations = 150;
  constexpr double kLeastShare = 0.2;
  const std::vector<cv::Point> corners = findGroundCorners(level, predicted, kCorners, parameters, memory);
  const std::vector<DisparitySample> samples =
      matchCorners(level, corners, predicted, parameters, trackingReach(parameters)).samples;
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
      matchCorners(level, scouts, predicted, parameters, trackingReach(parameters)).samples;
  Consensus consensus = findPlane(level.rig, samples, limits, kIterations, nullptr, true);
  consensus.found &= consensus.support >=
                     std::max<double>(limits.min_points, kLeastShare * static_cast<double>(scouts.size()));
  return consensus;
}

Consensus searchPlane(const StereoLevel& level, const StereoDepthParameters& parameters,
                      const PlaneLimits& limits, CornerMemory& memory) {
  constexpr int kCorners = 500, kIterations = 400;
  // Votes of a rival plane as a share of those of the strongest: a bar off has about as many.
  constexpr double kRivalShare = 0.8;
  // Changes of disparity per row that windows are sheared for; each serves the range to its neighbours.
  const std::vector<double> slopes = {0.0, 0.04, 0.09, 0.16, 0.25, 0.37, 0.52, 0.72, 1.0, 1.4};
  const std::vector<cv::Point> corners =
      findCorners(level.left, level.left_mask, kCorners, parameters.corner_quality,
                  parameters.min_corner_distance, parameters.harris_k, memory);
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
