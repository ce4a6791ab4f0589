#include "motion/step/step_search.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/thinned.h"

namespace uav_landing {
namespace {

// Least share of the followed corners that must agree with a motion grown from a prediction.
constexpr double kLeastShare = 0.35;

// Largest errors of the prediction at any corner, pixels (see Steadiness). Refinement alone finds corners
// within two pixels.
constexpr double kSteadyOff = 0.75, kMostOff = 1.0;

double shareOf(const MotionEstimate& estimate, const StepImages& step) {
  return estimate.inlier_count / static_cast<double>(step.corners.size());
}

Expected<MotionEstimate> stillSearching() {
  return tl::make_unexpected(
      Failure{Reason::kNotYet, "the motion is being searched for, over several pairs"});
}

}  // namespace

StepSearch::StepSearch(const StereoRig& rig, cv::Mat mask, const ApproachAngleParameters& parameters)
    : matching_(rig, std::move(mask), parameters),
      min_matches_(parameters.min_matches),
      first_(parameters.search_at_once),
      steadiness_(kSteadyOff, kMostOff) {}

bool StepSearch::isGood(const Expected<MotionEstimate>& estimate,
                        const std::vector<TemporalMatch>& matches) const {
  return estimate && estimate->inlier_count >= kLeastShare * static_cast<double>(matches.size());
}

Expected<MotionEstimate> StepSearch::find(const StepImages& step,
                                          const std::vector<CameraMotion>& predictions,
                                          std::vector<TemporalMatch>& matches) {
  Expected<MotionEstimate> found = findMotion(step, predictions, matches);
  const bool given = step.times != nullptr && !step.times->atOnce();
  if (!given && step.doubt.time == 0) return found;
  // Rows were carried to the stamps with the predicted motion, which is not exactly the one that was found.
  constexpr int kMostPasses = 3;
  for (int pass = 0; found && pass < kMostPasses; ++pass) {
    const CameraMotion before = found->motion;
    if (given)
      matches = matching_.match(step, step.corners, before, 0, std::move(matches));
    else
      matching_.shiftByReadout(step, before, matches);
    found = matching_.estimate(step, before, matches, min_matches_);
    if (found && matching_.carryRowsAlike(step, before, found->motion)) break;
  }
  return found;
}

Expected<MotionEstimate> StepSearch::findMotion(const StepImages& step,
                                                const std::vector<CameraMotion>& predictions,
                                                std::vector<TemporalMatch>& matches) {
  if (!predictions.empty() && step.regular && steadiness_.goesWithout()) {
    const Expected<MotionEstimate> steady = followSteadily(step, predictions.front(), matches);
    if (steady) return steady;
  }
  steadiness_.searched();
  for (const CameraMotion& predicted : predictions) {
    const Expected<MotionEstimate> followed = followFrom(step, predicted, matches);
    if (!isGood(followed, matches)) continue;
    steadiness_.note(shareOf(*followed, step), farthestOff(step, predicted, *followed, matches));
    first_.restart();
    return followed;
  }
  steadiness_.lose();
  // The failed predictions have used up the time of this pair if it has other searches, too.
  const bool late = step.time != SearchTime::kAmple && !predictions.empty() && !first_.isAtOnce(step);
  return late ? stillSearching() : findFirst(step, matches);
}

Expected<MotionEstimate> StepSearch::findFirst(const StepImages& step, std::vector<TemporalMatch>& matches) {
  Expected<MotionEstimate> found = stillSearching();
  // First with the known rotation, then without it.
  const int most = step.rotation != nullptr && first_.isAtOnce(step) ? 2 : 1;
  for (int time = 0; time < most; ++time) {
    const std::optional<CameraMotion> start = first_.advance(matching_, step);
    if (!start) break;
    found = followFrom(step, *start, matches);
    if (isGood(found, matches)) break;
    first_.fail();
  }
  return found;
}

Expected<MotionEstimate> StepSearch::followSteadily(const StepImages& step, const CameraMotion& predicted,
                                                    std::vector<TemporalMatch>& matches) {
  matches = matching_.match(step, step.corners, predicted, 0, std::move(matches));
  Expected<MotionEstimate> found = matching_.estimate(step, predicted, matches, min_matches_);
  if (!found) return found;
  const double share = shareOf(*found, step), off = farthestOff(step, predicted, *found, matches);
  if (!steadiness_.bearsOut(share, off))
    return tl::make_unexpected(Failure{Reason::kMotionInconsistent, "the step is not as predicted"});
  steadiness_.note(share, off);
  return found;
}

// Largest error of the prediction over the corners that agree, pixels.
double StepSearch::farthestOff(const StepImages& step, const CameraMotion& predicted,
                               const MotionEstimate& found, const std::vector<TemporalMatch>& matches) const {
  double farthest = 0;
  for (size_t i = 0; i < matches.size(); ++i) {
    if (!found.inliers[i]) continue;
    const TemporalMatch& match = matches[i];
    const Eigen::Vector3d ray = matching_.rig().Kinv() * match.now.homogeneous();
    const double inverse_depth = match.on_plane ? step.normal.vector().dot(ray) : match.inverse_depth;
    const Eigen::Vector3d there = matching_.rig().K() * found.motion.seenThen(ray, inverse_depth);
    const Eigen::Vector3d expected = matching_.rig().K() * predicted.seenThen(ray, inverse_depth);
    farthest = std::max(farthest, (there.hnormalized() - expected.hnormalized()).norm());
  }
  return farthest;
}

Expected<MotionEstimate> StepSearch::followFrom(const StepImages& step, const CameraMotion& predicted,
                                                std::vector<TemporalMatch>& matches) const {
  // A search for a few corners improves the prediction, so that a narrow search is enough for all. The camera
  // mostly moves on as before, so a small search comes first.
  constexpr size_t kScouts = 60;
  constexpr int kSmallSteps = 3;
  constexpr double kEnough = 0.2, kAgreeing = 0.6;  // shares of the scouts, and of the matched ones
  const std::vector<TrackedCorner> scouts = thinned(step.corners, kScouts);
  CameraMotion start = predicted;
  const int wide = matching_.wideSteps();
  for (const int steps : {std::min(kSmallSteps, wide), wide}) {
    const std::vector<TemporalMatch> found = matching_.match(step, scouts, predicted, steps);
    const Expected<MotionEstimate> scouted = estimateMotion(matching_.rig(), found, {predicted, step.normal},
                                                            StepMatching::kFewestScouts, step.memory.motion);
    if (scouted) start = scouted->motion;
    if (scouted && scouted->inlier_count >= std::max(kEnough * scouts.size(), kAgreeing * found.size()))
      break;
  }
  matches = matching_.match(step, step.corners, start, 0, std::move(matches));
  return matching_.estimate(step, start, matches, min_matches_);
}

}  // namespace uav_landing
