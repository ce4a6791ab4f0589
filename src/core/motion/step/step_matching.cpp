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

RowDoubt rowDoubt(const StepImages& step) {
  return {rollingRows(step.times, step.doubt), step.shake, step.doubt.normal_by_time};
}

}  // namespace

StepMatching::StepMatching(const StereoRig& rig, cv::Mat mask, const ApproachAngleParameters& parameters)
    : rig_(rig), mask_(std::move(mask)), parameters_(parameters) {}

int StepMatching::wideSteps() const { return static_cast<int>(std::ceil(parameters_.search_radius)); }

std::vector<TemporalMatch> StepMatching::match(const StepImages& step,
                                               const std::vector<TrackedCorner>& corners,
                                               const CameraMotion& predicted, int coarse_steps,
                                               std::vector<TemporalMatch> list) const {
  std::vector<TemporalMatch> matches = matchOverTime(rig_, step.now, step.then, mask_, corners, step.normal,
                                                     predicted, options(step, predicted, coarse_steps),
                                                     step.textures, step.memory.matching, std::move(list));
  shiftByReadout(step, predicted, matches);
  return matches;
}

TemporalMatchOptions StepMatching::options(const StepImages& step, const CameraMotion& predicted,
                                           int coarse_steps) const {
  return {parameters_.window_radius, parameters_.min_zncc, coarse_steps, rowsBy(step, step.times, predicted)};
}

void StepMatching::shiftByReadout(const StepImages& step, const CameraMotion& motion,
                                  std::vector<TemporalMatch>& matches) const {
  uav_landing::shiftByReadout(rig_, rowsBy(step, step.doubt.times, motion), motion, step.normal,
                              step.doubt.time, matches);
}

RowsOverTime StepMatching::rowsBy(const StepImages& step, const RowTimes* times,
                                  const CameraMotion& predicted) const {
  if (times == nullptr || times->atOnce() || !(step.duration > 0)) return {};
  const RowMotion now = evenMotion(predicted, step.duration);
  const double height_then = 1 + step.normal.dot(predicted.t);
  return {times, now,
          step.rows_then.value_or(RowMotion{now.w, predicted.R.transpose() * now.v / height_then})};
}

Expected<MotionEstimate> StepMatching::estimate(const StepImages& step, const CameraMotion& start,
                                                const std::vector<TemporalMatch>& matches, int fewest) const {
  if (step.rotation != nullptr) {
    // The prior already gives three of the six unknowns.
    const int needed = std::max(kFewestScouts, fewest / 2);
    const Expected<MotionEstimate> aided =
        estimateMotion(rig_, matches, step.normal, step.normal_covariance, start, needed, step.memory.motion,
                       step.rotation, rowDoubt(step));
    if (aided && agrees(*aided, *step.rotation)) return aided;
  }
  return estimateMotion(rig_, matches, step.normal, step.normal_covariance, start, fewest, step.memory.motion,
                        nullptr, rowDoubt(step));
}

double StepMatching::likeness(const StepImages& step, const std::vector<TrackedCorner>& corners,
                              const CameraMotion& motion) const {
  return likenessOverTime(rig_, step.now, step.then, mask_, corners, step.normal, motion,
                          options(step, motion, 0));
}

}  // namespace uav_landing
