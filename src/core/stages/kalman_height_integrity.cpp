// The integrity part of KalmanHeightStage: what a pair says with each source left out, the protection level,
// and a rig that is bent too far.

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "geometry/rotation.h"
#include "height/vertical_speed.h"
#include "rig/pair_skew.h"
#include "uav_landing/motion/approach_angle.h"
#include "uav_landing/stages/kalman_height_stage.h"
#include "uav_landing/stereo/region_planes.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;
// Edges of the runway that are farther than this from the width learned are not believed (width_height.cpp).
constexpr double kWidthTolerance = 0.02;
// Share of the matches along the rows that must hold across the rows.
constexpr double kLeastRowAgreement = 0.5;
// 1 sigma of the baseline's direction after a calibration, beside what its measurement claims, rad.
constexpr double kBaselineCalibration = 0.2 * kDegree;

}  // namespace

void KalmanHeightStage::leaveOutSources(const StereoDepthResult& stereo, const ApproachAngleResult& approach,
                                        Reconstruction& reconstruction) const {
  if (!parameters_.integrity_monitor || reconstruction.failure) return;
  const double height = reconstruction.height;
  const GroundPlane& plane = reconstruction.plane;
  const bool by_width = reconstruction.by_width;
  SolutionSeparation::Measurement everything{height, reconstruction.variance, commonVariance(height)};
  // A height by the width has nothing in it of the stereo images but depends on what the edges are.
  if (by_width) everything.common.width += std::pow(kWidthTolerance * height / 3, 2);
  reconstruction.without.fill(everything);
  if (by_width || !plane.valid()) return;

  SolutionSeparation::Measurement& stereo_alone =
      reconstruction.without[static_cast<int>(FaultySource::kVanishingPoint)];
  const GroundPlane& alone = reconstruction.alone;
  stereo_alone.height = reconstruction.stereo_height + alone.height() - plane.height();
  stereo_alone.variance = alone.heightVariance() + modelVariance(height);
  stereo_alone.common = commonVariance(height);
  stereo_alone.common.width = 0;
  stereo_alone.common.lasting +=
      GroundPlane{alone.g, reconstruction.alone_common}.heightVariance() - rig_variance_;
  // The plane that is left has not been turned by the motion's normal either.
  if (parameters_.fuse_motion_normal)
    reconstruction.without[static_cast<int>(FaultySource::kMotion)] = stereo_alone;
  leaveOutRegions(stereo, approach, reconstruction);
}

void KalmanHeightStage::leaveOutRegions(const StereoDepthResult& stereo, const ApproachAngleResult& approach,
                                        Reconstruction& reconstruction) const {
  if (stereo.points.empty()) return;
  const RegionPlanes regions = planesWithoutRegions(rig_, stereo.points, stereo.plane.g);
  const GroundPlane& alone = reconstruction.alone;
  const bool fuse = parameters_.fuse_vanishing_point && approach.vanishing_direction.allFinite() &&
                    approach.vanishing_covariance.allFinite();
  const auto withVanishingPoint = [&](const GroundPlane& plane) {
    if (!fuse) return plane;
    return fuseVanishingPoint(plane, approach.vanishing_direction, approach.vanishing_covariance,
                              std::pow(parameters_.vanishing_point_gate, 2), nullptr);
  };
  const double base = withVanishingPoint(alone).height();
  for (int i = 0; i < kImageRegions; ++i) {
    SolutionSeparation::Measurement& measurement =
        reconstruction.without[static_cast<int>(faultySource(static_cast<ImageRegion>(i)))];
    const GroundPlane& fitted = regions.without[i];
    if (!fitted.valid()) {
      measurement = {};
      continue;
    }
    const GroundPlane plane = withVanishingPoint(
        {alone.g + fitted.g - regions.all.g, fitted.covariance + reconstruction.alone_common});
    measurement.height = reconstruction.height + plane.height() - base;
    measurement.variance = plane.heightVariance() + modelVariance(measurement.height);
    measurement.common = commonVariance(measurement.height);
  }
}

void KalmanHeightStage::testPair(double T, const StereoDepthResult& stereo,
                                 const ApproachAngleResult& approach, Reconstruction& reconstruction,
                                 LandingResult& result) {
  confirming_ = false;
  if (!parameters_.integrity_monitor) return;
  if (stereo.left_repeated || stereo.right_repeated) tests_.addRatio(Consistency::kRepeatedImage, 1, 1, 0);
  // Reported alone: on real streets a tenth of the blocks is enough, so that no share is a limit.
  if (std::isfinite(stereo.photometric_agreement))
    tests_.addRatio(Consistency::kPhotometric, stereo.photometric_agreement, 1 - stereo.photometric_agreement,
                    1);
  if (std::isfinite(stereo.row_agreement))
    tests_.addRatio(Consistency::kRowAgreement, stereo.row_agreement, 1 - stereo.row_agreement,
                    1 - kLeastRowAgreement);
  const auto change = rig_change_.compare(stereo.vertical_rotation);
  if (change) tests_.add(Consistency::kRigRotation, change->difference, change->covariance);
  const bool bent = tests_.failed(Consistency::kRigRotation) || (change && change->isLarge());
  if ((bent || pairs_failed_ == 0 || !rig_change_.settled()) &&
      rig_change_.learn(T, stereo.vertical_rotation, !bent))
    rig_rotation_.startAnew(rig_change_.mean());
  testBaseline(stereo, approach.step);
  testStandstill(T, approach.step, reconstruction);
  if (!stereo.left_repeated) testVelocity(T, approach, reconstruction);
  testRegions(reconstruction);
  if (!reconstruction.by_width && std::isfinite(result.width_height) && !reconstruction.failure)
    tests_.add(Consistency::kRunwayWidth, result.width_height - reconstruction.stereo_height,
               result.width_height_variance + reconstruction.stereo_variance);
  if (reconstruction.alone.valid() && approach.vanishing_direction.allFinite()) {
    const GroundPlane& plane = reconstruction.alone;
    const Eigen::Vector3d& p = approach.vanishing_direction;
    const double h = plane.height();
    tests_.add(Consistency::kVanishingPoint, h * p.dot(plane.g),
               h * h * p.dot(plane.covariance * p) +
                   plane.normal().dot(approach.vanishing_covariance * plane.normal()));
  }
  testNormal(Consistency::kImu, reconstruction.alone, {approach.imu.normal, approach.imu.normal_covariance});
  if (!stereo.left_repeated)
    testNormal(Consistency::kMotionNormal, reconstruction.alone, normalByMotion(approach));
  // A picture once more has no angle of its own.
  reconstruction.refused = !stereo.left_repeated && failedTestOfPair();
  if (reconstruction.failure) return;
  const std::string problem = problemOfPair();
  if (problem.empty()) return;
  confirming_ = !failedTestOfPair() && rig_change_.settled();
  reconstruction.refused = !stereo.left_repeated;
  refusePair({Reason::kInconsistent, problem}, reconstruction, result);
}

void KalmanHeightStage::refusePair(const Failure& failure, Reconstruction& reconstruction,
                                   LandingResult& result) {
  reconstruction.failure = failure;
  result.raw_height = reconstruction.height;
  result.raw_height_variance = reconstruction.variance;
  result.rejected = true;
  ++consecutive_rejections_;
}

void KalmanHeightStage::testBaseline(const StereoDepthResult& stereo,
                                     const ApproachAngleResult::Motion& step) {
  const BaselineDirection& measured = stereo.baseline_direction;
  const BaselineDirection by_skew = baselineOfSkew(rig_, stereo, step);
  if (!measured.known() || !by_skew.known()) return;
  const Eigen::Matrix2d calibration = std::pow(kBaselineCalibration, 2) * Eigen::Matrix2d::Identity();
  tests_.add(Consistency::kBaselineDirection, measured.t - by_skew.t,
             measured.covariance + by_skew.covariance + calibration);
}

void KalmanHeightStage::testNormal(Consistency test, const GroundPlane& plane, const GroundNormal& normal) {
  if (!plane.valid() || !normal.known()) return;
  const Eigen::Matrix<double, 3, 2> basis = tangents(plane.normal());
  tests_.add(test, basis.transpose() * (normal.n - plane.normal()),
             basis.transpose() * (plane.normalCovariance() + normal.covariance) * basis);
}

std::optional<Consistency> KalmanHeightStage::failedTestOfPair() const {
  for (const Consistency test :
       {Consistency::kRepeatedImage, Consistency::kRowAgreement, Consistency::kRigRotation,
        Consistency::kBaselineDirection, Consistency::kStandstill, Consistency::kImageRegions})
    if (tests_.failed(test)) return test;
  return std::nullopt;
}

std::string KalmanHeightStage::problemOfPair() {
  if (const std::optional<Consistency> test = failedTestOfPair()) {
    pairs_failed_ = std::min(pairs_failed_ + 1, kConfirmations);
    pairs_passed_ = 0;
    return toString(*test);
  }
  if (!rig_change_.settled()) {
    pairs_passed_ = 0;
    return "rig_rotation: another one than before is not known for long enough";
  }
  if (speed_.stands()) return "standstill: no motion has been seen since for long enough";
  if (pairs_failed_ == 0) return "";
  // Among pairs of a lasting fault some pass by chance: as many in a row are asked for as failed.
  if (++pairs_passed_ >= pairs_failed_) {
    pairs_failed_ = pairs_passed_ = 0;
    return "";
  }
  return text(pairs_passed_, " of ", pairs_failed_, " pairs that pass the tests again");
}

void KalmanHeightStage::testStandstill(double T, const ApproachAngleResult::Motion& step,
                                       const Reconstruction& reconstruction) {
  const std::optional<CameraStep> way = cameraStep(step, heightSoFar(reconstruction));
  if (!way) return speed_.skip(std::max(T, 0.0));
  const std::optional<SpeedMemory::Shortfall> shortfall = speed_.compare(*way);
  if (shortfall) tests_.addOneSided(Consistency::kStandstill, shortfall->difference, shortfall->variance);
  speed_.learn(*way, !tests_.failed(Consistency::kStandstill));
}

void KalmanHeightStage::testVelocity(double T, const ApproachAngleResult& approach,
                                     Reconstruction& reconstruction) {
  const ApproachAngleResult::Motion& step = approach.step;
  const double height = heightSoFar(reconstruction);
  const Eigen::Matrix3d covariance = step.covariance.bottomRightCorner<3, 3>();
  if (step.failure || !(step.duration > 0) || !(height > 0) || !covariance.allFinite())
    return velocity_.skip(std::max(T, 0.0));
  // A turn that may be a wrong one would turn the velocity, and contradict all that comes.
  if (step.rotation.norm() > AttitudeFilter::kUnusualTurn * step.duration)
    return velocity_.skip(step.duration);
  // After a gap windows are short at first.
  if (std::isfinite(approach.window.duration))
    window_ = std::min(std::max(approach.window.duration, window_ - T), parameters_.reset_timeout);
  const VelocityMemory::Step known{step.duration, rotationMatrix(step.rotation),
                                   height * step.translation_over_height, height * height * covariance,
                                   stamps_.ofDuration()};
  const std::optional<VelocityMemory::Innovation> innovation = velocity_.follow(known);
  if (innovation) {
    tests_.add(Consistency::kVelocity, innovation->difference, innovation->covariance);
    reconstruction.velocity_change = innovation->difference;
  }
  const bool agrees = !tests_.failed(Consistency::kVelocity);
  if (!agrees) {
    const Eigen::Vector3d expected = known.way / known.duration - innovation->difference;
    const double off = std::abs(step.angle - approachAngle(approach.n, expected));
    const bool again = velocity_.sinceContradiction() < window_;
    path_doubt_ = again ? std::max(off, path_doubt_) : off;
  }
  velocity_.learn(known, agrees);
}

void KalmanHeightStage::testRegions(const Reconstruction& reconstruction) {
  if (reconstruction.failure || reconstruction.by_width) return;
  double worst = 0, difference = 0, variance = 0;
  int count = 0;
  for (int i = 0; i < kImageRegions; ++i) {
    const SolutionSeparation::Measurement& without =
        reconstruction.without[static_cast<int>(faultySource(static_cast<ImageRegion>(i)))];
    if (!without.known()) continue;
    ++count;
    const double d = without.height - reconstruction.height;
    // The whole has the rest in it, but the grey levels besides.
    const double allowed = without.variance;
    if (d * d <= worst * allowed) continue;
    worst = d * d / allowed;
    difference = d;
    variance = allowed;
  }
  if (count > 0) tests_.addLargest(Consistency::kImageRegions, difference, variance, count);
}

void KalmanHeightStage::testMemory(double T, const Reconstruction& reconstruction,
                                   const ApproachAngleResult& approach, LandingResult& result) {
  if (!parameters_.integrity_monitor) return;
  const std::optional<HeightMemory::Expected> before = memory_.expected();
  const double scale = before ? before->height : filter_.initialised() ? filter_.state()[0] : kUnknown;
  VerticalSpeed speed;
  double velocity = kUnknown;
  const Eigen::Vector3d normal = reconstruction.plane.valid() ? reconstruction.normal.n : approach.n;
  // While normals contradict each other nobody knows which part of the motion was downwards.
  const bool level_known = normal.allFinite() && !tests_.failed(Consistency::kTilt);
  if (!approach.step.failure && level_known && std::isfinite(scale) && scale > 0) {
    const GroundPlane plane{normal / scale, Eigen::Matrix3d::Zero()};
    speed = withStamps(verticalSpeed(approach.step, plane, scale, 0, 0, parameters_.acceleration_stddev));
    velocity = approach.step.translation_over_height.norm() * scale / approach.step.duration;
    // A normal that is doubted makes it as wrong as the angle.
    speed.variance += velocity * velocity * varianceByNormals(reconstruction, approach, approach.step);
  }
  if (T > 0) memory_.carry(T, speed.speed, speed.variance, velocity);
  const std::optional<HeightMemory::Expected> expected = memory_.expected();
  if (expected && filter_.initialised())
    tests_.add(Consistency::kSinkRate, filter_.state()[0] - expected->height,
               expected->variance + filter_.ownCovariance()(0, 0) + modelVariance(expected->height));
  const bool agrees = !tests_.failed(Consistency::kSinkRate);
  if (!agrees) {
    const double off = filter_.state()[0] - expected->height;
    refuse(result, {Reason::kInconsistent, text("sink_rate: the height is off by ", rounded(off),
                                                " m from the one before and the motion since")});
  }
  memory_.refresh(filter_, agrees,
                  std::max(parameters_.alert_limit, parameters_.alert_limit_relative * scale));
}

void KalmanHeightStage::awaitRecovery(double T, LandingResult& result) {
  if (!parameters_.integrity_monitor) return;
  // A pair that passes, but not as long as others failed, is left out and contradicts nothing.
  const bool contradicted = (result.rejected && !confirming_) || tests_.failed(Consistency::kSinkRate);
  Recovery::Pair pair = Recovery::Pair::kSilent;
  if (contradicted)
    pair = Recovery::Pair::kContradicts;
  else if ((confirming_ || result.status == Status::kTracking) &&
           !tests_.failed(Consistency::kVanishingPoint))  // says that what was contradicted is still wrong
    pair = Recovery::Pair::kAgrees;
  // What is missing without a contradiction is no fault.
  const bool outdated = consecutive_rejections_ > 0 && result.stamp - last_accepted_ > parameters_.max_age;
  // Nor does anything say which of the first heights is wrong that contradict each other.
  const bool disputed = contradicted && confirmations_ < kConfirmations;
  recovery_.follow(std::min(T, parameters_.max_age), pair,
                   outdated || disputed || tests_.failed(Consistency::kSinkRate));
  if (!recovery_.pending()) return;
  refuse(result, {Reason::kInconsistent,
                  text("after contradictions nothing has contradicted for ", rounded(recovery_.quiet()),
                       " s only, ", parameters_.recovery_time, " s needed")});
}

void KalmanHeightStage::refuse(LandingResult& result, const Failure& failure) const {
  result.height_valid = false;
  if (!result.failure) result.failure = failure;
}

void KalmanHeightStage::reportProtection(const Eigen::Vector3d& normal, LandingResult& result) const {
  if (!parameters_.integrity_monitor || !std::isfinite(result.height)) return;
  SolutionSeparation::Level level =
      separation_.protectionLevel(result.height, result.height_variance, varianceFactor());
  // Of the last pair that is not a picture once more.
  const double since = std::isfinite(ground_height_) ? result.height - ground_height_ : 0;
  if (const std::optional<GroundMemory::Below> below = ground_.below(normal))
    level = separation_.larger(level, result.height, below->height + since, below->variance, "surface_below");
  result.height_protection_level = level.bound;
  result.protection_source = level.source;
  result.height_alert_limit =
      std::max(parameters_.alert_limit, parameters_.alert_limit_relative * result.height);
  if (level.bound <= result.height_alert_limit) return;
  refuse(result, {Reason::kUncertain, text("height ", rounded(result.height), " m has a protection level of ",
                                           rounded(level.bound), " m because of ", level.source,
                                           ", alert limit ", rounded(result.height_alert_limit), " m")});
}

void KalmanHeightStage::reportRig(LandingResult& result) const {
  if (!parameters_.rig_watch) return;
  constexpr double kSigmas = 3;
  constexpr const char* kAxes[] = {"pitch", "yaw", "roll"};
  result.rig_rotation = rig_rotation_.rotation();
  if (!result.rig_rotation.known()) return;
  for (int i = 0; i < 3; ++i) {
    const double angle = result.rig_rotation.w[i];
    const double stddev = std::sqrt(result.rig_rotation.covariance(i, i));
    if (std::abs(angle) - kSigmas * stddev <= parameters_.max_rig_rotation_deg * kDegree) continue;
    result.height_valid = result.angle_valid = false;
    result.forgetPosition();
    result.failure = {Reason::kRigBent,
                      text("the right camera's ", kAxes[i], " is off its calibration by ",
                           rounded(angle / kDegree), " deg with 1 sigma of ", rounded(stddev / kDegree),
                           " deg, at most ", parameters_.max_rig_rotation_deg, " deg allowed")};
    return;
  }
}

}  // namespace uav_landing
