#include "uav_landing/stages/approach_angle_stage.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <optional>
#include <utility>
#include <vector>

#include "far/sighted_ground.h"
#include "far/sighting.h"
#include "image/input/image_check.h"
#include "integrity/tests/runway_identity.h"
#include "motion/path/angle_by_foe.h"
#include "motion/path/angle_normal.h"
#include "motion/path/motion_corners.h"
#include "motion/path/motion_tracker.h"
#include "motion/step/readout_filter.h"
#include "results/any_angle.h"
#include "results/result_check.h"
#include "rig/plane_by_turns.h"
#include "rig/plane_rate.h"
#include "runway/direction/runway_direction.h"
#include "runway/position/runway_tracker.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr double kPatience = 1;  // s, after which directions of a pair say nothing about the next

/// Unit directions that a pair shows: that of flight and that of the runway.
struct SeenDirections {
  double stamp = kUnknown;
  std::optional<Eigen::Vector3d> path, runway;
};

/// Effect of an estimated readout time on the ground's normal or plane, and the covariance without that
/// effect.
struct DoubtByReadout {
  Eigen::Vector3d by_time = Eigen::Vector3d::Zero();  ///< 1/s for a normal, 1/m/s for a plane
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

}  // namespace

struct ApproachAngleStage::Implementation {
  RigModel model;
  ApproachAngleParameters parameters;
  RunwayParameters known_runway;
  cv::Mat left_mask, right_mask;  // eroded, for lines and corners
  MotionTracker tracker;
  RunwayTracker runway;
  Sighting sighting;
  SightedGround sighted_ground;
  RunwayIdentity identity;
  SeenDirections last;
  double stamp_before = kUnknown;
  bool first_search = true;  // the first search for the plane has not ended
  bool lines_left_out = false;
  RunwayDirectionMemory direction_memory;
  CornerMemory corner_memory;
  ReadoutCheck readout;
  std::optional<ReadoutFilter> readout_time;  // while it is estimated
  Eigen::Vector3d last_normal = Eigen::Vector3d::Constant(kUnknown);
  Timings timings;

  Implementation(const RigModel& rig, const ApproachAngleParameters& p, const RunwayParameters& known)
      : model(rig),
        parameters(p),
        known_runway(known),
        tracker(rig, p),
        runway(rig, p, known),
        sighting(rig, p, known),
        sighted_ground(rig.rig),
        readout(rig.left_times, rig.right_times) {
    left_mask = erodeMask(rig.left_mask, p.window_radius + 2);
    right_mask = erodeMask(rig.right_mask, p.window_radius + 2);
    forgetReadout();
  }

  ApproachAngleResult process(double stamp, const cv::Mat& left, const cv::Mat& right,
                              StereoDepthResult stereo, const AttitudePrior& imu) {
    timings.clear();
    ApproachAngleResult result = begun(stamp, repeated(stereo), imu);
    result.failure = checkPair(model, left, right);
    const Failure too_long = readout.follow(stamp);
    if (!result.failure) result.failure = too_long;
    if (result.failure) {
      nothingKnown(result);
      if (result.failure.reason == Reason::kInputInvalid) return result;
      skip(result, left, stereo);
      return result;
    }
    const bool waits = waitsForPlane(stamp, stereo);
    sight(stamp, {left, right}, stereo, waits, result);
    if (waits) {
      result.failure = {Reason::kNotYet,
                        "waiting for the ground plane: lines and motion follow one pair later"};
      nothingKnown(result);
      skip(result, left, stereo);
      return result;
    }
    const DoubtByReadout plane = carryToStamp(stereo, result);
    const bool has_plane = parameters.use_stereo && !stereo.failure && stereo.plane.valid();
    if (!(stamp > last.stamp && stamp - last.stamp <= kPatience)) last = {};
    const SeenGround ground{
        stereo.plane, stereo.vertical_rotation,   runway.isSettled(stamp), last.path, last.runway,
        known_runway, identity.otherProbability()};
    if (has_plane) last_normal = stereo.plane.normal();
    lines_left_out = leavesOutLines(stamp, has_plane);
    const RunwayDirection direction = lines_left_out
                                          ? noDirection(result)
                                          : findDirection(left, right, has_plane ? &ground : nullptr, result);
    DoubtByReadout normal;
    if (!findNormal(has_plane ? &stereo.plane : nullptr, plane, normal, result)) {
      result.failure = {Reason::kNoGroundNormal,
                        "neither a stereo plane nor a vanishing point nor an imu's attitude"};
      nothingKnown(result);
      skip(result, left, stereo);
      return result;
    }
    straightenPlan(result);
    last_normal = result.n;
    followMotion(left, has_plane ? &stereo : nullptr, repeated(stereo), normal, result);
    if (!repeated(stereo)) sighted_ground.learn(result.window);
    if (repeated(stereo)) {
      result.other_runway_probability = identity.otherProbability();
    } else {
      identify(stamp, direction, result);
    }
    ScopedTimer timer(timings, "runway_position");
    if (repeated(stereo)) {
      result.runway.failure = result.runway.threshold_failure = result.step.failure;
    } else {
      result.runway = runway.process({left, model.left_mask, rowsOf(result, model.rig.K(), model.left_times)},
                                     result, direction, has_plane ? stereo.plane.height() : kUnknown);
    }
    return result;
  }

  // What is known of a pair before its images are looked at.
  ApproachAngleResult begun(double stamp, bool repeated, const AttitudePrior& imu) const {
    ApproachAngleResult result;
    result.stamp = stamp;
    result.readout = currentReadout();
    if (parameters.use_imu) result.imu = overSlopingGround(imu);
    // The rows of a repeated image were exposed at another time.
    if (repeated && result.imu.rows) {
      result.imu.rows.reset();
      result.imu.rows_failure = {Reason::kInconsistent, "the left image is that of the pair before"};
    }
    return result;
  }

  // Carries the plane of stereo to the stamp, as rows are exposed at times of their own.
  DoubtByReadout carryToStamp(StereoDepthResult& stereo, ApproachAngleResult& result) const {
    const std::optional<RowMotion> motion = tracker.lastMotion(result.stamp, result.imu);
    DoubtByReadout plane{Eigen::Vector3d::Zero(), stereo.plane.covariance};
    plane.by_time = motion ? carryPlane(*motion, result.readout, stereo) : carryPlane(result.readout, stereo);
    const RowTimes& times = model.left_times.atOnce() ? model.left_unit_times : model.left_times;
    result.plane_by_turns = planeByTurns(
        model.rig, times, {motion ? motion->beyond : GyroTurn(), tracker.vibration(result.stamp)}, stereo);
    plane.covariance += takeOff(result.plane_by_turns, stereo);
    return plane;
  }

  // Far away, the runway is seen before stereo has a plane. Its search waits while another one takes the time
  // of the pair.
  void sight(double stamp, const RectifiedImages& images, const StereoDepthResult& stereo, bool waits,
             ApproachAngleResult& result) {
    ScopedTimer timer(timings, "runway_outline");
    if (repeated(stereo)) {
      result.sight.failure = {Reason::kInconsistent, "the left image is that of the pair before"};
      return;
    }
    const bool has_plane = parameters.use_stereo && !stereo.failure && stereo.plane.valid();
    result.sight = sighting.process(stamp, images, sighted_ground.of(stereo, has_plane, result.imu),
                                    waits || (has_plane && tracker.needsSearch()));
  }

  void forgetReadout() {
    readout_time.reset();
    if (model.estimates_readout) readout_time.emplace();
  }

  ReadoutEstimate currentReadout() const {
    if (readout_time) return readout_time->estimate();
    return model.left_unit_times.atOnce() ? ReadoutEstimate() : ReadoutEstimate::global();
  }

  // When nothing is told of the shutter it counts as global, until rows are seen to move on their own.
  void learnReadout(const MotionTracker::Result& motion) {
    if (readout_time) {
      if (motion.step_estimate) readout_time->learn(motion.readout, motion.step.duration);
    } else if (!model.left_unit_times.atOnce() && (motion.step.rowsMove() || motion.window.rowsMove())) {
      readout_time.emplace(ReadoutFilter::kGlobalAfterSign);
      tracker.forgetRows();
    }
  }

  // Maps rows to the stamp with the last motion over the last known ground.
  StampMap rowsOf(const ApproachAngleResult& result, const Eigen::Matrix3d& K, const RowTimes& times) const {
    const std::optional<RowMotion> motion = tracker.lastMotion(result.stamp, result.imu);
    if (times.atOnce() || !motion || !last_normal.allFinite()) return {};
    return {K, times, *motion, last_normal};
  }

  StereoViews viewsOf(const ApproachAngleResult& result, const cv::Mat& left, const cv::Mat& right) const {
    Eigen::Matrix3d right_K = model.rig.K();
    right_K(0, 2) = model.rig.cx_right;
    return {model.rig,
            {left, left_mask, rowsOf(result, model.rig.K(), model.left_times)},
            {right, right_mask, rowsOf(result, right_K, model.right_times)}};
  }

  // Sets motion and runway to not known, with the reason of the pair.
  static void nothingKnown(ApproachAngleResult& result) {
    result.step.failure = result.window.failure = result.failure;
    result.runway.failure = result.runway.threshold_failure = result.failure;
    if (!result.sight.failure && !result.sight.position.allFinite()) result.sight.failure = result.failure;
  }

  void identify(double stamp, const RunwayDirection& direction, ApproachAngleResult& result) {
    identity.follow(stamp,
                    {{result.vanishing_direction, result.vanishing_covariance},
                     direction.combined ? direction.combined->runway_margin : 0,
                     last.path.has_value()},
                    result.n, result.step);
    result.other_runway_probability = identity.otherProbability();
    const Eigen::Vector3d& t = result.step.translation_over_height;
    last = {result.stamp, std::nullopt, std::nullopt};
    if (!result.step.failure && t.allFinite()) last.path = t.normalized();
    if (result.vanishing_direction.allFinite()) last.runway = result.vanishing_direction;
  }

  // Lines and the first step of the motion are looked for on the ground. They wait for the first search for
  // its plane, which takes all the time of a pair, also in the pair in which it ends.
  bool waitsForPlane(double stamp, const StereoDepthResult& stereo) {
    if (!(stamp > std::exchange(stamp_before, stamp))) first_search = true;
    if (!parameters.use_stereo || !first_search) return false;
    if (stereo.from_search || !stereo.failure) first_search = stereo.failure.reason == Reason::kNotYet;
    return stereo.from_search;
  }

  // The search for the first step of the motion takes the time of the lines. The motion comes first, because
  // it carries the ground that is in view now to below the aircraft. Lines come first only when they alone
  // give the normal.
  bool leavesOutLines(double stamp, bool has_plane) const {
    const bool needs_lines = parameters.normal_source == NormalSource::kVanishingLine;
    return has_plane && !needs_lines && !lines_left_out && tracker.needsSearch() &&
           !runway.isSettled(stamp) && !parameters.search_at_once;
  }

  static RunwayDirection noDirection(ApproachAngleResult& result) {
    result.left.failure =
        result.right.failure = {Reason::kNotYet, "searching for the motion: lines follow with the next pair"};
    return {};
  }

  void skip(const ApproachAngleResult& result, const cv::Mat& left, const StereoDepthResult& stereo) {
    if (repeated(stereo)) return;
    last = {};
    identity.skip(result.stamp);
    tracker.skip(result.stamp, left, result.imu);
    runway.skip(result.stamp);
  }

  // The ground differs from level ground by its slope, so the slope is added to the covariance of the normal.
  AttitudePrior overSlopingGround(AttitudePrior imu) const {
    const double slope = parameters.runway_slope_stddev_deg * kDegree;
    imu.normal_covariance +=
        slope * slope * (Eigen::Matrix3d::Identity() - imu.normal * imu.normal.transpose());
    return imu;
  }

  RunwayDirection findDirection(const cv::Mat& left, const cv::Mat& right, const SeenGround* ground,
                                ApproachAngleResult& result) {
    RunwayDirection direction =
        findRunwayDirection(viewsOf(result, left, right), ground, parameters, direction_memory, timings);
    result.left = direction.left;
    result.right = direction.right;
    if (!direction.combined) return direction;
    result.vanishing_direction = direction.combined->direction;
    result.vanishing_covariance = direction.combined->covariance;
    const std::optional<GroundNormal> level =
        normalFromVanishingPoint(*direction.combined, 0.0, parameters.level_roll_stddev_deg * kDegree);
    if (!level) return direction;
    result.n_vp = level->vector();
    result.n_vp_covariance = level->covariance();
    return direction;
  }

  // Finds the normal that the angles refer to. Returns false when there is none.
  bool findNormal(const GroundPlane* plane, const DoubtByReadout& of_plane, DoubtByReadout& normal,
                  ApproachAngleResult& result) const {
    constexpr double kApart = 1e-6;  // s, difference of the readout times for a numerical derivative
    NormalSources sources{plane, GroundDirection::of(result.vanishing_direction, result.vanishing_covariance),
                          GroundNormal::of(result.n_vp, result.n_vp_covariance), result.imu};
    GroundPlane carried;
    const bool doubted = plane != nullptr && !of_plane.by_time.isZero(0);
    if (doubted) {
      carried = *plane;
      carried.covariance = of_plane.covariance;
      sources.plane = &carried;
    }
    const std::optional<AngleNormal> found = findAngleNormal(sources, parameters);
    if (!found) return false;
    result.n = found->normal.vector();
    result.n_covariance = normal.covariance = found->normal.covariance();
    if (found->imu_failure) result.imu.failure = found->imu_failure;
    if (!doubted) return true;
    carried.g += kApart * of_plane.by_time;
    if (const std::optional<AngleNormal> later = findAngleNormal(sources, parameters))
      normal.by_time = (later->normal.vector() - result.n) / kApart;
    result.n_covariance += result.readout.variance * normal.by_time * normal.by_time.transpose();
    return true;
  }

  // The runway's own slope and curve move its vanishing point up and down. Seen from above the runway is
  // straight, so this error is taken out of the covariance across. The yaw refers to this direction.
  void straightenPlan(ApproachAngleResult& result) const {
    if (!result.vanishing_direction.allFinite()) return;
    const Eigen::Vector3d across = result.n.cross(result.vanishing_direction).normalized();
    const double straightness = parameters.runway_straightness_deg * kDegree;
    result.vanishing_covariance -= straightness * straightness * across * across.transpose();
  }

  // A repeated image was not taken at its stamp. It says nothing about the motion up to now, and the motion
  // to the next image takes the time of both.
  bool repeated(const StereoDepthResult& stereo) const {
    return parameters.use_stereo && stereo.left_repeated;
  }

  void followMotion(const cv::Mat& left, const StereoDepthResult* stereo, bool repeated,
                    const DoubtByReadout& normal, ApproachAngleResult& result) {
    const double stamp = result.stamp;
    const std::vector<TrackedCorner> corners =
        stereo ? stereoCorners(model.rig, *stereo) : cornersWithoutStereo(left, result.n);
    const StepConditions conditions{
        stereo || hasPaperForm(parameters) ? GroundProof::kGiven : GroundProof::kMotion,
        !stereo                                     ? SearchTime::kLeast
        : lines_left_out || runway.isSettled(stamp) ? SearchTime::kAmple
                                                    : SearchTime::kShort,
        result.readout, result.imu};
    const GroundInView seen{{result.n, normal.covariance}, normal.by_time, corners};
    const MotionTracker::Result motion =
        repeated ? tracker.repeat(stamp) : tracker.process(stamp, left, seen, timings, conditions);
    learnReadout(motion);
    ScopedTimer timer(timings, "foe_and_angle");
    const StepFoe found =
        findStepFoe(model.rig, tracker, motion, {result.n, result.n_covariance}, parameters);
    result.foe = found.foe;
    result.foe_covariance = found.covariance;
    result.step = found.step;
    result.window = hasPaperForm(parameters) ? result.step : motion.window;
    const Failure& angle = result.window.failure ? result.step.failure : result.window.failure;
    if (angle) result.failure = angle;
  }

  std::vector<TrackedCorner> cornersWithoutStereo(const cv::Mat& left, const Eigen::Vector3d& normal) {
    ScopedTimer timer(timings, "harris_corners_motion");
    return groundCorners(model.rig, {left, left_mask}, normal, parameters, corner_memory);
  }
};

ApproachAngleStage::ApproachAngleStage(const RigModel& rig, const ApproachAngleParameters& parameters,
                                       const RunwayParameters& runway)
    : implementation_(std::make_unique<Implementation>(rig, parameters, runway)) {}
ApproachAngleStage::~ApproachAngleStage() = default;
ApproachAngleStage::ApproachAngleStage(ApproachAngleStage&&) noexcept = default;

ApproachAngleResult ApproachAngleStage::process(double stamp, const cv::Mat& left, const cv::Mat& right,
                                                const StereoDepthResult& stereo, const AttitudePrior& imu) {
  return implementation_->process(stamp, left, right, checked(implementation_->model.rig, stereo), imu);
}

void ApproachAngleStage::reset() {
  implementation_->tracker.reset();
  implementation_->runway.reset();
  implementation_->sighting.reset();
  implementation_->sighted_ground.reset();
  implementation_->identity = RunwayIdentity();
  implementation_->last = {};
  implementation_->first_search = true;
  implementation_->lines_left_out = false;
  implementation_->readout.reset();
  implementation_->forgetReadout();
  implementation_->last_normal.setConstant(kUnknown);
}

const Timings& ApproachAngleStage::timings() const { return implementation_->timings; }

}  // namespace uav_landing
