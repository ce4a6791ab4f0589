#include "uav_landing/stages/approach_angle_stage.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <string>

#include "base/text.h"
#include "uav_landing/geometry/half_plane.h"
#include "uav_landing/image/corners.h"
#include "uav_landing/image/image_check.h"
#include "uav_landing/motion/approach_angle.h"
#include "uav_landing/motion/focus_of_expansion.h"
#include "uav_landing/motion/motion_tracker.h"
#include "uav_landing/results/result_check.h"
#include "uav_landing/runway/runway_direction.h"
#include "uav_landing/runway/runway_tracker.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180.0;
// Chi-square limit (1 degree of freedom, 1e-4) beyond which a vanishing point contradicts the stereo plane.
constexpr double kMaxVanishingNis = 15.1;

}  // namespace

struct ApproachAngleStage::Implementation {
  RigModel model;
  ApproachAngleParameters parameters;
  cv::Mat left_mask, right_mask;  // eroded, for lines and corners
  MotionTracker tracker;
  RunwayTracker runway;
  Timings timings;

  Implementation(const RigModel& rig, const ApproachAngleParameters& p)
      : model(rig), parameters(p), tracker(rig, p), runway(rig, p) {
    left_mask = erodeMask(rig.left_mask, p.window_radius + 2);
    right_mask = erodeMask(rig.right_mask, p.window_radius + 2);
  }

  ApproachAngleResult process(double stamp, const cv::Mat& left, const cv::Mat& right,
                              const StereoDepthResult& stereo, const AttitudePrior& imu) {
    timings.clear();
    ApproachAngleResult result;
    result.stamp = stamp;
    if (parameters.use_imu) result.imu = overSlopingGround(imu);
    result.failure = checkPair(model, left, right);
    if (result.failure) {
      result.step.failure = result.window.failure = result.failure;
      result.runway.failure = result.runway.threshold_failure = result.failure;
      if (result.failure.reason == Reason::kInputInvalid) return result;
      skip(stamp, left, stereo);
      return result;
    }
    const bool has_plane = parameters.use_stereo && !stereo.failure && stereo.plane.valid();
    const SeenGround ground{stereo.plane, stereo.vertical_rotation, runway.isSettled(stamp)};
    const RunwayDirection direction = findDirection(left, right, has_plane ? &ground : nullptr, result);
    if (!findNormal(has_plane ? &stereo.plane : nullptr, result)) {
      result.failure = {Reason::kNoGroundNormal,
                        "neither a stereo plane nor a vanishing point nor an imu's attitude"};
      result.step.failure = result.window.failure = result.failure;
      result.runway.failure = result.runway.threshold_failure = result.failure;
      skip(stamp, left, stereo);
      return result;
    }
    straightenPlan(result);
    followMotion(stamp, left, has_plane ? &stereo : nullptr, repeated(stereo), result);
    ScopedTimer timer(timings, "runway_position");
    if (repeated(stereo)) {
      result.runway.failure = result.runway.threshold_failure = result.step.failure;
    } else {
      result.runway =
          runway.process(stamp, left, result, direction, has_plane ? stereo.plane.height() : kUnknown);
    }
    return result;
  }

  void skip(double stamp, const cv::Mat& left, const StereoDepthResult& stereo) {
    if (repeated(stereo)) return;
    tracker.skip(stamp, left);
    runway.skip(stamp);
  }

  // The ground's normal is that of level ground but for the slope of the ground.
  AttitudePrior overSlopingGround(AttitudePrior imu) const {
    const double slope = parameters.runway_slope_stddev_deg * kDegree;
    imu.normal_covariance +=
        slope * slope * (Eigen::Matrix3d::Identity() - imu.normal * imu.normal.transpose());
    return imu;
  }

  RunwayDirection findDirection(const cv::Mat& left, const cv::Mat& right, const SeenGround* ground,
                                ApproachAngleResult& result) {
    RunwayDirection direction =
        findRunwayDirection(model.rig, left, right, left_mask, right_mask, ground, parameters, timings);
    result.left = direction.left;
    result.right = direction.right;
    if (!direction.combined) return direction;
    result.vanishing_direction = direction.combined->direction;
    result.vanishing_covariance = direction.combined->covariance;
    const GroundNormal level =
        normalFromVanishingPoint(*direction.combined, 0.0, parameters.level_roll_stddev_deg * kDegree);
    result.n_vp = level.n;
    result.n_vp_covariance = level.covariance;
    return direction;
  }

  // The normal that the angles refer to; false when there is none.
  bool findNormal(const GroundPlane* plane, ApproachAngleResult& result) const {
    const bool has_direction = result.vanishing_direction.allFinite();
    const bool literal = parameters.normal_source == NormalSource::kVanishingLine;
    if (!literal && !plane && result.imu.hasNormal()) {
      // As a plane at the height of 1.
      const GroundPlane level{result.imu.normal, result.imu.normal_covariance};
      setNormal(has_direction ? withDirection(level, result) : level, result);
      return true;
    }
    if (literal || !plane) {
      if (!has_direction) return false;
      // The paper's level rig, or the roll that the stereo plane knows.
      GroundNormal normal{result.n_vp, result.n_vp_covariance};
      if (plane) {
        normal = normalFromVanishingPoint(
            {result.vanishing_direction, result.vanishing_covariance, {}, 0}, rollOf(plane->normal()),
            std::sqrt(rollVariance(plane->normal(), plane->normalCovariance())));
      }
      result.n = normal.n;
      result.n_covariance = normal.covariance;
      return true;
    }
    GroundPlane fused = has_direction ? withDirection(*plane, result) : *plane;
    if (result.imu.hasNormal()) {
      double nis = 0;
      fused = fuseNormal(fused, {result.imu.normal, result.imu.normal_covariance}, kMaxVanishingNis, &nis);
      if (!(nis <= kMaxVanishingNis)) {
        const double off = std::acos(std::clamp(fused.normal().dot(result.imu.normal), -1.0, 1.0));
        result.imu.failure = {Reason::kRejected, text("the imu's attitude is ", rounded(off / kDegree),
                                                      " deg off the ground ahead")};
      }
    }
    setNormal(fused, result);
    return true;
  }

  // The runway's own slope and curve turn its vanishing point up and down. Seen from above it is straight,
  // and yaw is against that.
  void straightenPlan(ApproachAngleResult& result) const {
    if (!result.vanishing_direction.allFinite()) return;
    const Eigen::Vector3d across = result.n.cross(result.vanishing_direction).normalized();
    const double straightness = parameters.runway_straightness_deg * kDegree;
    result.vanishing_covariance -= straightness * straightness * across * across.transpose();
  }

  static GroundPlane withDirection(const GroundPlane& plane, const ApproachAngleResult& result) {
    return fuseVanishingPoint(plane, result.vanishing_direction, result.vanishing_covariance,
                              kMaxVanishingNis, nullptr);
  }

  static void setNormal(const GroundPlane& plane, ApproachAngleResult& result) {
    result.n = plane.normal();
    result.n_covariance = plane.normalCovariance();
  }

  // A picture once more was not taken at its stamp: it says nothing of the motion up to now, and the motion
  // to the next one is over the time of both.
  bool repeated(const StereoDepthResult& stereo) const {
    return parameters.use_stereo && stereo.left_repeated;
  }

  void followMotion(double stamp, const cv::Mat& left, const StereoDepthResult* stereo, bool repeated,
                    ApproachAngleResult& result) {
    const std::vector<TrackedCorner> corners =
        stereo ? stereoCorners(*stereo) : groundCorners(left, result.n);
    const MotionTracker::Result motion =
        repeated ? tracker.repeat(stamp)
                 : tracker.process(stamp, left, result.n, result.n_covariance, corners, timings, result.imu);
    ScopedTimer timer(timings, "foe_and_angle");
    result.step = motion.step;
    result.window = motion.window;
    findFoe(motion, result);
    if (paperForm()) result.window = result.step;
    const Failure& angle = result.window.failure ? result.step.failure : result.window.failure;
    if (angle) result.failure = angle;
  }

  // Corners with depth from the pair: the plane for those on it, their own disparity for the others.
  std::vector<TrackedCorner> stereoCorners(const StereoDepthResult& stereo) const {
    constexpr double kSmallestDisparity = 1.0;
    const double height = stereo.plane.height();
    std::vector<TrackedCorner> corners;
    for (const StereoDepthResult::Point& point : stereo.points) {
      if (!point.on_plane && point.disparity < kSmallestDisparity) continue;
      corners.push_back({cvRound(point.u), cvRound(point.v), point.on_plane,
                         height * point.disparity / model.rig.fb(),
                         height * point.disparity_stddev / model.rig.fb()});
    }
    return corners;
  }

  std::vector<TrackedCorner> groundCorners(const cv::Mat& left, const Eigen::Vector3d& normal) {
    // Nearer the horizon than this (as a tangent) the ground hardly moves.
    constexpr double kLeastSlope = 0.01;
    // What is texture enough, matching decides; corners spread over the ground as for stereo.
    constexpr double kQuality = 1e-7, kDistance = 4.0, kHarris = 0.04;
    ScopedTimer timer(timings, "harris_corners_motion");
    const Eigen::Vector3d slope = model.rig.Kinv().transpose() * normal;  // n.r as a function of the pixel
    cv::Mat mask;
    keepHalfPlane(left_mask, slope.x(), slope.y(), slope.z() - kLeastSlope, mask);
    std::vector<TrackedCorner> corners;
    const int count = cornerBudget(left.size(), parameters.corner_count, parameters.pixels_per_corner);
    for (const cv::Point& point : findCorners(left, mask, count, kQuality, kDistance, kHarris)) {
      corners.push_back({point.x, point.y, true, 0, 0});
    }
    return corners;
  }

  // The paper's forms are of one step.
  bool paperForm() const {
    return parameters.foe_method == FoeMethod::kSlidingWindow ||
           parameters.angle_formula == AngleFormula::kEq1;
  }

  void findFoe(const MotionTracker::Result& motion, ApproachAngleResult& result) const {
    if (motion.step.failure || !motion.step_estimate) return;
    const MotionEstimate& estimate = *motion.step_estimate;
    const bool vote = parameters.foe_method == FoeMethod::kSlidingWindow;
    const Expected<FocusOfExpansion> foe =
        vote ? foeSlidingWindow(model.rig, tracker.stepMatches(),
                                parameters.remove_rotation ? estimate.motion.R : Eigen::Matrix3d::Identity())
             : foeFromMotion(model.rig, estimate.motion.t, estimate.covariance.block<3, 3>(3, 3));
    if (!foe) {
      if (!vote) return;
      result.step.failure = foe.error();
      result.step.angle = result.step.angle_variance = kUnknown;
      return;
    }
    result.foe = foe->pixel;
    result.foe_covariance = foe->covariance;
    if (!paperForm()) return;
    angleFromFoe(result);
    claimDifference(motion, result);
  }

  // Rotation left in the velocities moves all of their crossings, and eq (1) leaves out roll and drift: the
  // scatter knows nothing of it. What the paper's forms differ from the motion by is a measure of it.
  void claimDifference(const MotionTracker::Result& motion, ApproachAngleResult& result) const {
    const Eigen::Vector2d off = result.foe - model.rig.project(motion.step_estimate->motion.t);
    result.foe_covariance += off * off.transpose();
    result.step.angle_variance += std::pow(result.step.angle - motion.step.angle, 2);
  }

  // Approach angle of the step from the FOE as a pixel, as the paper does.
  void angleFromFoe(ApproachAngleResult& result) const {
    const StereoRig& rig = model.rig;
    const Eigen::Vector3d direction = rig.ray(result.foe.x(), result.foe.y());
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    const Eigen::DiagonalMatrix<double, 2> per_pixel(1 / rig.fx, 1 / rig.fy);
    covariance.topLeftCorner<2, 2>() = per_pixel * result.foe_covariance * per_pixel;
    result.step.angle =
        parameters.angle_formula == AngleFormula::kEq1
            ? approachAngleEq1(rig.fy * result.n.z() / result.n.y(), rig.cy - result.foe.y(), rig.fy)
            : approachAngle(result.n, direction);
    result.step.angle_variance = approachAngleVariance(result.n, result.n_covariance, direction, covariance);
  }
};

ApproachAngleStage::ApproachAngleStage(const RigModel& rig, const ApproachAngleParameters& parameters)
    : implementation_(std::make_unique<Implementation>(rig, parameters)) {}
ApproachAngleStage::~ApproachAngleStage() = default;
ApproachAngleStage::ApproachAngleStage(ApproachAngleStage&&) noexcept = default;

ApproachAngleResult ApproachAngleStage::process(double stamp, const cv::Mat& left, const cv::Mat& right,
                                                const StereoDepthResult& stereo, const AttitudePrior& imu) {
  return implementation_->process(stamp, left, right, checked(implementation_->model.rig, stereo), imu);
}

void ApproachAngleStage::reset() {
  implementation_->tracker.reset();
  implementation_->runway.reset();
}

const Timings& ApproachAngleStage::timings() const { return implementation_->timings; }

}  // namespace uav_landing
