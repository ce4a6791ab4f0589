#include "motion/step_search.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/thinned.h"
#include "geometry/rotation.h"
#include "uav_landing/results/consistency_test.h"

namespace uav_landing {
namespace {

// Share of the followed corners that must agree with a motion that grew from the last one.
constexpr double kLeastShare = 0.35;

// In how many searches in a row that few corners agree with all of them are compared.
constexpr int kUnsureInterval = 10;

// By how much the prediction is off at any corner, pixels, see Steadiness: refinement finds what is within
// two.
constexpr double kSteadyOff = 0.75, kMostOff = 1.0;

// Fewest matches that make a motion good enough to search from.
constexpr int kFewestScouts = 6;

double shareOf(const MotionEstimate& estimate, const StepImages& step) {
  return estimate.inlier_count / static_cast<double>(step.corners.size());
}

// The rotation that the matches want is one that the prior allows.
bool agrees(const MotionEstimate& estimate, const RotationPrior& prior) {
  static const double gate = chiSquareLimit(1e-3, 3);
  const Eigen::Vector3d off = rotationVector(estimate.motion.R * prior.R.transpose());
  return off.dot(prior.covariance.inverse() * off) <= gate;
}

// Straight ahead over the ground by these shares of the height; what is between them, rotation and sinking
// is left to the search for each corner.
std::vector<CameraMotion> guesses(const Eigen::Vector3d& normal, const Eigen::Matrix3d& R) {
  const Eigen::Vector3d ahead = (Eigen::Vector3d::UnitZ() - normal.z() * normal).normalized();
  std::vector<CameraMotion> guesses;
  for (const double share : {0.0, 0.03, 0.07, 0.13, 0.22, 0.35, 0.55, 0.8, 1.1})
    guesses.push_back({R, share * ahead});
  return guesses;
}

}  // namespace

StepSearch::StepSearch(const StereoRig& rig, cv::Mat mask, const ApproachAngleParameters& parameters)
    : rig_(rig), mask_(std::move(mask)), parameters_(parameters), steadiness_(kSteadyOff, kMostOff) {}

int StepSearch::wideSteps() const { return static_cast<int>(std::ceil(parameters_.search_radius)); }

TemporalMatchOptions StepSearch::options(int coarse_steps) const {
  return {parameters_.window_radius, parameters_.min_zncc, coarse_steps};
}

std::vector<TemporalMatch> StepSearch::match(const StepImages& step,
                                             const std::vector<TrackedCorner>& corners,
                                             const CameraMotion& predicted, int coarse_steps,
                                             std::vector<TemporalMatch> list) const {
  TemporalMatchOptions wanted = options(coarse_steps);
  wanted.rows = rowsBy(step, predicted);
  return matchOverTime(rig_, step.now, step.then, mask_, corners, step.normal, predicted, wanted,
                       step.textures, step.memory.matching, std::move(list));
}

RowsOverTime StepSearch::rowsBy(const StepImages& step, const CameraMotion& predicted) const {
  if (step.times == nullptr || step.times->atOnce() || !(step.duration > 0)) return {};
  const RowMotion now = evenMotion(predicted, step.duration);
  const double height_then = 1 + step.normal.dot(predicted.t);
  return {step.times, now,
          step.rows_then.value_or(RowMotion{now.w, predicted.R.transpose() * now.v / height_then})};
}

Expected<MotionEstimate> StepSearch::find(const StepImages& step,
                                          const std::vector<CameraMotion>& predictions,
                                          std::vector<TemporalMatch>& matches) {
  const Expected<MotionEstimate> found = findMotion(step, predictions, matches);
  if (!found || step.times == nullptr || step.times->atOnce()) return found;
  // Rows were carried to the stamps by the motion of before, which this one is not quite.
  matches = match(step, step.corners, found->motion, 0, std::move(matches));
  return estimate(step, found->motion, matches, parameters_.min_matches);
}

Expected<MotionEstimate> StepSearch::findMotion(const StepImages& step,
                                                const std::vector<CameraMotion>& predictions,
                                                std::vector<TemporalMatch>& matches) {
  Expected<MotionEstimate> estimate = tl::make_unexpected(Failure{Reason::kNotYet, ""});
  const auto good = [&] { return estimate && estimate->inlier_count >= kLeastShare * matches.size(); };
  if (!predictions.empty() && step.regular && steadiness_.goesWithout()) {
    estimate = followSteadily(step, predictions.front(), matches);
    if (estimate) return estimate;
  }
  steadiness_.searched();
  for (const CameraMotion& predicted : predictions) {
    estimate = followFrom(step, predicted, matches);
    if (!good()) continue;
    steadiness_.note(shareOf(*estimate, step), farthestOff(step, predicted, *estimate, matches));
    return estimate;
  }
  steadiness_.lose();
  std::vector<Eigen::Matrix3d> rotations{Eigen::Matrix3d::Identity()};
  if (step.rotation != nullptr) rotations.insert(rotations.begin(), step.rotation->R);
  for (const Eigen::Matrix3d& R : rotations) {
    estimate = followFrom(step, searchFirst(step, R), matches);
    if (good()) break;
  }
  return estimate;
}

Expected<MotionEstimate> StepSearch::followSteadily(const StepImages& step, const CameraMotion& predicted,
                                                    std::vector<TemporalMatch>& matches) {
  matches = match(step, step.corners, predicted, 0, std::move(matches));
  Expected<MotionEstimate> found = estimate(step, predicted, matches, parameters_.min_matches);
  if (!found) return found;
  const double share = shareOf(*found, step), off = farthestOff(step, predicted, *found, matches);
  if (!steadiness_.bearsOut(share, off))
    return tl::make_unexpected(Failure{Reason::kMotionInconsistent, "the step is not as predicted"});
  steadiness_.note(share, off);
  return found;
}

// By how much the prediction put any of the corners that agree wrongly, pixels.
double StepSearch::farthestOff(const StepImages& step, const CameraMotion& predicted,
                               const MotionEstimate& found, const std::vector<TemporalMatch>& matches) const {
  double farthest = 0;
  for (size_t i = 0; i < matches.size(); ++i) {
    if (!found.inliers[i]) continue;
    const TemporalMatch& match = matches[i];
    const Eigen::Vector3d ray = rig_.Kinv() * match.now.homogeneous();
    const double inverse_depth = match.on_plane ? step.normal.dot(ray) : match.inverse_depth;
    const Eigen::Vector3d there = rig_.K() * found.motion.seenThen(ray, inverse_depth);
    const Eigen::Vector3d expected = rig_.K() * predicted.seenThen(ray, inverse_depth);
    farthest = std::max(farthest, (there.hnormalized() - expected.hnormalized()).norm());
  }
  return farthest;
}

Expected<MotionEstimate> StepSearch::followFrom(const StepImages& step, const CameraMotion& predicted,
                                                std::vector<TemporalMatch>& matches) const {
  // A search for some corners makes the prediction good enough for a narrow one for all. Mostly the camera
  // moves on as it did, so a small one comes first.
  constexpr size_t kScouts = 60;
  constexpr int kSmallSteps = 3;
  constexpr double kEnough = 0.2, kAgreeing = 0.6;  // share of the scouts, and of those matched
  const std::vector<TrackedCorner> scouts = thinned(step.corners, kScouts);
  CameraMotion start = predicted;
  const int wide = wideSteps();
  for (const int steps : {std::min(kSmallSteps, wide), wide}) {
    const std::vector<TemporalMatch> found = match(step, scouts, predicted, steps);
    const Expected<MotionEstimate> scouted = estimateMotion(rig_, found, step.normal, step.normal_covariance,
                                                            predicted, kFewestScouts, step.memory.motion);
    if (scouted) start = scouted->motion;
    if (scouted && scouted->inlier_count >= std::max(kEnough * scouts.size(), kAgreeing * found.size()))
      break;
  }
  matches = match(step, step.corners, start, 0, std::move(matches));
  return estimate(step, start, matches, parameters_.min_matches);
}

Expected<MotionEstimate> StepSearch::estimate(const StepImages& step, const CameraMotion& start,
                                              const std::vector<TemporalMatch>& matches, int fewest) const {
  if (step.rotation != nullptr) {
    // Three of the six unknowns are known already.
    const int needed = std::max(kFewestScouts, fewest / 2);
    const Expected<MotionEstimate> aided = estimateMotion(rig_, matches, step.normal, step.normal_covariance,
                                                          start, needed, step.memory.motion, step.rotation);
    if (aided && agrees(*aided, *step.rotation)) return aided;
  }
  return estimateMotion(rig_, matches, step.normal, step.normal_covariance, start, fewest,
                        step.memory.motion);
}

CameraMotion StepSearch::searchFirst(const StepImages& step, const Eigen::Matrix3d& R) {
  constexpr size_t kCorners = 60;
  constexpr double kEnough = 0.2;  // of them, that agree
  const std::vector<TrackedCorner> some = thinned(step.corners, kCorners);
  const Eigen::Matrix3d loose = Eigen::Matrix3d::Identity() * 1e-6;
  std::vector<CameraMotion> candidates = guesses(step.normal, R);
  CameraMotion best = candidates.front();
  double most = 0;
  for (const CameraMotion& guess : candidates) {
    const std::vector<TemporalMatch> matches = match(step, some, guess, wideSteps());
    const Expected<MotionEstimate> estimate =
        estimateMotion(rig_, matches, step.normal, loose, guess, kFewestScouts, step.memory.motion);
    if (estimate && estimate->inlier_count > most) {
      most = estimate->inlier_count;
      best = estimate->motion;
    }
  }
  if (most >= kEnough * static_cast<double>(some.size())) {
    unsure_ = 0;
    return best;
  }
  // That takes as long as many pairs do: where nothing can be seen, not with each of them.
  if (unsure_++ % kUnsureInterval != 0) return best;
  if (most > 0) candidates.push_back(best);
  return mostAlike(step, candidates);
}

// Lines along the runway look alike wherever along them they are looked for, so that they agree with any
// speed, the more of them the slower it is; how much all corners look alike tells which one is right.
CameraMotion StepSearch::mostAlike(const StepImages& step, const std::vector<CameraMotion>& guesses) const {
  constexpr size_t kCorners = 250;  // half as many took a wrong speed over hardly anything but lines
  constexpr int kFollowed = 3;  // times from where the last one led: it falls short of what is right by half
  const std::vector<TrackedCorner> some = thinned(step.corners, kCorners);
  CameraMotion best = guesses.front();
  double most = 0;
  std::vector<TemporalMatch> matches;
  for (const CameraMotion& guess : guesses) {
    CameraMotion motion = guess;
    for (int time = 0; time < kFollowed; ++time) {
      matches = match(step, some, motion, 0, std::move(matches));
      const Expected<MotionEstimate> followed = estimate(step, motion, matches, kFewestScouts);
      if (!followed) break;
      motion = followed->motion;
    }
    const double alike = likenessOverTime(rig_, step.now, step.then, mask_, some, step.normal, motion,
                                          parameters_.window_radius);
    if (alike > most) {
      most = alike;
      best = motion;
    }
  }
  return best;
}

}  // namespace uav_landing
