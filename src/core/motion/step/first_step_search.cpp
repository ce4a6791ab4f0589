#include "motion/step/first_step_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/rare_pairs.h"
#include "base/thinned.h"

namespace uav_landing {
namespace {

// Speeds ahead per step, in heights. The search for each corner covers the speeds between them, rotation and
// sinking.
constexpr std::array<double, 9> kSpeeds = {0.0, 0.03, 0.07, 0.13, 0.22, 0.35, 0.55, 0.8, 1.1};
// Numbers of speeds tried and compared in one pair. They keep a pair below three times the duration of a pair
// without any search.
size_t guessedIn(SearchTime time) {
  return time == SearchTime::kAmple ? kSpeeds.size() : time == SearchTime::kShort ? 3 : 1;
}
size_t comparedIn(SearchTime time) {
  return time == SearchTime::kAmple ? 4 : time == SearchTime::kShort ? 3 : 2;
}

// When few corners agree in search after search, all are compared in one of this many searches.
constexpr int kUnsureInterval = 10;

constexpr size_t kGuessCorners = 60;
// With half as many, the comparison chose a wrong speed over ground with little but lines.
constexpr size_t kComparedCorners = 250;

CameraMotion ahead(const Eigen::Vector3d& normal, const Eigen::Matrix3d& R, double speed) {
  return {R, speed * (Eigen::Vector3d::UnitZ() - normal.z() * normal).normalized()};
}

}  // namespace

void FirstStepSearch::clear() {
  guessed_ = next_ = 0;
  share_ = 0;
  best_.reset();
  compared_.clear();
  alike_.reset();
}

void FirstStepSearch::restart() {
  clear();
  with_rotation_ = true;
}

void FirstStepSearch::reset() {
  restart();
  unsure_ = 0;
}

bool FirstStepSearch::isAtOnce(const StepImages& step) const {
  return at_once_ || step.duration > kRarePairs;
}

void FirstStepSearch::fail() { with_rotation_ = !with_rotation_; }

std::optional<CameraMotion> FirstStepSearch::advance(const StepMatching& matching, const StepImages& step) {
  if (step.duration > kRarePairs) clear();  // what was found before a gap is too old
  const bool at_once = isAtOnce(step);
  if (compared_.empty()) {
    size_t time = at_once ? kSpeeds.size() : guessedIn(step.time);
    for (; time > 0 && guessed_ < kSpeeds.size(); --time) guess(matching, step, kSpeeds[guessed_++]);
    if (guessed_ < kSpeeds.size()) return std::nullopt;
    if (!isUnsure()) return end(step);
    for (const double speed : kSpeeds)
      compared_.push_back({ahead(step.normal.vector(), rotation(step), speed), step.duration});
    if (best_) compared_.push_back(*best_);
    if (!at_once) return std::nullopt;
  }
  compare(matching, step, at_once ? compared_.size() : comparedIn(step.time));
  if (next_ < compared_.size()) return std::nullopt;
  best_ = alike_ ? alike_ : compared_.front();
  return end(step);
}

Eigen::Matrix3d FirstStepSearch::rotation(const StepImages& step) const {
  return with_rotation_ && step.rotation != nullptr ? step.rotation->R : Eigen::Matrix3d::Identity();
}

void FirstStepSearch::guess(const StepMatching& matching, const StepImages& step, double speed) {
  const Eigen::Matrix3d loose = Eigen::Matrix3d::Identity() * 1e-6;
  const std::vector<TrackedCorner> some = thinned(step.corners, kGuessCorners);
  const CameraMotion start = ahead(step.normal.vector(), rotation(step), speed);
  const std::vector<TemporalMatch> matches = matching.match(step, some, start, matching.wideSteps());
  const Expected<MotionEstimate> found =
      estimateMotion(matching.rig(), matches, {start, {step.normal.vector(), loose}},
                     StepMatching::kFewestScouts, step.memory.motion);
  if (!found) return;
  const double share = found->inlier_count / static_cast<double>(some.size());
  if (share <= share_) return;
  share_ = share;
  best_ = Candidate{found->motion, step.duration};
}

bool FirstStepSearch::isUnsure() {
  constexpr double kEnough = 0.2;
  if (share_ >= kEnough) {
    unsure_ = 0;
    return false;
  }
  // A comparison takes the time of many pairs. Where nothing can be seen, not every search may end with one.
  return unsure_++ % kUnsureInterval == 0;
}

// Lines along the runway look the same everywhere along themselves. Their corners agree with any speed, and
// more of them with slow ones. The similarity of all corners shows which speed is right. Similarities can be
// compared within one pair only, so each pair also looks at the best one so far.
void FirstStepSearch::compare(const StepMatching& matching, const StepImages& step, size_t count) {
  const std::vector<TrackedCorner> some = thinned(step.corners, kComparedCorners);
  const std::optional<Candidate> before = std::exchange(alike_, std::nullopt);
  double most = 0;
  const auto enter = [&](const Candidate& candidate) {
    const CameraMotion start = carriedOn(candidate.motion, step.duration / candidate.duration);
    const CameraMotion motion = follow(matching, step, some, start);
    const double alike = matching.likeness(step, some, motion);
    if (alike <= most) return;
    most = alike;
    alike_ = Candidate{motion, step.duration};
  };
  if (before) {
    enter(*before);
    --count;
  }
  for (; count > 0 && next_ < compared_.size(); --count) enter(compared_[next_++]);
}

CameraMotion FirstStepSearch::follow(const StepMatching& matching, const StepImages& step,
                                     const std::vector<TrackedCorner>& corners,
                                     const CameraMotion& start) const {
  // Number of repetitions from the last result, as each one covers only half of the way to the right motion.
  constexpr int kFollowed = 3;
  CameraMotion motion = start;
  std::vector<TemporalMatch> matches;
  for (int time = 0; time < kFollowed; ++time) {
    matches = matching.match(step, corners, motion, 0, std::move(matches));
    const Expected<MotionEstimate> found =
        matching.estimate(step, motion, matches, StepMatching::kFewestScouts);
    if (!found) break;
    motion = found->motion;
  }
  return motion;
}

std::optional<CameraMotion> FirstStepSearch::end(const StepImages& step) {
  const Candidate found =
      best_ ? *best_ : Candidate{ahead(step.normal.vector(), rotation(step), kSpeeds.front()), step.duration};
  clear();
  return carriedOn(found.motion, step.duration / found.duration);
}

}  // namespace uav_landing
