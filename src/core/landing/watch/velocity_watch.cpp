#include "landing/watch/velocity_watch.h"

#include <algorithm>
#include <cmath>

#include "estimation/aircraft.h"
#include "geometry/rotation.h"
#include "height/attitude_filter.h"
#include "motion/path/approach_angle.h"

namespace uav_landing {

VelocityWatch::Verdict VelocityWatch::follow(const PairInput& in, double height, double duration_variance,
                                             PairTests& tests) {
  const ApproachAngleResult::Motion& step = in.step();
  const Eigen::Matrix3d covariance = step.covariance.bottomRightCorner<3, 3>();
  Verdict found;
  if (step.failure || !(step.duration > 0) || !(height > 0) || !covariance.allFinite()) {
    velocity_.skip(in.T);
  } else if (step.rotation.norm() > aircraft::kUnusualTurnRate * step.duration) {
    // If this turn is wrong, it would turn the velocity as well, and all later steps would contradict.
    velocity_.skip(step.duration);
  } else {
    const VelocityMemory::Step known{step.duration, rotationMatrix(step.rotation),
                                     height * step.translation_over_height, height * height * covariance,
                                     duration_variance};
    compare(in, known, tests, found);
  }
  Verdict result = verdict();
  result.change = found.change;
  if (tests.failed(IntegrityTest::kVelocity)) result.step_doubt = doubt_;
  return result;
}

VelocityWatch::Verdict VelocityWatch::verdict() const {
  Verdict result;
  result.agreed = velocity_.agreed();
  if (velocity_.sinceContradiction() < window_) result.path_doubt = doubt_;
  return result;
}

void VelocityWatch::compare(const PairInput& in, const VelocityMemory::Step& step, PairTests& tests,
                            Verdict& verdict) {
  // After a gap, windows are short at first.
  if (std::isfinite(in.approach.window.duration))
    window_ = std::min(std::max(in.approach.window.duration, window_ - in.T), longest_window_);
  const std::optional<VelocityMemory::Innovation> innovation = velocity_.follow(step);
  if (innovation) {
    tests.add(IntegrityTest::kVelocity, innovation->difference, innovation->covariance);
    verdict.change = innovation->difference;
  }
  const bool agrees = !tests.failed(IntegrityTest::kVelocity);
  if (!agrees) {
    const Eigen::Vector3d expected = step.way / step.duration - innovation->difference;
    const double off = std::abs(in.step().angle - approachAngle(in.approach.n, expected));
    const bool again = velocity_.sinceContradiction() < window_;
    doubt_ = again ? std::max(off, doubt_) : off;
  }
  velocity_.learn(step, agrees);
}

}  // namespace uav_landing
