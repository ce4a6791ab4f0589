#include "landing/watch/pair_monitor.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "geometry/rotation.h"
#include "rig/pair_skew.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;
// 1 sigma of the baseline's direction after a calibration, in addition to the claim of its measurement, rad.
constexpr double kBaselineCalibration = 0.2 * kDegree;

/// Tests the normal from stereo alone against one from another source.
void testNormal(IntegrityTest test, const GroundPlane& plane, const std::optional<GroundNormal>& normal,
                PairTests& tests) {
  if (!plane.valid() || !normal) return;
  const Eigen::Matrix<double, 3, 2> basis = tangents(plane.normal());
  tests.add(test, basis.transpose() * (normal->vector() - plane.normal()),
            basis.transpose() * (plane.normalCovariance() + normal->covariance()) * basis);
}

void testImages(const PairInput& in, PairTests& tests) {
  const StereoDepthResult& stereo = in.stereo;
  if (stereo.left_repeated || stereo.right_repeated) tests.addRatio(IntegrityTest::kRepeatedImage, 1, 1);
  if (std::isfinite(stereo.photometric_agreement))
    tests.addRatio(IntegrityTest::kPhotometric, stereo.photometric_agreement,
                   1 - stereo.photometric_agreement);
  if (std::isfinite(stereo.row_agreement))
    tests.addRatio(IntegrityTest::kRowAgreement, stereo.row_agreement, 1 - stereo.row_agreement);
}

/// Both motions enter the published angle. The worse one is tested.
void testRowMotion(const ApproachAngleResult& approach, PairTests& tests) {
  const auto ratio = [](const ApproachAngleResult::Motion& motion) {
    return std::isfinite(motion.row_motion) ? motion.row_motion / motion.row_motion_limit : -1;
  };
  const ApproachAngleResult::Motion& worse =
      ratio(approach.step) > ratio(approach.window) ? approach.step : approach.window;
  tests.add(IntegrityTest::kRowMotion, worse.row_motion, std::pow(worse.row_motion_limit, 2));
}

void testRegions(const MeasuredHeight& measured, PairTests& tests) {
  double worst = 0, difference = 0, variance = 0;
  int count = 0;
  for (int i = 0; i < kImageRegions; ++i) {
    const SolutionSeparation::Measurement& without =
        measured.without[static_cast<int>(faultySource(static_cast<ImageRegion>(i)))];
    if (!without.known()) continue;
    ++count;
    const double d = without.height - measured.height;
    // The full height uses the other regions and, in addition, grey levels. So the variance without the
    // region serves as that of the difference.
    const double allowed = without.variance;
    if (d * d <= worst * allowed) continue;
    worst = d * d / allowed;
    difference = d;
    variance = allowed;
  }
  if (count > 0) tests.addLargest(IntegrityTest::kImageRegions, difference, variance, count);
}

void testWidth(const MeasuredHeight& measured, PairTests& tests) {
  if (!std::isfinite(measured.width_height)) return;
  tests.add(IntegrityTest::kRunwayWidth, measured.width_height - measured.stereo_height,
            measured.width_height_variance + measured.stereo_variance);
}

/// Tests stereo alone against the other sources of the ground's direction.
void testDirections(const PairInput& in, const Ground& ground, PairTests& tests) {
  const ApproachAngleResult& approach = in.approach;
  const GroundPlane& plane = ground.alone;
  if (plane.valid() && approach.vanishing_direction.allFinite()) {
    const Eigen::Vector3d& p = approach.vanishing_direction;
    const double h = plane.height();
    tests.add(IntegrityTest::kVanishingPoint, h * p.dot(plane.g),
              h * h * p.dot(plane.covariance * p) +
                  plane.normal().dot(approach.vanishing_covariance * plane.normal()));
  }
  testNormal(IntegrityTest::kImu, plane,
             GroundNormal::of(approach.imu.normal, approach.imu.normal_covariance), tests);
  if (!in.repeated()) testNormal(IntegrityTest::kMotionNormal, plane, in.normalByMotion(), tests);
}

}  // namespace

PairMonitor::PairMonitor(const StereoRig& rig, const KalmanHeightParameters& parameters)
    : rig_(rig),
      parameters_(parameters),
      speed_(parameters.max_deceleration),
      velocity_(parameters.reset_timeout) {}

PairVerdict PairMonitor::check(const PairInput& in, const Ground& ground, const MeasuredHeight& measured,
                               const HeightPrior& prior, double duration_variance) {
  PairVerdict verdict(PairTests(parameters_.false_alarm_rate, parameters_.gate));
  PairTests& tests = verdict.tests;
  const bool has_height = !measured.failure;
  if (std::isfinite(ground.tilt_ratio)) tests.addRatio(IntegrityTest::kTilt, ground.tilt, ground.tilt_ratio);
  if (ground.tilted && has_height)
    verdict.failure = {Reason::kRejected,
                       text("the ground plane is tilted by ", rounded(ground.tilt / kDegree),
                            " deg against the pairs before and the rotation since")};
  if (!parameters_.integrity_monitor) return verdict;

  const double height = prior.heightOr(measured.height);
  testImages(in, tests);
  testRig(in, verdict);
  testBaseline(in, tests);
  if (!in.repeated()) testRowMotion(in.approach, tests);
  testStandstill(in, height, tests);
  verdict.velocity =
      in.repeated() ? velocity_.verdict() : velocity_.follow(in, height, duration_variance, tests);
  if (has_height && !ground.tilted && !measured.by_width) {
    testRegions(measured, tests);
    testWidth(measured, tests);
  }
  testDirections(in, ground, tests);

  const auto failed = tests.firstFailed(TestStep::kPair, OnFailure::kPairLeftOut);
  verdict.rig_believed = !failed;
  // A repeated image has no angle of its own.
  verdict.angle_refused = !in.repeated() && failed;
  if (!has_height || verdict.failure) return verdict;
  const std::string problem = problemOf(failed);
  if (problem.empty()) return verdict;
  verdict.failure = {Reason::kInconsistent, problem};
  verdict.confirming = !failed && rig_change_.settled();
  verdict.angle_refused = !in.repeated();
  return verdict;
}

void PairMonitor::testRig(const PairInput& in, PairVerdict& verdict) {
  const RigRotation& measured = in.stereo.vertical_rotation;
  const std::optional<RigChange::Innovation> change = rig_change_.compare(measured);
  if (change) verdict.tests.add(IntegrityTest::kRigRotation, change->difference, change->covariance);
  const bool bent = verdict.tests.failed(IntegrityTest::kRigRotation) || (change && change->isLarge());
  if ((bent || failed_ == 0 || !rig_change_.settled()) && rig_change_.learn(in.T, measured, !bent))
    verdict.rig_turned = rig_change_.mean();
}

// Tests the direction to the right camera, as the rows of this pair show it, against the calibration and the
// skew.
void PairMonitor::testBaseline(const PairInput& in, PairTests& tests) const {
  const BaselineDirection& measured = in.stereo.baseline_direction;
  const BaselineDirection by_skew = baselineOfSkew(rig_, in.stereo, in.step());
  if (!measured.known() || !by_skew.known()) return;
  const Eigen::Matrix2d calibration = std::pow(kBaselineCalibration, 2) * Eigen::Matrix2d::Identity();
  tests.add(IntegrityTest::kBaselineDirection, measured.t - by_skew.t,
            measured.covariance + by_skew.covariance + calibration);
}

// Tests the distance since the previous pair against the speed in earlier steps.
void PairMonitor::testStandstill(const PairInput& in, double height, PairTests& tests) {
  const std::optional<CameraStep> way = cameraStep(in.step(), height);
  if (!way) return speed_.skip(in.T);
  const std::optional<SpeedMemory::Shortfall> shortfall = speed_.compare(*way);
  if (shortfall) tests.addOneSided(IntegrityTest::kStandstill, shortfall->difference, shortfall->variance);
  speed_.learn(*way, !tests.failed(IntegrityTest::kStandstill));
}

// Returns why the pair is rejected, or "".
std::string PairMonitor::problemOf(const std::optional<IntegrityTest>& failed) {
  if (failed) {
    failed_ = std::min(failed_ + 1, HeightTrack::kConfirmations);
    passed_ = 0;
    return toString(*failed);
  }
  if (!rig_change_.settled()) {
    passed_ = 0;
    return "rig_rotation: another one than before is not known for long enough";
  }
  if (speed_.stands()) return "standstill: no motion has been seen since for long enough";
  if (failed_ == 0) return "";
  // During a lasting fault, some pairs pass by chance. So as many passes in a row are required as pairs
  // failed.
  if (++passed_ >= failed_) {
    failed_ = passed_ = 0;
    return "";
  }
  return text(passed_, " of ", failed_, " pairs that pass the tests again");
}

}  // namespace uav_landing
