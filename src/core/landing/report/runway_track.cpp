#include "landing/report/runway_track.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "estimation/limits.h"
#include "results/protection_factors.h"

namespace uav_landing {
namespace {

constexpr double kAcceleration = 1.0;                  // m/s^2, along each axis
constexpr double kForwardSpeed = 60, kOtherSpeed = 8;  // m/s, 1 sigma before any measurement
// 1 sigma of the error that all pairs have in common, from the ground's texture and the paint. It is a share
// of the distance for x and y, and of the height for z.
constexpr double kSystematicX = 0.012, kSystematicY = 0.0005, kSystematicZ = 0.012;
// Bounds of the common share of a measurement's variance. Most of it comes from the question whether stripes
// lie along the edges, which moves the edges in all pairs alike.
constexpr double kCommon = 0.7,
                 kMostCommon = 0.9;    // share of a measurement's variance, at least and at most
constexpr double kSpeedError = 0.005;  // share of the speed, as the axes are slightly turned
constexpr double kGate = 5;            // standard deviations
constexpr double kPatience = 12;       // s without the outline after which the position is forgotten
constexpr double kChartError = 0.10;   // share of width and length
constexpr double kBiasError = 5;       // standard deviations of the disparities' bias
constexpr Sigmas kContradiction(3);    // between the height and the one without an element
constexpr Sigmas kOtherSize(4);
constexpr double kSameSize = 0.04;  // largest relative difference between sizes that count as the same
constexpr int kPersistent = 6;      // rejected measurements in a row after which they are accepted
constexpr int kAgreeing = 5;        // pairs with another size that contradict the chart

}  // namespace

RunwayTrack::RunwayTrack(const KalmanHeightParameters& parameters)
    : parameters_(parameters),
      axes_{Axis(kForwardSpeed), Axis(kOtherSpeed), Axis(kOtherSpeed)},
      without_{Axis(kOtherSpeed), Axis(kOtherSpeed), Axis(kOtherSpeed)} {}

RunwayTrack::Axis::Axis(double speed_stddev) : filter_(kAcceleration, speed_stddev, kGate) {}

void RunwayTrack::Axis::update(double value, double variance, double systematic) {
  common_ = std::min(std::max(kCommon * variance, systematic * systematic), kMostCommon * variance);
  const double own = variance - common_;
  const bool accepted = known() && filter_.update(value, own).accepted;
  rejected_ = accepted ? 0 : rejected_ + 1;
  if (known() && rejected_ < kPersistent) return;
  filter_.initialise(value, own);
  rejected_ = 0;
}

void RunwayTrack::Axis::forget() {
  filter_.reset();
  rejected_ = 0;
}

RunwayVelocity runwayVelocity(const LandingResult& landing, const Eigen::Vector3d& normal,
                              const Eigen::Vector3d& direction) {
  RunwayVelocity result;
  const Eigen::Vector3d& v = landing.velocity;
  const Eigen::Matrix3d covariance = landing.twist_covariance.topLeftCorner<3, 3>();
  if (!v.allFinite() || !covariance.allFinite() || !normal.allFinite() || !direction.allFinite())
    return result;
  const Eigen::Vector3d forward = (direction - normal.dot(direction) * normal).normalized();
  const std::array<Eigen::Vector3d, 3> axes{forward, forward.cross(normal), -normal};
  for (int i = 0; i < 3; ++i) {
    result.value[i] = axes[i].dot(v);
    result.variance[i] = axes[i].dot(covariance * axes[i]) + std::pow(kSpeedError * v.norm(), 2);
  }
  return result;
}

void RunwayTrack::forget() {
  for (Axis& axis : axes_) axis.forget();
  for (Axis& axis : without_) axis.forget();
  unseen_ = 0;
}

TrackedPosition RunwayTrack::follow(double T, const ApproachAngleResult::Sight& sight,
                                    const RunwayVelocity& velocity) {
  if (!(T > 0)) forget();
  for (Axis& axis : axes_) axis.predict(T);
  for (Axis& axis : without_) axis.predict(T);
  unseen_ += T;
  TrackedPosition result;
  const bool seen = !sight.failure && sight.position.allFinite();
  if (seen) {
    measure(sight);
    compareSize(T, sight);
  } else if (unseen_ > kPatience || sight.failure.reason == Reason::kRejected) {
    // Rejected: what was followed is not the runway.
    forget();
  }
  for (int i = 0; i < 3; ++i)
    if (std::isfinite(velocity.value[i]) && velocity.variance[i] > 0)
      axes_[i].updateSpeed(velocity.value[i], velocity.variance[i]);
  if (other_size_ >= kAgreeing)
    result.contradiction = {
        Reason::kInconsistent,
        text("the runway is ", rounded(size_), " times as large as the chart's, by stereo, with 1 sigma of ",
             rounded(std::sqrt(size_variance_)), ": check runway/width and runway/length")};
  if (!axes_[0].known() || result.contradiction) return result;
  result.measured = seen;
  for (int i = 0; i < 3; ++i) {
    result.position[i] = axes_[i].value();
    result.variance[i] = axes_[i].variance();
  }
  result.protection_level = protectionLevel();
  return result;
}

void RunwayTrack::measure(const ApproachAngleResult::Sight& sight) {
  unseen_ = 0;
  const double distance = std::abs(sight.position.x()), height = std::abs(sight.position.z());
  const double systematic[] = {kSystematicX * distance, kSystematicY * distance, kSystematicZ * height};
  influences_ = {sight.height_by_chart / height, sight.height_by_bias / height};
  for (int i = 0; i < 3; ++i) {
    axes_[i].update(sight.position[i], sight.covariance(i, i), systematic[i]);
    if (std::isfinite(sight.height_without[i]) && sight.variance_without[i] > 0)
      without_[i].update(sight.height_without[i], sight.variance_without[i], systematic[2]);
  }
}

void RunwayTrack::compareSize(double T, const ApproachAngleResult::Sight& sight) {
  if (!(T > 0)) other_size_ = 0;
  if (!std::isfinite(sight.size_over_chart) || !(sight.size_over_chart_variance > 0)) return;
  const double stddev = std::sqrt(sight.size_over_chart_variance), off = std::abs(sight.size_over_chart - 1);
  if (off > kSameSize + kOtherSize.count() * stddev) {
    other_size_ = std::min(other_size_ + 1, kAgreeing);
    size_ = sight.size_over_chart;
    size_variance_ = sight.size_over_chart_variance;
  } else if (other_size_ < kAgreeing || stddev < kSameSize) {
    other_size_ = std::max(other_size_ - 1, 0);
  }
}

double RunwayTrack::protectionLevel() const {
  const ProtectionFactors factors(parameters_);
  const double height = axes_[2].value(), stddev = std::sqrt(axes_[2].variance());
  if (!std::isfinite(influences_.chart + influences_.bias)) return kUnknown;
  const double by_fault = height * std::max(kChartError * influences_.chart, kBiasError * influences_.bias);
  double level = std::max(factors.healthy * stddev, by_fault + factors.faulty * stddev);
  for (const Axis& axis : without_) {
    if (!axis.known()) continue;
    if (kContradiction.admits(axis.value() - height, axis.variance())) continue;
    level = std::max(level, factors.bound(height, axis.value(), axis.variance()));
  }
  return level;
}

}  // namespace uav_landing
