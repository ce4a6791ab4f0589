#include <cmath>

#include "base/text.h"
#include "height/reconstruction.h"
#include "landing/height/height_measurement.h"

namespace uav_landing {
namespace {

/// Arguments of eqs (4) and (5).
struct Levelling {
  double theta, theta_variance, roll;  // rad, rad^2, rad
  bool only_on_plane;
};

Levelling levellingOf(const KalmanHeightParameters& parameters, const PairInput& in, const Ground& ground) {
  // Exactly as in the paper: no roll, and a statistical average over every depth.
  if (parameters.reconstruction_angle == ReconstructionAngle::kApproach)
    return {in.path().angle, in.path().angle_variance, 0, false};
  const Eigen::Vector3d n = ground.plane.normal();
  return {-pitchOf(n), pitchVariance(n, ground.plane.normalCovariance()), rollOf(n), true};
}

void averagePoints(const StereoRig& rig, const PairInput& in, const Ground& ground,
                   const Levelling& levelling, MeasuredHeight& measured) {
  if (!std::isfinite(levelling.theta) || !std::isfinite(levelling.theta_variance)) {
    measured.failure = in.approach.failure ? in.approach.failure : in.path().failure;
    if (!measured.failure)
      measured.failure = {Reason::kNoMotion, "no approach angle to reconstruct the height with"};
    return;
  }
  const auto average = [&](double theta) {
    return averageHeight(rig, in.stereo.points, theta, levelling.roll, levelling.only_on_plane);
  };
  const AveragedHeight averaged = average(levelling.theta);
  if (averaged.points < 2) {
    measured.failure = {Reason::kTooFewMatches, text(averaged.points, " of at least 2 points to average")};
    return;
  }
  // d height / d theta of eq (5) is the rotated depth, which is the same sum with theta a quarter turn
  // larger.
  const double by_theta = average(levelling.theta + M_PI / 2).height;
  measured.height = averaged.height;
  measured.variance = averaged.variance + by_theta * by_theta * levelling.theta_variance;
  // The scatter does not show all errors. Depths of far points are too large on average. The angle may have
  // another meaning, and some matches are off the ground. The difference from the plane's height is a measure
  // of these errors. They are the same in the next pairs.
  measured.errors.averaging = std::pow(averaged.height - ground.plane.height(), 2);
}

}  // namespace

MeasuredHeight heightByGround(const StereoRig& rig, const KalmanHeightParameters& parameters,
                              const PairInput& in, const Ground& ground) {
  MeasuredHeight measured;
  measured.errors = {parameters.height_model_error, ground.surface.unevenness,
                     ground.surface.bend_variance,  0,
                     ground.rig_variance,           0};
  measured.failure = ground.failure;
  if (measured.failure) return measured;
  const Eigen::Vector3d n = ground.plane.normal();
  measured.points_height = averageHeight(rig, in.stereo.points, -pitchOf(n), rollOf(n), true).height;
  if (parameters.height_source == HeightSource::kPlane) {
    measured.height = ground.surface.below.height();
    measured.variance = ground.plane.heightVariance();
  } else {
    averagePoints(rig, in, ground, levellingOf(parameters, in, ground), measured);
  }
  measured.variance += measured.errors.modelVariance(measured.height);
  if (!measured.failure && !(measured.height > 0 && measured.variance >= 0))
    measured.failure = {Reason::kNoPlane,
                        text("height of ", rounded(measured.height), " m is not above the ground")};
  return measured;
}

}  // namespace uav_landing
