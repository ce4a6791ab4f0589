#include "far/sight_search.h"

#include <cmath>
#include <utility>
#include <vector>

#include "far/outline_search.h"

namespace uav_landing {
namespace {

// Dark ground before the threshold may look like more of the runway: the near end is also tried this much
// farther away, as a share of the outline's height.
constexpr double kStarts[] = {0, 0.3};
// An outline that is begun with has to agree better than one that is followed, as fields and roads may look
// like a runway.
constexpr double kDoubtfulStart = 7;  // misfit
constexpr double kDoubtfulPlane = 2;  // standard deviations off the plane of stereo
constexpr double kRival = 0.6;        // of the strength: another one that shows as clearly
constexpr int kPatch = 48;            // px, width and height of the piece of the image that is followed
constexpr int kReach = 16;            // px from pair to pair

Failure noRunway(const char* why) { return {Reason::kNoRunway, why}; }

bool isOffPlane(const OutlinePose& pose, const KnownGround& ground) {
  return ground.plane.valid() && !(std::abs(offPlane(pose, ground.plane)) <= kDoubtfulPlane);
}

void move(Corners& corners, const Eigen::Vector2d& by) {
  for (Eigen::Vector2d& corner : corners) corner += by;
}

Eigen::Vector2d middleOf(const Corners& corners) {
  return 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
}

}  // namespace

Failure SightSearch::begin(const SightFit& fit, const cv::Mat& left, const KnownGround& ground) {
  *this = {};
  failure_ = noRunway("no outline of a runway in the image");
  for (const OutlineCandidate& candidate : searchOutlines(left, fit.model().left_mask, fit.region(ground))) {
    if (!fit.isPlausible(candidate.corners, ground)) continue;
    if (!running()) middle_ = middleOf(candidate.corners);
    addAttempts(candidate.corners, candidate.strength);
  }
  if (!running()) return failure_;
  watch(left);
  return {};
}

void SightSearch::addAttempts(const Corners& candidate, double strength) {
  for (const double share : kStarts) {
    Corners start = candidate;
    start[0] += share * (candidate[1] - candidate[0]);
    start[3] += share * (candidate[2] - candidate[3]);
    attempts_.push_back({start, strength, share == *std::prev(std::end(kStarts)), std::nullopt});
  }
}

void SightSearch::watch(const cv::Mat& left) {
  const cv::Point corner(static_cast<int>(middle_.x()) - kPatch / 2,
                         static_cast<int>(middle_.y()) - kPatch / 2);
  patch_.take(left, {corner, cv::Size(kPatch, kPatch)});
}

// All of them are far away, where turning the camera moves the whole image.
void SightSearch::follow(const cv::Mat& left) {
  const cv::Point moved = patch_.movement(left, kReach);
  const Eigen::Vector2d by(moved.x, moved.y);
  for (Attempt& attempt : attempts_) {
    move(attempt.start, by);
    if (attempt.seen) move(attempt.seen->corners, by);
  }
  if (best_) move(best_->corners, by);
  if (found_) move(found_->corners, by);
  middle_ += by;
  watch(left);
}

std::optional<Expected<SightedRunway>> SightSearch::step(const SightFit& fit, const cv::Mat& left,
                                                         const KnownGround& ground) {
  Attempt attempt = std::move(attempts_.front());
  attempts_.pop_front();
  Expected<SightedRunway> seen = fit.fit(left, attempt.start, ground, {});
  if (attempt.seen) {
    seen = betterOf(std::move(*attempt.seen), std::move(seen));
  } else if (seen) {
    if (const std::optional<Corners> better = fit.betterStart(*seen)) {
      attempts_.push_front({*better, attempt.strength, attempt.last, std::move(*seen)});
      return std::nullopt;
    }
  }
  if (!judge(attempt, std::move(seen), fit, ground)) {
    attempts_.clear();
    return tl::make_unexpected(noRunway("more than one outline may be the runway's"));
  }
  if (running()) return std::nullopt;
  if (!found_) return tl::make_unexpected(failure_);
  // It has counted as a rival of others until now: it may be the runway all the same.
  if (isOffPlane(found_->pose, ground))
    return tl::make_unexpected(noRunway("an outline too far off the ground's plane to begin with"));
  return std::move(*found_);
}

bool SightSearch::judge(const Attempt& attempt, Expected<SightedRunway> seen, const SightFit& fit,
                        const KnownGround& ground) {
  if (seen) {
    if (const Failure problem = fit.problemOf(seen->pose, ground))
      seen = tl::make_unexpected(noRunway(problem.detail.c_str()));
  }
  if (!seen)
    failure_ = seen.error();
  else if (!best_ || seen->pose.misfit < best_->pose.misfit)
    best_ = std::move(*seen);
  if (!attempt.last) return true;
  const std::optional<SightedRunway> of_candidate = std::exchange(best_, std::nullopt);
  if (!of_candidate) return true;
  if (SightFit::isNear(of_candidate->pose)) {
    failure_ = noRunway("too near to begin with");
  } else if (of_candidate->pose.misfit > kDoubtfulStart) {
    failure_ = noRunway("an outline that fits what is known of runway and ground too poorly to begin with");
  } else if (found_) {
    return false;
  } else {
    found_ = of_candidate;
    while (running() && attempts_.back().strength < kRival * attempt.strength) attempts_.pop_back();
  }
  return true;
}

}  // namespace uav_landing
