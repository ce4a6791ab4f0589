#include "stereo/plane/plane_tracker.h"

#include <algorithm>
#include <cmath>

#include "stereo/matching/corner_matching.h"
#include "stereo/matching/shift_model.h"
#include "stereo/plane/plane_following.h"

namespace uav_landing {
namespace {

// Failing pairs after which the last plane is still the first guess.
constexpr int kKeepPlaneFor = 5;
// Largest usual movement of the horizon from pair to pair, as a share of the image's rows.
constexpr double kSlack = 0.02;
// The last pair's corners are used again when at least this share of them lies on this pair's ground.
constexpr double kKept = 0.8;
// Limits of the disparities' change, pixels (see Steadiness). Corners are looked for within two and a half
// pixels.
constexpr double kSteadyOff = 1.0, kMostOff = 1.5;

// Weight of the last pair's rate in the mean; the rate of one pair alone is mostly noise.
constexpr double kLatest = 0.4;

// Share of the corners looked for that lie on the plane.
double agreeingShare(const StereoDepthResult& result) {
  const auto agreeing = std::count_if(result.points.begin(), result.points.end(),
                                      [](const StereoDepthResult::Point& point) { return point.on_plane; });
  return static_cast<double>(agreeing) / std::max(1, result.corners);
}

}  // namespace

PlaneTracker::PlaneTracker(const StereoRig& rig, const StereoDepthParameters& parameters,
                           const PlaneLimits& limits, int corner_count, CornerMatcher& matcher)
    : rig_(rig),
      parameters_(parameters),
      limits_(limits),
      corner_count_(corner_count),
      matcher_(matcher),
      steadiness_(kSteadyOff, kMostOff) {}

void PlaneTracker::begin(double stamp) {
  if (!(stamp > stamp_)) forget();
  const double duration = stamp - stamp_;
  if (duration > Steadiness::kLongestRegular * duration_) steadiness_.lose();
  duration_ = duration;
  stamp_ = stamp;
  expected_ = last_ + (stamp - last_stamp_) * rate_;
  corners_.clear();
}

void PlaneTracker::forget() {
  stamp_ = -INFINITY;
  has_last_ = false;
  failures_ = 0;
  steady_rate_.setZero();
  steadiness_.lose();
}

void PlaneTracker::miss() {
  has_last_ = has_last_ && ++failures_ < kKeepPlaneFor;
  steadiness_.lose();
}

void PlaneTracker::remember(const StereoDepthResult& result, bool certain) {
  const Eigen::Vector3d& g = result.plane.g;
  const bool follows = has_last_ && !result.from_search;
  if (follows && certain) {
    steadiness_.note(agreeingShare(result), farthestOff(result));
  } else {
    steadiness_.lose();
  }
  rate_ = follows ? Eigen::Vector3d((g - last_) / (stamp_ - last_stamp_)) : Eigen::Vector3d::Zero();
  if (!follows) {
    steady_rate_.setZero();
  } else {
    steady_rate_ += (steady_rate_.isZero(0) ? 1 : kLatest) * (rate_ - steady_rate_);
  }
  last_ = g;
  last_stamp_ = stamp_;
  has_last_ = true;
  failures_ = 0;
}

// Largest difference in pixels, over the corners on the plane, between the disparity by the plane and the
// expected one.
double PlaneTracker::farthestOff(const StereoDepthResult& result) const {
  const ShiftModel now(rig_, result.plane.g), expected(rig_, expected_);
  double farthest = 0;
  for (const StereoDepthResult::Point& point : result.points)
    if (point.on_plane)
      farthest = std::max(farthest, std::abs(now.at(point.u, point.v) - expected.at(point.u, point.v)));
  return farthest;
}

bool PlaneTracker::bearsOut(const StereoDepthResult& result) const {
  return steadiness_.bearsOut(agreeingShare(result), farthestOff(result));
}

std::optional<Eigen::Vector3d> PlaneTracker::steadyPlane(Timings& timings) {
  // Replaces the search by a few corners.
  ScopedTimer timer(timings, "feature_matching_coarse");
  if (!steadiness_.goesWithout()) return std::nullopt;
  return expected_;
}

std::optional<Eigen::Vector3d> PlaneTracker::follow(const StereoLevel& fine, const StereoLevel& coarse,
                                                    int factor, Timings& timings) {
  steadiness_.searched();
  if (!has_last_) return std::nullopt;
  if (corners_.empty()) cornersOn(fine, last_, timings);
  ScopedTimer timer(timings, "feature_matching_coarse");
  const Consensus scouted = trackPlaneByScouts(coarse, {corners_, factor}, last_, parameters_, limits_);
  if (scouted.found) return scouted.g;
  corners_.clear();
  return followFrom(last_, coarse);
}

std::optional<Eigen::Vector3d> PlaneTracker::followFrom(const Eigen::Vector3d& g, const StereoLevel& coarse,
                                                        double reach) {
  StereoDepthParameters reaching = parameters_;
  reaching.search_radius *= reach;
  const Consensus tracked = trackPlane(coarse, g, reaching, limits_, memory_);
  if (!tracked.found) return std::nullopt;
  return tracked.g;
}

std::vector<cv::Point> PlaneTracker::cornersOn(const StereoLevel& fine, const Eigen::Vector3d& g,
                                               Timings& timings) {
  ScopedTimer timer(timings, "harris_corners");
  const int moved = groundRows(g).fine - groundRows(corners_of_).fine;
  if (!corners_.empty() && std::abs(moved) < kSlack * rig_.size.height) {
    std::vector<cv::Point> corners = cornersOnGround(fine, corners_, g);
    if (corners.size() >= kKept * corners_.size()) return corners;
  }
  corners_ = matcher_.detect(fine, g, corner_count_);
  corners_of_ = g;
  return corners_;
}

FirstRows PlaneTracker::rowsOf(const Eigen::Vector3d& g, double slack) const {
  constexpr int kInterpolation = 8;  // pixels that windows are moved by, and that interpolation reads
  const int above = parameters_.window_radius + kInterpolation;
  return firstGroundRows(rig_, g, {above, above}, slack);
}

FirstRows PlaneTracker::groundRows(const Eigen::Vector3d& g) const { return rowsOf(g, 0); }

FirstRows PlaneTracker::lastGroundRows() const { return rowsOf(last_, kSlack); }

}  // namespace uav_landing
