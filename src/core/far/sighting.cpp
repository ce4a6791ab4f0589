#include "far/sighting.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "estimation/limits.h"
#include "far/outline_search.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;
constexpr double kLongestStep = 1, kPatience = 1;  // s
constexpr int kReach = 16;                         // px by which the outline moves from pair to pair
constexpr int kMargin = 5;                         // px around it that are kept
constexpr double kAnyColumn = 22 * kDegree, kAnyRow = 14 * kDegree;  // from the optical axis
constexpr double kLowest = 9 * kDegree;                              // of a threshold below the horizon
constexpr double kSureNormal = 1.5 * kDegree;
constexpr double kFlattest = 0.6 * kDegree, kSteepest = 10 * kDegree;  // of the way down to the threshold
constexpr double kAside = 0.3, kBeside = 60;  // of the distance, and m: from the centre line
constexpr double kMostTilt = 25 * kDegree;
constexpr double kFarthest = 12000;   // m
constexpr double kNearestStart = 16;  // widths: an outline is not begun with from nearer
// From one search to the next, s: a search takes the time of half a pair and more.
constexpr double kSearchWait = 0.3;
constexpr double kNearWait = 10;     // s without a search after a runway has become too near to be followed
constexpr double kNearest = 11;      // widths: nearer, its marks tell more than its outline
constexpr double kRoughly = 0.5;     // corners of a candidate may be off by this
constexpr double kLowestFlight = 8;  // m: cars and laboratories do not look down on runways
constexpr double kNarrowest = 6, kWidest = 100, kShortest = 250, kLongest = 6500, kLeastAspect = 8;
constexpr double kMostMisfit = 14;  // chi-square of what four sides and a chart have too many, one in 1000
// Doubt of the width by stripes, m: at most, and where a pixel is a metre.
constexpr double kMostDoubt = 2.5, kDoubt = 0.18;
constexpr double kStarts[] = {0, 0.3};  // of the outline's height, that the near end may be farther
constexpr double kDoubtfulStart = 7;    // misfit
constexpr double kPoorFit = 6;   // misfit above which the fit begins once more at the pose that it gave
constexpr double kRival = 0.6;   // of the strength: another one that shows as clearly
constexpr double kBroad = 0.12;  // of the picture's width: nearer, markings tell more
constexpr Sigmas kGate(4);
constexpr double kSlack = 0.05;  // of the distance

Failure noSight(const std::string& why) { return {Reason::kNoRunway, why}; }

bool within(double value, double low, double high) { return value >= low && value <= high; }

}  // namespace

Sighting::Sighting(const RigModel& rig, const ApproachAngleParameters& parameters,
                   const RunwayParameters& runway)
    : model_(rig),
      max_yaw_(parameters.max_yaw_deg * kDegree),
      slope_(parameters.runway_slope_stddev_deg * kDegree),
      runway_(runway) {}

void Sighting::reset() {
  last_stamp_.reset();
  last_.reset();
  patch_ = {};
  confirmations_ = 0;
  missed_ = wait_until_ = 0;
}

bool Sighting::isNear(const OutlinePose& pose) {
  return -pose.pose.position.x() < kNearestStart * pose.size.width;
}

bool Sighting::mayStart(const KnownGround& ground) const {
  const bool low = ground.plane.valid() && ground.plane.height() < kLowestFlight;
  return !low && byChart();
}

PoseKnowledge Sighting::knowledge(const KnownGround& ground) const {
  PoseKnowledge known;
  known.chart = {runway_.width, runway_.length};
  known.length_stddev = std::max(5.0, 0.003 * runway_.length);
  known.plane = ground.plane;
  known.normal = ground.normal;
  if (known.normal.known()) known.normal.covariance += slope_ * slope_ * Eigen::Matrix3d::Identity();
  return known;
}

cv::Rect Sighting::region(const KnownGround& ground) const {
  const StereoRig& rig = model_.rig;
  const double aside = rig.fx * std::tan(kAnyColumn);
  double top = rig.cy - rig.fy * std::tan(kAnyRow), bottom = rig.cy + rig.fy * std::tan(kAnyRow);
  if (ground.normal.known() && ground.normal.covariance.trace() < kSureNormal * kSureNormal) {
    const Eigen::Vector3d& n = ground.normal.n;
    const double horizon = rig.cy - rig.fy * n.z() / n.y(), tilt = std::abs(n.x() / n.y()) * aside;
    top = horizon - tilt;
    bottom = horizon + tilt + rig.fy * std::tan(kLowest);
  }
  return {cv::Point(static_cast<int>(rig.cx - aside), static_cast<int>(top)),
          cv::Point(static_cast<int>(rig.cx + aside), static_cast<int>(bottom))};
}

Failure Sighting::problemOf(const OutlinePose& found) const {
  const Eigen::Vector3d& p = found.pose.position;
  const double down = std::atan2(p.z(), -p.x());
  if (!within(-p.x(), kNearest * found.size.width, kFarthest) || p.z() < kLowestFlight ||
      !within(down, kFlattest, kSteepest) || std::abs(p.y()) > kAside * -p.x() + kBeside)
    return noSight("not where a runway lies on an approach");
  if (std::abs(found.pose.yaw) > max_yaw_ ||
      std::max(std::abs(found.pose.roll), std::abs(found.pose.pitch)) > kMostTilt)
    return noSight("not as an aircraft on an approach sees a runway");
  const RunwaySize& size = found.size;
  if (!within(size.width, kNarrowest, kWidest) || !within(size.length, kShortest, kLongest) ||
      size.length < kLeastAspect * size.width)
    return noSight(
        text("a surface of ", rounded(size.width), " x ", rounded(size.length), " m is no runway"));
  if (found.misfit > kMostMisfit)
    return noSight(text("the outline contradicts what is known of runway and ground, with a chi-square of ",
                        rounded(found.misfit)));
  return {};
}

Expected<Sighting::Seen> Sighting::fitFrom(const cv::Mat& left, const Corners& start,
                                           const KnownGround& ground) const {
  OutlineLook look;
  look.focal_length = model_.rig.fx;
  if (last_) look.size = last_->pose.size;
  if (runway_.width > 0) look.size.width = runway_.width;
  if (runway_.length > 0) look.size.length = runway_.length;
  const Expected<FittedOutline> outline = fitOutline(left, model_.left_mask, start, look);
  if (!outline) return tl::make_unexpected(outline.error());
  const Corners corners = movedBy(start, outline->seen.inward);
  if ((corners[3] - corners[0]).norm() > kBroad * model_.rig.size.width)
    return tl::make_unexpected(noSight("the runway is near: its markings tell more than its outline"));
  PoseElements elements;
  elements.stereo = false;  // it is to tell whether the chart is right
  const Expected<OutlinePose> pose = fitPose(outline->seen, knowledge(ground), model_.rig, elements);
  if (!pose) return tl::make_unexpected(pose.error());
  return Seen{*outline, *pose, corners};
}

Expected<Sighting::Seen> Sighting::fit(const cv::Mat& left, const Corners& start,
                                       const KnownGround& ground) const {
  Expected<Seen> seen = fitFrom(left, start, ground);
  if (seen && seen->pose.misfit > kPoorFit) {
    const auto corners = cornersOf(seen->pose.pose, seen->pose.size, model_.rig);
    Expected<Seen> again = corners ? fitFrom(left, *corners, ground) : seen;
    if (again && again->pose.misfit < seen->pose.misfit) seen = std::move(again);
  }
  if (!seen) return seen;
  if (const Failure problem = problemOf(seen->pose)) return tl::make_unexpected(problem);
  return seen;
}

/// Dark ground before the threshold may look like more of the runway, to the search: its near end is taken
/// for farther, too.
Expected<Sighting::Seen> Sighting::fitCandidate(const cv::Mat& left, const Corners& corners,
                                                const KnownGround& ground) const {
  Expected<Seen> best = tl::make_unexpected(noSight(""));
  for (const double share : kStarts) {
    Corners start = corners;
    start[0] += share * (corners[1] - corners[0]);
    start[3] += share * (corners[2] - corners[3]);
    Expected<Seen> seen = fit(left, start, ground);
    const bool better = seen && (!best || seen->pose.misfit < best->pose.misfit);
    if (better || (!best && share == kStarts[0])) best = std::move(seen);
  }
  if (best && isNear(best->pose)) return tl::make_unexpected(noSight("too near to begin with"));
  if (best && best->pose.misfit > kDoubtfulStart)
    return tl::make_unexpected(
        noSight("an outline that fits what is known of runway and ground too poorly to begin with"));
  return best;
}

/// Before anything is fitted: whether the near side is a runway's, and far enough, by the pixels that it is
/// wide, and by the ground below it where that is known.
bool Sighting::isPlausible(const Corners& corners, const KnownGround& ground) const {
  const Eigen::Vector2d& left = corners[0];
  const Eigen::Vector2d& right = corners[3];
  const double pixels = (right - left).norm();
  if (pixels * kRoughly * kNearestStart > model_.rig.fx) return false;
  if (!ground.plane.valid()) return true;
  const Eigen::Vector2d middle = 0.5 * (left + right);
  const double inverse_depth = ground.plane.inverseDepth(model_.rig.ray(middle.x(), middle.y()));
  if (!(inverse_depth > 0)) return true;
  const double width = pixels / (model_.rig.fx * inverse_depth);
  return within(width, kRoughly * kNarrowest, kWidest / kRoughly);
}

Expected<Sighting::Seen> Sighting::search(const cv::Mat& left, const KnownGround& ground) const {
  const std::vector<OutlineCandidate> candidates = searchOutlines(left, model_.left_mask, region(ground));
  Failure failure = noSight("no outline of a runway in the picture");
  std::optional<Seen> best;
  double strength = 0;
  for (const OutlineCandidate& candidate : candidates) {
    if (best && candidate.strength < kRival * strength) break;
    if (!isPlausible(candidate.corners, ground)) continue;
    Expected<Seen> seen = fitCandidate(left, candidate.corners, ground);
    if (!seen) {
      failure = seen.error();
      continue;
    }
    if (best) return tl::make_unexpected(noSight("more than one outline may be the runway's"));
    best = std::move(*seen);
    strength = candidate.strength;
  }
  if (!best) return tl::make_unexpected(failure);
  return *best;
}

Expected<Sighting::Seen> Sighting::follow(const cv::Mat& left, const KnownGround& ground) const {
  const cv::Point moved = patch_.movement(left, kReach);
  Corners start = last_->corners;
  for (Eigen::Vector2d& corner : start) corner += Eigen::Vector2d(moved.x, moved.y);
  return fit(left, start, ground);
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

void Sighting::keep(const cv::Mat& left, const Seen& seen) {
  last_ = seen;
  missed_ = 0;
  Eigen::Vector2d low = seen.corners[0], high = low;
  for (const Eigen::Vector2d& corner : seen.corners) {
    low = low.cwiseMin(corner);
    high = high.cwiseMax(corner);
  }
  patch_.take(left, {cv::Point(static_cast<int>(low.x()) - kMargin, static_cast<int>(low.y()) - kMargin),
                     cv::Point(static_cast<int>(high.x()) + kMargin, static_cast<int>(high.y()) + kMargin)});
}

ApproachAngleResult::Sight Sighting::process(double stamp, const cv::Mat& left, const KnownGround& ground) {
  const bool follows = last_stamp_ && stamp > *last_stamp_ && stamp - *last_stamp_ <= kLongestStep;
  if (!follows) reset();
  const double seconds = last_stamp_ ? stamp - *last_stamp_ : 0;
  last_stamp_ = stamp;
  ApproachAngleResult::Sight sight;
  if (!mayStart(ground)) {
    last_.reset();
    confirmations_ = 0;
    sight.failure = noSight("low over the ground, or no chart gives the runway's size");
    return sight;
  }
  if (!last_ && stamp < wait_until_) {
    sight.failure = noSight("the runway's outline is not looked for in every pair");
    return sight;
  }
  Expected<Seen> seen = last_ ? this->follow(left, ground) : search(left, ground);
  if (seen && last_ && !agrees(seen->pose))
    seen = tl::make_unexpected(noSight("not where the pair before had it"));
  if (!seen) {
    sight.failure = seen.error();
    missed_ += seconds;
    const bool near = last_ && isNear(last_->pose);
    if (!last_ || confirmations_ < kConfirmations) wait_until_ = stamp + kSearchWait;
    if (near) wait_until_ = stamp + kNearWait;
    if (near || missed_ > kPatience || confirmations_ < kConfirmations) {
      last_.reset();
      confirmations_ = 0;
    }
    return sight;
  }
  keep(left, *seen);
  confirmations_ = std::min(confirmations_ + 1, kConfirmations);
  if (confirmations_ < kConfirmations) {
    sight.failure = {Reason::kNotYet, text(confirmations_, " of ", kConfirmations,
                                           " pairs that agree on the runway's outline")};
    return sight;
  }
  return report(*seen, ground);
}

/// 1 sigma of the width that shows against the chart's, as a share: whether stripes lie along the edges
/// cannot be told while they are much narrower than a pixel. All lengths are wrong by it alike.
double Sighting::widthDoubt(const OutlinePose& pose) const {
  const double pixel = -pose.pose.position.x() / model_.rig.fx;  // m
  return std::min(kMostDoubt, kDoubt * pixel * pixel) / pose.size.width;
}

ApproachAngleResult::Sight Sighting::report(const Seen& seen, const KnownGround& ground) const {
  ApproachAngleResult::Sight sight;
  const OutlinePose& found = seen.pose;
  const auto variance = [](double size, double of_logarithm) { return size * size * of_logarithm; };
  sight.position = found.pose.position;
  sight.covariance = found.covariance.topLeftCorner<3, 3>();
  sight.yaw = found.pose.yaw;
  sight.yaw_variance = found.covariance(5, 5);
  sight.width = found.size.width;
  sight.width_variance = variance(found.size.width, found.covariance(6, 6));
  sight.length = found.size.length;
  sight.length_variance = variance(found.size.length, found.covariance(7, 7));
  const double by_stripes = std::pow(widthDoubt(found), 2);
  sight.covariance += by_stripes * sight.position * sight.position.transpose();
  const PoseKnowledge known = knowledge(ground);
  PoseElements without[3];
  without[0].width = without[1].length = without[2].normal = false;
  for (int i = 0; i < 3; ++i) {
    without[i].stereo = false;
    const Expected<OutlinePose> pose = fitPose(seen.outline.seen, known, model_.rig, without[i]);
    if (!pose) continue;
    sight.height_without[i] = pose->pose.position.z();
    sight.variance_without[i] = pose->covariance(2, 2) + by_stripes * std::pow(pose->pose.position.z(), 2);
  }
  const RunwaySize& chart = known.chart;
  const Expected<OutlinePose> by_stereo =
      fitPose(seen.outline.seen, known, model_.rig, {false, false, true, true});
  if (!by_stereo) return sight;
  const double size =
      chart.width > 0 ? by_stereo->size.width / chart.width : by_stereo->size.length / chart.length;
  const int i = chart.width > 0 ? 6 : 7;
  sight.size_over_chart = size;
  sight.size_over_chart_variance = variance(size, by_stereo->covariance(i, i));
  return sight;
}

}  // namespace uav_landing
