#include "far/sight_fit.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "far/runway_paint.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;
constexpr double kAnyColumn = 22 * kDegree, kAnyRow = 14 * kDegree;  // from the optical axis
constexpr double kLowest = 9 * kDegree;                              // of a threshold below the horizon
constexpr double kSureNormal = 1.5 * kDegree;
constexpr double kFlattest = 0.6 * kDegree, kSteepest = 10 * kDegree;  // of the way down to the threshold
constexpr double kAside = 0.3, kBeside = 60;  // of the distance, and m: from the centre line
constexpr double kMostTilt = 25 * kDegree;
constexpr double kFarthest = 12000;   // m
constexpr double kLowestFlight = 8;   // m: cars and laboratories do not look down on runways
constexpr double kNearestStart = 16;  // widths: an outline is not begun with from nearer
constexpr double kNearest = 11;       // widths: nearer, its marks tell more than its outline
constexpr double kRoughly = 0.5;      // corners of a candidate may be off by this
constexpr double kNarrowest = 6, kWidest = 100, kShortest = 250, kLongest = 6500, kLeastAspect = 8;
constexpr double kMostMisfit = 14;  // chi-square of what four sides and a chart have too many, one in 1000
// An outline has to stand out from the ground by so many times its texture. kClear: the ground's plane is
// known and has to agree. kClearAlone: only the outline itself says that it is a runway.
constexpr double kClear = 3, kClearAlone = 4;
constexpr double kMostOffPlane = 3;  // standard deviations, hills included
constexpr double kPoorFit = 6;       // misfit above which the fit begins once more at the pose that it gave
constexpr double kBroad = 0.12;      // of the image's width: nearer, markings tell more

Failure noRunway(const std::string& why) { return {Reason::kNoRunway, why}; }

bool within(double value, double low, double high) { return value >= low && value <= high; }

}  // namespace

Expected<SightedRunway> betterOf(Expected<SightedRunway> first, Expected<SightedRunway> second) {
  if (!first || !second) return first ? first : second;
  return second->pose.misfit < first->pose.misfit ? second : first;
}

SightFit::SightFit(const RigModel& rig, const ApproachAngleParameters& parameters,
                   const RunwayParameters& runway)
    : model_(rig),
      max_yaw_(parameters.max_yaw_deg * kDegree),
      slope_(parameters.runway_slope_stddev_deg * kDegree),
      runway_(runway) {}

bool SightFit::isNear(const OutlinePose& pose) {
  return -pose.pose.position.x() < kNearestStart * pose.size.width;
}

PoseKnowledge SightFit::knowledge(const KnownGround& ground) const {
  PoseKnowledge known;
  known.chart = {runway_.width, runway_.length};
  known.length_stddev = std::max(5.0, 0.003 * runway_.length);
  known.plane = ground.plane;
  if (ground.normal)
    known.normal = {ground.normal->vector(),
                    ground.normal->covariance() + slope_ * slope_ * Eigen::Matrix3d::Identity()};
  return known;
}

std::optional<SurfaceDisparity> SightFit::disparityOf(const RectifiedImages& images,
                                                      const SightedRunway& seen,
                                                      const KnownGround& ground) const {
  if (!ground.plane.valid()) return std::nullopt;
  return measureDisparity(images, model_, ground.right, seen.corners, planeOf(seen.pose.pose));
}

bool SightFit::mayStart(const KnownGround& ground) const {
  const bool low = ground.plane.valid() && ground.plane.height() < kLowestFlight;
  return !low && (runway_.width > 0 || runway_.length > 0);
}

cv::Rect SightFit::region(const KnownGround& ground) const {
  const StereoRig& rig = model_.rig;
  const double aside = rig.fx * std::tan(kAnyColumn);
  double top = rig.cy - rig.fy * std::tan(kAnyRow), bottom = rig.cy + rig.fy * std::tan(kAnyRow);
  if (ground.normal && ground.normal->covariance().trace() < kSureNormal * kSureNormal) {
    const Eigen::Vector3d& n = ground.normal->vector();
    const double horizon = rig.cy - rig.fy * n.z() / n.y(), tilt = std::abs(n.x() / n.y()) * aside;
    top = horizon - tilt;
    bottom = horizon + tilt + rig.fy * std::tan(kLowest);
  }
  return {cv::Point(static_cast<int>(rig.cx - aside), static_cast<int>(top)),
          cv::Point(static_cast<int>(rig.cx + aside), static_cast<int>(bottom))};
}

Failure SightFit::problemOf(const OutlinePose& found, const KnownGround& ground) const {
  const Eigen::Vector3d& p = found.pose.position;
  const double down = std::atan2(p.z(), -p.x());
  if (!within(-p.x(), kNearest * found.size.width, kFarthest) || p.z() < kLowestFlight ||
      !within(down, kFlattest, kSteepest) || std::abs(p.y()) > kAside * -p.x() + kBeside)
    return noRunway("not where a runway lies on an approach");
  if (std::abs(found.pose.yaw) > max_yaw_ ||
      std::max(std::abs(found.pose.roll), std::abs(found.pose.pitch)) > kMostTilt)
    return noRunway("not as an aircraft on an approach sees a runway");
  const RunwaySize& size = found.size;
  if (!within(size.width, kNarrowest, kWidest) || !within(size.length, kShortest, kLongest) ||
      size.length < kLeastAspect * size.width)
    return noRunway(
        text("a surface of ", rounded(size.width), " x ", rounded(size.length), " m is no runway"));
  if (found.misfit > kMostMisfit)
    return noRunway(text("the outline contradicts what is known of runway and ground, with a chi-square of ",
                         rounded(found.misfit)));
  if (ground.plane.valid() && !(std::abs(offPlane(found, ground.plane)) <= kMostOffPlane))
    return {Reason::kRejected,
            text("by the outline the runway lies ", rounded(p.z()),
                 " m below the camera, and by stereo the ground ", rounded(ground.plane.height()),
                 " m: check runway/width and runway/length")};
  return {};
}

OutlineLook SightFit::lookOf(const RunwaySize& about) const {
  OutlineLook look;
  look.focal_length = model_.rig.fx;
  if (about.width > 0) look.size = about;
  if (runway_.width > 0) look.size.width = runway_.width;
  if (runway_.length > 0) look.size.length = runway_.length;
  return look;
}

/// Set when an outline hardly stands out from the texture of the ground.
Failure SightFit::faintness(const FittedOutline& outline, const Corners& corners, double width,
                            const KnownGround& ground) const {
  const double scale = (corners[3] - corners[0]).norm() / width;  // px a metre
  const double stripes = shownStripe(outline.stripes, scale);
  const double clarity = std::max(std::abs(outline.contrast), stripes) / outline.residual;
  if (clarity >= (ground.plane.valid() ? kClear : kClearAlone)) return {};
  return noRunway(
      text("the outline stands out from the ground by ", rounded(clarity), " times its texture only"));
}

Expected<SightedRunway> SightFit::withPose(const FittedOutline& outline, const Corners& corners, double width,
                                           const KnownGround& ground) const {
  if ((corners[3] - corners[0]).norm() > kBroad * model_.rig.size.width)
    return tl::make_unexpected(noRunway("the runway is near: its markings tell more than its outline"));
  if (const Failure faint = faintness(outline, corners, width, ground)) return tl::make_unexpected(faint);
  PoseElements elements;
  elements.stereo = false;  // it is to tell whether the chart is right
  const Expected<OutlinePose> pose = fitPose(outline.seen, knowledge(ground), model_.rig, elements);
  if (!pose) return tl::make_unexpected(pose.error());
  return SightedRunway{outline, *pose, corners, {}};
}

Expected<SightedRunway> SightFit::fit(const cv::Mat& left, const Corners& start, const KnownGround& ground,
                                      const RunwaySize& about) const {
  const OutlineLook look = lookOf(about);
  const Expected<FittedOutline> outline = fitOutline(left, model_.left_mask, start, look);
  if (!outline) return tl::make_unexpected(outline.error());
  return withPose(*outline, movedBy(start, outline->seen.inward), look.size.width, ground);
}

Expected<SightedRunway> SightFit::follow(const cv::Mat& left, const Corners& start, const KnownGround& ground,
                                         const SightedRunway& last) const {
  const OutlineLook look = lookOf(last.pose.size);
  EdgeReadings readings = last.readings;
  const Expected<EdgeReadings::Outline> outline = readings.fit(left, model_.left_mask, start, look);
  if (!outline) return tl::make_unexpected(outline.error());
  Expected<SightedRunway> seen = withPose(outline->fitted, outline->corners, look.size.width, ground);
  if (seen) seen->readings = readings;
  return seen;
}

std::optional<Corners> SightFit::betterStart(const SightedRunway& seen) const {
  if (seen.pose.misfit <= kPoorFit) return std::nullopt;
  return cornersOf(seen.pose.pose, seen.pose.size, model_.rig);
}

bool SightFit::isPlausible(const Corners& corners, const KnownGround& ground) const {
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

}  // namespace uav_landing
