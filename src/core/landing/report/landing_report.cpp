#include "landing/report/landing_report.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;

/// Relative change of the depth of the points on the plane, in units of the height, if the ground has the
/// normal b instead of a.
double depthChange(const StereoRig& rig, const std::vector<StereoDepthResult::Point>& points,
                   const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  double by_a = 0, by_b = 0;
  for (const StereoDepthResult::Point& point : points) {
    if (!point.on_plane) continue;
    const Eigen::Vector3d ray = rig.ray(point.u, point.v);
    by_a += a.dot(ray);
    by_b += b.dot(ray);
  }
  return by_a > 0 && by_b > 0 ? by_a / by_b - 1 : 0;
}

/// Part of the velocity's covariance that the step does not know. depth_change: relative change that was
/// applied to lengths.
Eigen::Matrix3d doubtOfVelocity(const PairInput& in, const PairVerdict& pair, const Eigen::Vector3d& velocity,
                                double depth_change, double angle_variance) {
  Eigen::Matrix3d doubt = Eigen::Matrix3d::Zero();
  // After a gap the aircraft may really have become that fast, but a wrong step is as likely.
  if (pair.tests.result(IntegrityTest::kVelocity).ratio > AttitudeFilter::kDoubtful.squared())
    doubt += pair.velocity.change * pair.velocity.change.transpose();
  doubt += depth_change * depth_change * velocity * velocity.transpose();
  // With another normal, the vertical part is as uncertain as the angle.
  if (const std::optional<GroundNormal> normal = normalOfAngle(in.approach, in.step())) {
    const Eigen::Vector3d& n = normal->vector();
    doubt += velocity.squaredNorm() * angle_variance * n * n.transpose();
  }
  return doubt;
}

}  // namespace

void addFailure(LandingResult& result, const Failure& failure) {
  if (!result.failure) result.failure = failure;
}

void refuseHeight(LandingResult& result, const Failure& failure) {
  if (!failure) return;
  result.height_valid = false;
  addFailure(result, failure);
}

void reportHeight(const MeasuredHeight& measured, const PairVerdict& pair, const TrackVerdict& post,
                  LandingResult& result) {
  result.points_height = measured.points_height;
  result.width_height = measured.width_height;
  result.width_height_variance = measured.width_height_variance;
  if (!measured.failure) {
    result.raw_height = measured.height;
    result.raw_height_variance = measured.variance;
  }
  result.innovation = post.innovation;
  result.innovation_variance = post.innovation_variance;
  result.rejected = pair.leftOut() || post.rejection;
  result.consecutive_rejections = post.consecutive_rejections;
  result.status = post.status;
  result.height = post.height;
  result.height_variance = post.height_variance;
  result.vertical_speed = post.vertical_speed;
  result.vertical_speed_variance = post.vertical_speed_variance;
  result.height_valid = post.height_valid;
  for (const Failure& failure : {measured.failure, pair.failure, post.rejection, post.failure})
    addFailure(result, failure);
}

void reportProtection(const HeightTrack& track, const std::optional<GroundMemory::Below>& below,
                      const KalmanHeightParameters& parameters, LandingResult& result) {
  const SolutionSeparation::Level level = track.protectionLevel(result.height, result.height_variance, below);
  result.height_protection_level = level.bound;
  result.protection_source = level.source;
  result.height_alert_limit =
      std::max(parameters.alert_limit, parameters.alert_limit_relative * result.height);
  if (level.bound <= result.height_alert_limit) return;
  refuseHeight(result,
               {Reason::kUncertain, text("height ", rounded(result.height), " m has a protection level of ",
                                         rounded(level.bound), " m because of ", level.source,
                                         ", alert limit ", rounded(result.height_alert_limit), " m")});
}

void reportAngle(const PairInput& in, const Ground& ground, const PathDoubt& doubt,
                 const VelocityWatch::Verdict& velocity, LandingResult& result) {
  const ApproachAngleResult::Motion &step = in.step(), &path = in.path();
  result.foe = in.approach.foe;
  result.raw_approach_angle = step.angle;
  result.raw_approach_angle_variance =
      step.angle_variance + doubt.variance(in, ground, step) + velocity.step_doubt * velocity.step_doubt;
  result.approach_angle = path.angle;
  result.approach_angle_variance =
      path.angle_variance + doubt.variance(in, ground, path) + velocity.path_doubt * velocity.path_doubt;
}

void judgeAngle(const PairInput& in, const Failure& refusal, double max_stddev_deg, LandingResult& result) {
  Failure failure = in.approach.failure ? in.approach.failure : in.path().failure;
  if (!failure) failure = refusal;
  if (!failure && !std::isfinite(result.approach_angle))
    failure = {Reason::kNoMotion, "the approach angle is not finite"};
  const double stddev = std::sqrt(result.approach_angle_variance);
  if (!failure && !(stddev <= max_stddev_deg * kDegree))
    failure = {Reason::kUncertain, text("approach angle has 1 sigma of ", rounded(stddev / kDegree),
                                        " deg, more than ", max_stddev_deg, " deg")};
  result.angle_valid = !failure;
  addFailure(result, failure);
}

Failure refusalOf(const MeasuredHeight& measured, const PairVerdict& pair, const Failure& otherwise) {
  const Failure& of_height = measured.failure ? measured.failure : pair.failure;
  return pair.angle_refused && of_height ? of_height : otherwise;
}

StepScale scaleOfStep(const StereoRig& rig, const PairInput& in, const Ground& ground,
                      const LandingResult& result) {
  // The lengths of the step come from depths of a normal that does not know the rig's rotation.
  const Eigen::Vector3d& n = in.approach.n;
  const bool another = ground.plane.valid() && n.allFinite();
  const double change = another ? depthChange(rig, in.stereo.points, n, ground.plane.normal()) : 0;
  return {result.height - ground.surface.bend, result.height_variance, change};
}

CameraTwist believedTwist(const PairInput& in, const PairVerdict& pair, const StepScale& scale,
                          const MotionDoubt& doubt) {
  CameraTwist twist = cameraTwist(in.step(), (1 + scale.length_change) * scale.height, scale.variance,
                                  doubt.duration_variance);
  twist.covariance.topLeftCorner<3, 3>() +=
      doubtOfVelocity(in, pair, twist.velocity, scale.length_change, doubt.angle_variance);
  return twist;
}

void reportTwist(const CameraTwist& twist, LandingResult& result) {
  result.velocity = twist.velocity;
  result.angular_velocity = twist.angular_velocity;
  result.twist_covariance = twist.covariance;
}

void reportRig(const RigRotation& rotation, double max_rotation_deg, LandingResult& result) {
  constexpr double kSigmas = 3;
  constexpr const char* kAxes[] = {"pitch", "yaw", "roll"};
  result.rig_rotation = rotation;
  if (!rotation.known()) return;
  for (int i = 0; i < 3; ++i) {
    const double angle = rotation.w[i], stddev = std::sqrt(rotation.covariance(i, i));
    if (std::abs(angle) - kSigmas * stddev <= max_rotation_deg * kDegree) continue;
    result.height_valid = result.angle_valid = false;
    result.forgetPosition();
    result.failure = {Reason::kRigBent,
                      text("the right camera's ", kAxes[i], " is off its calibration by ",
                           rounded(angle / kDegree), " deg with 1 sigma of ", rounded(stddev / kDegree),
                           " deg, at most ", max_rotation_deg, " deg allowed")};
    return;
  }
}

}  // namespace uav_landing
