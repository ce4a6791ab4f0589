#include "far/sighting.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/text.h"
#include "estimation/limits.h"

namespace uav_landing {
namespace {

constexpr double kLongestStep = 1, kPatience = 1;  // s
constexpr int kReach = 16;                         // px by which the outline moves from pair to pair
constexpr int kMargin = 5;                         // px around it that are kept
constexpr double kSearchWait = 0.3;                // s from one search to the next
constexpr double kNearWait = 10;  // s without a search after a runway has become too near to be followed
constexpr Sigmas kGate(4);
constexpr double kSlack = 0.05;  // of the distance

Failure noSight(const std::string& why) { return {Reason::kNoRunway, why}; }

}  // namespace

Sighting::Sighting(const RigModel& rig, const ApproachAngleParameters& parameters,
                   const RunwayParameters& runway)
    : fit_(rig, parameters, runway), at_once_(parameters.search_at_once) {}

void Sighting::reset() {
  search_ = {};
  last_stamp_.reset();
  drop();
  patch_ = {};
  missed_ = wait_until_ = 0;
}

/// Nothing while the search goes on.
std::optional<Expected<SightedRunway>> Sighting::search(double stamp, const cv::Mat& left,
                                                        const KnownGround& ground, bool busy) {
  if (!search_.running()) {
    if (busy || stamp < wait_until_)
      return tl::make_unexpected(noSight("the runway's outline is not looked for in every pair"));
    wait_until_ = stamp + kSearchWait;
    if (const Failure none = search_.begin(fit_, left, ground)) return tl::make_unexpected(none);
    if (!at_once_) return std::nullopt;
  } else {
    search_.follow(left);
  }
  if (busy) return std::nullopt;
  std::optional<Expected<SightedRunway>> found = search_.step(fit_, left, ground);
  while (!found && at_once_) found = search_.step(fit_, left, ground);
  if (found) wait_until_ = stamp + kSearchWait;
  return found;
}

Expected<SightedRunway> Sighting::follow(const cv::Mat& left, const KnownGround& ground) const {
  const cv::Point moved = patch_.movement(left, kReach);
  Corners start = last_->corners;
  for (Eigen::Vector2d& corner : start) corner += Eigen::Vector2d(moved.x, moved.y);
  Expected<SightedRunway> seen = fit_.follow(left, start, ground, *last_);
  if (!seen) return seen;
  if (const std::optional<Corners> better = fit_.betterStart(*seen))
    seen = betterOf(std::move(seen), fit_.follow(left, *better, ground, *last_));
  if (const Failure problem = fit_.problemOf(seen->pose, ground)) return tl::make_unexpected(problem);
  return seen;
}

/// Whether it is what was seen before, as far as an aircraft can have moved.
bool Sighting::agrees(const OutlinePose& pose) const {
  const OutlinePose& before = last_->pose;
  const Eigen::Vector3d step = pose.pose.position - before.pose.position;
  for (int i = 0; i < 3; ++i)
    if (std::abs(step[i]) >
        kGate.bound(pose.covariance(i, i) + before.covariance(i, i)) - kSlack * before.pose.position.x())
      return false;
  return true;
}

void Sighting::keep(const cv::Mat& left, const SightedRunway& seen) {
  last_ = seen;
  missed_ = 0;
  const Eigen::Vector2d low = boxOf(seen.corners).min(), high = boxOf(seen.corners).max();
  patch_.take(left, {cv::Point(static_cast<int>(low.x()) - kMargin, static_cast<int>(low.y()) - kMargin),
                     cv::Point(static_cast<int>(high.x()) + kMargin, static_cast<int>(high.y()) + kMargin)});
}

void Sighting::miss(double stamp, double seconds) {
  missed_ += seconds;
  const bool near = last_ && SightFit::isNear(last_->pose);
  const bool unconfirmed = confirmations_ < kConfirmations;
  if (last_ && unconfirmed) wait_until_ = stamp + kSearchWait;
  if (near) wait_until_ = stamp + kNearWait;
  if (near || missed_ > kPatience || unconfirmed) drop();
}

std::optional<SurfaceDisparity> Sighting::followScale(double seconds, const RectifiedImages& images,
                                                      const SightedRunway& seen, const KnownGround& ground) {
  const std::optional<SurfaceDisparity> found = fit_.disparityOf(images, seen, ground);
  if (!found) return std::nullopt;
  return scale_.follow(seconds, *found, widthInRow(seen.corners, found->pixel.y()));
}

void Sighting::drop() {
  last_.reset();
  scale_ = {};
  confirmations_ = 0;
}

ApproachAngleResult::Sight Sighting::process(double stamp, const RectifiedImages& images,
                                             const KnownGround& ground, bool busy) {
  const cv::Mat& left = images.left;
  const bool follows = last_stamp_ && stamp > *last_stamp_ && stamp - *last_stamp_ <= kLongestStep;
  if (!follows) reset();
  const double seconds = last_stamp_ ? stamp - *last_stamp_ : 0;
  last_stamp_ = stamp;
  ApproachAngleResult::Sight sight;
  if (!fit_.mayStart(ground)) {
    search_ = {};
    drop();
    sight.failure = noSight("low over the ground, or no chart gives the runway's size");
    return sight;
  }
  std::optional<Expected<SightedRunway>> seen =
      last_ ? follow(left, ground) : search(stamp, left, ground, busy);
  if (!seen) {
    sight.failure = {Reason::kNotYet, "looking for the runway's outline: one fit a pair"};
    return sight;
  }
  if (*seen && last_ && !agrees((*seen)->pose))
    *seen = tl::make_unexpected(noSight("not where the pair before had it"));
  if (!*seen) {
    sight.failure = seen->error();
    if (sight.failure.reason == Reason::kRejected)
      drop();
    else
      miss(stamp, seconds);
    return sight;
  }
  keep(left, **seen);
  const std::optional<SurfaceDisparity> disparity = followScale(seconds, images, **seen, ground);
  confirmations_ = std::min(confirmations_ + 1, kConfirmations);
  if (confirmations_ < kConfirmations) {
    sight.failure = {Reason::kNotYet, text(confirmations_, " of ", kConfirmations,
                                           " pairs that agree on the runway's outline")};
    return sight;
  }
  return report(**seen, ground, disparity);
}

ApproachAngleResult::Sight Sighting::report(const SightedRunway& seen, const KnownGround& ground,
                                            const std::optional<SurfaceDisparity>& disparity) const {
  ApproachAngleResult::Sight sight;
  PoseKnowledge known = fit_.knowledge(ground);
  known.disparity = disparity;
  // Stereo was left out so far, as the outline had to agree with it first.
  const Expected<OutlinePose> with_stereo = fitPose(seen.outline.seen, known, fit_.model().rig);
  const OutlinePose& found = with_stereo ? *with_stereo : seen.pose;
  const auto variance = [](double size, double of_logarithm) { return size * size * of_logarithm; };
  sight.position = found.pose.position;
  sight.covariance = found.covariance.topLeftCorner<3, 3>();
  sight.yaw = found.pose.yaw;
  sight.yaw_variance = found.covariance(5, 5);
  sight.width = found.size.width;
  sight.width_variance = variance(found.size.width, found.covariance(6, 6));
  sight.length = found.size.length;
  sight.length_variance = variance(found.size.length, found.covariance(7, 7));
  sight.height_by_chart = std::max({std::abs(found.height_by_width), std::abs(found.height_by_length),
                                    std::abs(found.height_by_width + found.height_by_length)});
  if (with_stereo && known.disparity) {
    sight.disparity = known.disparity->value;
    sight.disparity_variance = known.disparity->totalVariance();
    sight.height_by_bias = std::abs(found.height_by_disparity) * known.disparity->bias_stddev;
  }
  PoseElements without[3];
  without[0].width = without[1].length = without[2].normal = false;
  for (int i = 0; i < 3; ++i) {
    without[i].stereo = false;
    const Expected<OutlinePose> pose = fitPose(seen.outline.seen, known, fit_.model().rig, without[i]);
    if (!pose) continue;
    sight.height_without[i] = pose->pose.position.z();
    sight.variance_without[i] = pose->covariance(2, 2);
  }
  const RunwaySize& chart = known.chart;
  const Expected<OutlinePose> by_stereo =
      fitPose(seen.outline.seen, known, fit_.model().rig, {false, false, true, true});
  if (!by_stereo) return sight;
  const double size =
      chart.width > 0 ? by_stereo->size.width / chart.width : by_stereo->size.length / chart.length;
  const int i = chart.width > 0 ? 6 : 7;
  sight.size_over_chart = size;
  sight.size_over_chart_variance = variance(size, by_stereo->covariance(i, i));
  return sight;
}

}  // namespace uav_landing
