#include "stereo/plane_tracker.h"

#include <algorithm>
#include <cmath>

#include "stereo/shift_model.h"
#include "uav_landing/stereo/stereo_matching.h"

namespace uav_landing {
namespace {

// Failing pairs for which the last plane stays the first guess.
constexpr int kKeepPlaneFor = 5;
// Share of the image's rows by which the horizon mostly moves less from pair to pair.
constexpr double kSlack = 0.02;
// Share of the corners on the last pair's ground that must be on that of this one to be used for it.
constexpr double kKept = 0.8;
// A plane that was where the ones before lead, to so many pixels of disparity for all of its corners, needs
// no search in the next pair, unless that one's is off by more: corners are looked for within two and a half.
constexpr double kSteadyOff = 1.0, kMostOff = 1.5;
// Share of the corners that must be on it: with the majority on a plane no other has as many. And share of
// those that were, that must be again.
constexpr double kLeastShare = 0.5, kLeastKept = 0.9;
// Up to so much longer than the last time from pair to pair, what the plane moves is known as well.
constexpr double kLongestRegular = 1.5;
// Pairs in a row without a search: what it would show, a plane that agrees better, is to be seen soon.
constexpr int kLookAround = 9;

// Of the corners looked for, those on the plane.
double agreeingShare(const StereoDepthResult& result) {
  const auto agreeing = std::count_if(result.points.begin(), result.points.end(),
                                      [](const StereoDepthResult::Point& point) { return point.on_plane; });
  return static_cast<double>(agreeing) / std::max(1, result.corners);
}

}  // namespace

PlaneTracker::PlaneTracker(const StereoRig& rig, const StereoDepthParameters& parameters,
                           const PlaneLimits& limits, int corner_count)
    : rig_(rig), parameters_(parameters), limits_(limits), corner_count_(corner_count) {}

void PlaneTracker::begin(double stamp) {
  if (!(stamp > stamp_)) forget();
  stamp_ = stamp;
  const double duration = stamp - last_stamp_;
  expected_ = last_ + duration * rate_;
  if (duration > kLongestRegular * last_duration_) steady_share_ = 0;
  corners_.clear();
}

void PlaneTracker::forget() {
  stamp_ = -INFINITY;
  has_last_ = false;
  failures_ = 0;
  steady_share_ = 0;
}

void PlaneTracker::miss() {
  has_last_ = has_last_ && ++failures_ < kKeepPlaneFor;
  steady_share_ = 0;
}

void PlaneTracker::remember(const StereoDepthResult& result) {
  const Eigen::Vector3d& g = result.plane.g;
  const bool follows = has_last_ && !result.from_search;
  last_duration_ = stamp_ - last_stamp_;
  const double share = agreeingShare(result);
  steady_share_ = follows && share >= kLeastShare && farthestOff(result) <= kSteadyOff ? share : 0;
  rate_ = follows ? Eigen::Vector3d((g - last_) / last_duration_) : Eigen::Vector3d::Zero();
  last_ = g;
  last_stamp_ = stamp_;
  has_last_ = true;
  failures_ = 0;
}

// By how many pixels the disparities of what is on the plane differ from those that were expected.
double PlaneTracker::farthestOff(const StereoDepthResult& result) const {
  const ShiftModel now(rig_, result.plane.g), expected(rig_, expected_);
  double farthest = 0;
  for (const StereoDepthResult::Point& point : result.points)
    if (point.on_plane)
      farthest = std::max(farthest, std::abs(now.at(point.u, point.v) - expected.at(point.u, point.v)));
  return farthest;
}

bool PlaneTracker::bearsOut(const StereoDepthResult& result) const {
  return agreeingShare(result) >= kLeastKept * steady_share_ && farthestOff(result) <= kMostOff;
}

void PlaneTracker::findCorners(const StereoLevel& fine, const Eigen::Vector3d& g, Timings& timings) {
  ScopedTimer timer(timings, "harris_corners");
  corners_ = findGroundCorners(fine, g, corner_count_, parameters_);
  corners_of_ = g;
}

std::optional<Eigen::Vector3d> PlaneTracker::steadyPlane(const StereoLevel& fine, Timings& timings) {
  if (steady_share_ <= 0 || steady_pairs_ >= kLookAround) return std::nullopt;
  ++steady_pairs_;
  findCorners(fine, expected_, timings);
  return expected_;
}

std::optional<Eigen::Vector3d> PlaneTracker::follow(const StereoLevel& fine, const StereoLevel& coarse,
                                                    int factor, Timings& timings) {
  steady_pairs_ = 0;
  if (!has_last_) return std::nullopt;
  findCorners(fine, last_, timings);
  ScopedTimer timer(timings, "feature_matching_coarse");
  const Consensus scouted = trackPlaneByScouts(coarse, corners_, factor, last_, parameters_, limits_);
  if (scouted.found) return scouted.g;
  corners_.clear();
  const Consensus tracked = trackPlane(coarse, last_, parameters_, limits_);
  if (!tracked.found) return std::nullopt;
  return tracked.g;
}

std::vector<cv::Point> PlaneTracker::cornersOn(const StereoLevel& fine, const Eigen::Vector3d& g) const {
  const int moved = groundRows(g).fine - groundRows(corners_of_).fine;
  if (!corners_.empty() && std::abs(moved) < kSlack * rig_.size.height) {
    std::vector<cv::Point> corners = cornersOnGround(fine, corners_, g);
    if (corners.size() >= kKept * corners_.size()) return corners;
  }
  return findGroundCorners(fine, g, corner_count_, parameters_);
}

FirstRows PlaneTracker::rowsOf(const Eigen::Vector3d& g, double slack) const {
  constexpr int kInterpolation = 8;  // px that windows are moved, and that is interpolated from
  const int above = parameters_.window_radius + kInterpolation;
  return firstGroundRows(rig_, g, {above, above}, slack);
}

FirstRows PlaneTracker::groundRows(const Eigen::Vector3d& g) const { return rowsOf(g, 0); }

FirstRows PlaneTracker::lastGroundRows() const { return rowsOf(last_, kSlack); }

}  // namespace uav_landing
