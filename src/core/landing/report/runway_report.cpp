#include "landing/report/runway_report.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "estimation/limits.h"
#include "height/runway_height.h"
#include "uav_landing/results/consistency_test.h"

namespace uav_landing {
namespace {

constexpr Sigmas kAgreement(5);
// Largest 1 sigma of a reported position: a share of the distance to the threshold, but at least so many
// metres.
constexpr double kLargestX = 0.06, kLeastX = 12, kLargestY = 0.004, kLeastY = 1.5;

struct Value {
  double value = kUnknown, variance = kUnknown;
  bool known() const { return std::isfinite(value) && variance >= 0; }
};

/// The share of a in a mean of both. It favours the better one more than the variances would: the outline's
/// error is the same in all pairs, so averaging does not remove it.
double shareOf(const Value& a, const Value& b) {
  const double ratio = a.variance / b.variance;
  return 1 / (1 + ratio * ratio);
}

Value weightedMean(const Value& a, const Value& b) {
  const double share = shareOf(a, b), other = 1 - share;
  return {share * a.value + other * b.value, share * share * a.variance + other * other * b.variance};
}

bool agree(const Value& a, const Value& b) {
  return kAgreement.admits(a.value - b.value, a.variance + b.variance);
}

void contradict(const char* what, const Value& near, const Value& outline, LandingResult& result) {
  if (result.runway_failure) return;
  result.runway_failure = {Reason::kInconsistent,
                           text(what, " by the outline is ", rounded(outline.value), " m and by stereo ",
                                rounded(near.value), " m: check runway/width and runway/length")};
}

/// near: from edges and threshold.
Value handedOver(const char* name, const Value& near, const Value& outline, double largest_stddev,
                 LandingResult& result) {
  if (!outline.known()) return near;
  if (!near.known()) return outline.variance <= largest_stddev * largest_stddev ? outline : near;
  if (agree(near, outline)) return weightedMean(near, outline);
  contradict(name, near, outline, result);
  return near;
}

}  // namespace

HeightOrigin originOf(const MeasuredHeight& measured, const LandingResult& result) {
  if (!std::isfinite(result.height)) return HeightOrigin::kNone;
  if (result.status != Status::kTracking) return HeightOrigin::kPrediction;
  return measured.by_width ? HeightOrigin::kWidth : HeightOrigin::kStereo;
}

void handOver(const TrackedPosition& outline, const ApproachAngleResult::Sight& sight,
              LandingResult& result) {
  if (outline.contradiction) result.runway_failure = outline.contradiction;
  if (!outline.known()) return;
  const Eigen::Vector3d &p = outline.position, &variance = outline.variance;
  const double distance = std::abs(p.x());
  const Value x = handedOver("x", {result.x, result.x_variance}, {p.x(), variance.x()},
                             std::max(kLeastX, kLargestX * distance), result);
  const Value y = handedOver("y", {result.y, result.y_variance}, {p.y(), variance.y()},
                             std::max(kLeastY, kLargestY * distance), result);
  result.x = x.value;
  result.x_variance = x.variance;
  // The bound of the edges' y holds for what the outline makes of it, too, if it grows by the difference.
  result.y_protection_level += std::abs(y.value - result.y);
  result.y = y.value;
  result.y_variance = y.variance;
  if (!outline.measured || std::isfinite(result.yaw) || !std::isfinite(sight.yaw)) return;
  result.yaw = sight.yaw;
  result.yaw_variance = sight.yaw_variance;
  result.yaw_failure = {};
}

void reportHeightAboveRunway(const TrackedPosition& outline, double bend, bool width_known,
                             const KalmanHeightParameters& parameters, LandingResult& result) {
  const RunwayHeight ahead = runwayHeight(result, bend, width_known);
  const Value by_stereo{ahead.height, ahead.variance};
  Value by_outline;
  if (outline.known()) by_outline = {outline.position.z(), outline.variance.z()};
  // Addition to the bound of the height, because the ground before the runway may slope.
  const double slope = normalQuantile(parameters.integrity_risk) *
                       std::sqrt(std::max(0.0, by_stereo.variance - result.height_variance));
  const double stereo_level = result.height_protection_level + slope;
  Value above = by_stereo;
  double level = stereo_level;
  bool stereo_leads = true;
  if (by_outline.known() && !by_stereo.known()) {
    above = by_outline;
    level = outline.protection_level;
    stereo_leads = false;
  } else if (by_outline.known() && agree(by_stereo, by_outline)) {
    above = weightedMean(by_stereo, by_outline);
    const double share = shareOf(by_stereo, by_outline);
    level = share * stereo_level + (1 - share) * outline.protection_level;
    stereo_leads = share >= 0.5;
  } else if (by_outline.known()) {
    contradict("the height above the runway", by_stereo, by_outline, result);
    if (!(result.x > 0)) above = {};
  }
  result.forgetHeightAboveRunway();
  if (!above.known() || !(above.value > 0)) return;
  result.height_above_runway = above.value;
  result.height_above_runway_variance = above.variance;
  result.height_above_runway_protection_level = level;
  result.height_above_runway_limit =
      std::max(parameters.alert_limit, parameters.runway_height_limit * above.value);
  result.height_above_runway_known = level <= result.height_above_runway_limit;
  if (!stereo_leads)
    result.height_origin = outline.measured ? HeightOrigin::kGeometry : HeightOrigin::kPrediction;
}

}  // namespace uav_landing
