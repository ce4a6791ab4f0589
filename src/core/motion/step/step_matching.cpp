#include "motion/step/step_matching.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/rotation.h"
#include "uav_landing/results/consistency_test.h"

namespace uav_landing {
namespace {

// Whether the prior allows the rotation that the matches show.
bool agrees(const MotionEstimate& estimate, const RotationPrior& prior) {
  static const double gate = chiSquareLimit(1e-3, 3);
  const Eigen::Vector3d off = rotationVector(estimate.motion.R * prior.R.transpose());
  return off.dot(prior.covariance.inverse() * off) <= gate;
}

}  // namespace

StepMatching::StepMatching(const StereoRig& rig, cv::Mat mask, const ApproachAngleParameters& parameters)
    : rig_(rig), mask_(std::move(mask)), parameters_(parameters) {}

int StepMatching::wideSteps() const { return static_cast<int>(std::ceil(parameters_.search_radius)); }

std::vector<TemporalMatch> StepMatching::match(const StepImages& step,
                                               const std::vector<TrackedCorner>& corners,
                                               const CameraMotion& predicted, int coarse_steps,
                                               std::vector<TemporalMatch> list) const {
  step.memory.matching.spare = std::move(list);
  std::vector<TemporalMatch> matches =
      matchOverTime(framesOf(step), corners, overGround(step, predicted, step.times), options(coarse_steps),
                    step.memory.matching);
  shiftByReadout(step, predicted, matches);
  return matches;
}

TemporalMatchOptions StepMatching::options(int coarse_steps) const {
  return {parameters_.window_radius, parameters_.min_zncc, coarse_steps};
}

void StepMatching::shiftByReadout(const StepImages& step, const CameraMotion& motion,
                                  std::vector<TemporalMatch>& matches) const {
  uav_landing::shiftByReadout(rig_, overGround(step, motion, step.doubt.times), step.doubt.time, matches);
}

MotionOverGround StepMatching::overGround(const StepImages& step, const CameraMotion& motion,
                                          const RowTimes* times) const {
  MotionOverGround over_ground{motion, step.normal.vector()};
  if (times == nullptr || times->atOnce() || !(step.duration > 0)) return over_ground;
  const double height_then = 1 + step.normal.vector().dot(motion.t);
  const StepEnds ends = step.rates.ends(motion, step.duration, height_then);
  over_ground.rows = {times, ends.now, ends.then};
  return over_ground;
}

MotionPrior StepMatching::priorOf(const StepImages& step, const CameraMotion& start,
                                  const RotationPrior* rotation) const {
  return {start, step.normal, rotation, step.row_doubt};
}

Expected<MotionEstimate> StepMatching::estimate(const StepImages& step, const CameraMotion& start,
                                                const std::vector<TemporalMatch>& matches, int fewest) const {
  if (step.rotation != nullptr) {
    // The prior already gives three of the six unknowns.
    const int needed = std::max(kFewestScouts, fewest / 2);
    const Expected<MotionEstimate> aided =
        estimateMotion(rig_, matches, priorOf(step, start, step.rotation), needed, step.memory.motion);
    if (aided && agrees(*aided, *step.rotation)) return aided;
  }
  return estimateMotion(rig_, matches, priorOf(step, start, nullptr), fewest, step.memory.motion);
}

bool StepMatching::carryRowsAlike(const StepImages& step, const CameraMotion& a,
                                  const CameraMotion& b) const {
  constexpr double kAlike = 0.3;  // sigma
  const auto uneven = [&](const CameraMotion& motion) -> Eigen::Vector3d {
    const StepEnds ends = step.rates.ends(motion, step.duration, 1);
    return ends.now.w - ends.then.w;
  };
  const double readout = step.doubt.times != nullptr ? step.doubt.time : step.times->readoutTime();
  const double turn = readout * readout * (uneven(a) - uneven(b)).squaredNorm();
  return turn <= kAlike * kAlike * step.row_doubt.turn.trace();
}

double StepMatching::likeness(const StepImages& step, const std::vector<TrackedCorner>& corners,
                              const CameraMotion& motion) const {
  return likenessOverTime(framesOf(step), corners, overGround(step, motion, step.times), options(0));
}

}  // namespace uav_landing
