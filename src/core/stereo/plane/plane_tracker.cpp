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
  expected_.reset();
  if (last_) expected_ = PlaneVector::of(last_->g.vector() + (stamp - last_->stamp) * last_->rate);
  corners_.reset();
}

void PlaneTracker::forget() {
  stamp_ = -INFINITY;
  last_.reset();
  steady_rate_.setZero();
  steadiness_.lose();
}

void PlaneTracker::miss() {
  if (last_ && ++last_->misses >= kKeepPlaneFor) last_.reset();
  steadiness_.lose();
}

void PlaneTracker::remember(const StereoDepthResult& result, bool certain) {
  const std::optional<PlaneVector> g = PlaneVector::of(result.plane.g);
  if (!g) return miss();
  const bool follows = last_ && !result.from_search;
  if (follows && certain) {
    steadiness_.note(agreeingShare(result), farthestOff(result));
  } else {
    steadiness_.lose();
  }
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();
  if (follows) {
    rate = (g->vector() - last_->g.vector()) / (stamp_ - last_->stamp);
    steady_rate_ += (steady_rate_.isZero(0) ? 1 : kLatest) * (rate - steady_rate_);
  } else {
    steady_rate_.setZero();
  }
  last_ = {*g, rate, stamp_};
}

// Largest difference in pixels, over the corners on the plane, between the disparity by the plane and the
// expected one.
double PlaneTracker::farthestOff(const StereoDepthResult& result) const {
  if (!expected_) return INFINITY;
  const ShiftModel now(rig_, PlaneVector(result.plane.g)), expected(rig_, *expected_);
  double farthest = 0;
  for (const StereoDepthResult::Point& point : result.points)
    if (point.on_plane)
      farthest = std::max(farthest, std::abs(now.at(point.u, point.v) - expected.at(point.u, point.v)));
  return farthest;
}

bool PlaneTracker::bearsOut(const StereoDepthResult& result) const {
  return steadiness_.bearsOut(agreeingShare(result), farthestOff(result));
}

std::optional<PlaneVector> PlaneTracker::steadyPlane(Timings& timings) {
  // Replaces the search by a few corners.
  ScopedTimer timer(timings, "feature_matching_coarse");
  if (!steadiness_.goesWithout()) return std::nullopt;
  return expected_;
}

std::optional<PlaneVector> PlaneTracker::follow(const StereoLevel& fine, const StereoLevel& coarse,
                                                int factor, Timings& timings) {
  steadiness_.searched();
  if (!last_) return std::nullopt;
  if (!corners_) cornersOn(fine, last_->g, timings);
  ScopedTimer timer(timings, "feature_matching_coarse");
  const std::optional<Consensus> scouted =
      trackPlaneByScouts(coarse, {corners_->places, factor}, last_->g, parameters_, limits_);
  if (scouted) return scouted->g;
  corners_.reset();
  return followFrom(last_->g, coarse);
}

std::optional<PlaneVector> PlaneTracker::followFrom(const PlaneVector& g, const StereoLevel& coarse,
                                                    double reach) {
  StereoDepthParameters reaching = parameters_;
  reaching.search_radius *= reach;
  const std::optional<Consensus> tracked = trackPlane(coarse, g, reaching, limits_, memory_);
  if (!tracked) return std::nullopt;
  return tracked->g;
}

std::vector<cv::Point> PlaneTracker::cornersOn(const StereoLevel& fine, const PlaneVector& g,
                                               Timings& timings) {
  ScopedTimer timer(timings, "harris_corners");
  if (corners_) {
    const int moved = groundRows(g).fine - groundRows(corners_->g).fine;
    std::vector<cv::Point> kept = cornersOnGround(fine, corners_->places, g);
    const bool most = kept.size() >= kKept * static_cast<double>(corners_->places.size());
    if (!kept.empty() && most && std::abs(moved) < kSlack * rig_.size.height) return kept;
  }
  corners_ = {g, matcher_.detect(fine, g, corner_count_)};
  return corners_->places;
}

FirstRows PlaneTracker::rowsOf(const PlaneVector& g, double slack) const {
  constexpr int kInterpolation = 8;  // pixels that windows are moved by, and that interpolation reads
  const int above = parameters_.window_radius + kInterpolation;
  return firstGroundRows(rig_, g, {above, above}, slack);
}

FirstRows PlaneTracker::groundRows(const PlaneVector& g) const { return rowsOf(g, 0); }

FirstRows PlaneTracker::lastGroundRows() const { return rowsOf(last_->g, kSlack); }

}  // namespace uav_landing
