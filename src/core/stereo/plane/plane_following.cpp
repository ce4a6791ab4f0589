#include "stereo/plane/plane_following.h"

#include <algorithm>
#include <cmath>

#include "base/thinned.h"
#include "image/input/image_check.h"
#include "image/windows/match_image.h"

namespace uav_landing {
namespace {

// When a plane is followed, corners are looked for within the search radius of the predicted place.
CornerReach trackingReach(const StereoDepthParameters& parameters) {
  return {static_cast<int>(std::ceil(parameters.search_radius)), 0};
}

// At most so many of the corners, from all of the image, at their places in the level.
std::vector<cv::Point> spread(const StereoLevel& level, const FullSizeCorners& corners, size_t most) {
  std::vector<cv::Point> places;
  for (const cv::Point& corner : thinned(corners.places, most)) {
    const cv::Point place(cvRound(toCoarse(corner.x, corners.factor)),
                          cvRound(toCoarse(corner.y, corners.factor)));
    if (isSet(level.left_mask, place.x, place.y)) places.push_back(place);
  }
  return places;
}

// The plane, if at least so many samples agree with it.
std::optional<Consensus> supported(const std::optional<Consensus>& plane, double least) {
  return plane && plane->support >= least ? plane : std::nullopt;
}

}  // namespace

std::optional<Consensus> trackPlane(const StereoLevel& level, const PlaneVector& predicted,
                                    const StereoDepthParameters& parameters, const PlaneLimits& limits,
                                    GroundCornerMemory& memory) {
  constexpr int kCorners = 250, kIterations = 150;
  constexpr double kLeastShare = 0.2;
  const std::vector<cv::Point> corners = findGroundCorners(level, predicted, kCorners, parameters, memory);
  const std::vector<DisparitySample> samples =
      matchCorners(level, corners, predicted, parameters, trackingReach(parameters)).samples;
  const double least = std::max<double>(limits.min_points, kLeastShare * samples.size());
  return supported(findPlane(level.rig, samples, limits, {kIterations}), least);
}

std::optional<Consensus> trackPlaneByScouts(const StereoLevel& level, const FullSizeCorners& corners,
                                            const PlaneVector& predicted,
                                            const StereoDepthParameters& parameters,
                                            const PlaneLimits& limits) {
  // Enough for a plane that is good to half a pixel at full size; the search there reaches farther.
  constexpr size_t kScouts = 64;
  constexpr int kIterations = 150;
  // Share of the votes of all scouts, with or without a match. When the majority is on a plane, no other has
  // as many.
  constexpr double kLeastShare = 0.5;
  const std::vector<cv::Point> scouts = spread(level, corners, kScouts);
  const std::vector<DisparitySample> samples =
      matchCorners(level, scouts, predicted, parameters, trackingReach(parameters)).samples;
  const double least = std::max<double>(limits.min_points, kLeastShare * static_cast<double>(scouts.size()));
  return supported(findPlane(level.rig, samples, limits, {kIterations, true}), least);
}

}  // namespace uav_landing
