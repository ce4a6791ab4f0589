#include "landing/height/pair_input.h"

#include <cmath>

#include "integrity/tests/test_catalogue.h"
#include "results/result_check.h"
#include "rig/plane_by_turns.h"
#include "rig/plane_rate.h"

namespace uav_landing {
namespace {

ApproachAngleResult::Motion turnOf(const ApproachAngleResult& approach, bool fuse_imu) {
  const AttitudePrior& imu = approach.imu;
  if (!fuse_imu || !approach.step.failure || !imu.hasRotation()) return approach.step;
  ApproachAngleResult::Motion turn;
  turn.duration = imu.duration;
  turn.rotation = imu.rotation;
  turn.covariance.setZero();
  turn.covariance.topLeftCorner<3, 3>() = imu.rotation_covariance;
  return turn;
}

}  // namespace

PairInput::PairInput(const StereoRig& rig, const StereoDepthResult& given_stereo,
                     const ApproachAngleResult& given_approach, bool fuse_imu, bool readout_given)
    : stereo(checked(rig, given_stereo)),
      approach(checked(given_approach)),
      turn(turnOf(approach, fuse_imu)) {
  if (readout_given)
    approach.readout = {};
  else if (approach.readout.given())
    approach.readout = ReadoutEstimate::global();
  carryPlane(approach.step, approach.readout, stereo);
  takeOff(approach.plane_by_turns, stereo);
  // The repeated image shows the runway from the previous place of the camera.
  if (repeated())
    approach.runway.failure = approach.runway.threshold_failure =
        approach.sight.failure = {Reason::kInconsistent, toString(IntegrityTest::kRepeatedImage)};
}

const ApproachAngleResult::Motion& PairInput::path() const {
  const bool window_known = !approach.window.failure && std::isfinite(approach.window.angle);
  return window_known ? approach.window : approach.step;
}

std::optional<GroundNormal> PairInput::normalByMotion() const {
  const ApproachAngleResult::Motion& motion = path();
  if (motion.failure) return std::nullopt;
  return GroundNormal::of(motion.normal, motion.normal_covariance);
}

std::optional<CameraStep> cameraStep(const ApproachAngleResult::Motion& step, double height) {
  const Eigen::Vector3d& t = step.translation_over_height;
  const Eigen::Matrix3d covariance = step.covariance.bottomRightCorner<3, 3>();
  if (!t.allFinite() || !covariance.allFinite() || !(step.duration > 0) || !(height > 0)) return std::nullopt;
  // Uses the variance in all directions, because a vector that is only noise has no direction.
  return CameraStep{step.duration, t.norm() * height, height * height * covariance.trace()};
}

}  // namespace uav_landing
