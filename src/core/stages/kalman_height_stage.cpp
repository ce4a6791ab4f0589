#include "uav_landing/stages/kalman_height_stage.h"

#include <cmath>
#include <optional>

#include "base/text.h"
#include "height/attitude.h"
#include "landing/height/ground_estimate.h"
#include "landing/height/height_measurement.h"
#include "landing/height/height_track.h"
#include "landing/height/landing_clock.h"
#include "landing/height/pair_input.h"
#include "landing/height/surface_below.h"
#include "landing/report/landing_report.h"
#include "landing/report/runway_report.h"
#include "landing/report/runway_track.h"
#include "landing/watch/pair_monitor.h"
#include "landing/watch/path_doubt.h"
#include "landing/watch/recovery_wait.h"
#include "landing/watch/sink_rate_watch.h"
#include "landing/watch/yaw_failure.h"
#include "runway/position/position_filter.h"
#include "uav_landing/geometry/row_times.h"

namespace uav_landing {
namespace {

/// All knowledge from the pairs before. A new object knows nothing.
struct Parts {
  GroundEstimate ground;
  HeightMeasurement measurement;
  PairMonitor monitor;
  HeightTrack track;
  SinkRateWatch sink_rate;
  RecoveryWait recovery;
  SurfaceBelow below;
  PathDoubt doubt;
  PositionFilter position;
  RunwayTrack runway;
  FailureCounts failures;

  Parts(const StereoRig& rig, const KalmanHeightParameters& parameters, const RunwayParameters& runway,
        double baseline_stddev, int resets)
      : ground(rig, parameters),
        measurement(rig, parameters, runway, baseline_stddev),
        monitor(rig, parameters),
        track(parameters, resets),
        sink_rate(parameters),
        recovery(parameters),
        below(rig, parameters.gate),
        doubt(parameters),
        position(parameters),
        runway(parameters) {}
};

/// The ground and the height that a pair shows by itself, and the prediction for it.
struct Look {
  HeightPrior prior;
  Ground ground;
  MeasuredHeight by_ground;
};

/// A pair with what was found and decided about it.
struct Judged {
  const PairInput& in;
  const Look& look;
  const MeasuredHeight& measured;
  const PairVerdict& pair;
  const TrackVerdict& post;
};

}  // namespace

struct KalmanHeightStage::Implementation {
  StereoRig rig;
  KalmanHeightParameters parameters;
  RunwayParameters runway;
  double baseline_stddev;
  bool readout_given;
  LandingClock clock;
  std::optional<Parts> parts;
  Timings timings;

  Implementation(const StereoRig& given, const KalmanHeightParameters& p, const RunwayParameters& known,
                 const RigParameters& known_rig)
      : rig(given),
        parameters(p),
        runway(known),
        baseline_stddev(known_rig.baseline_stddev),
        readout_given(unknownReadout(known_rig).time == 0),
        clock(p.reset_timeout, p.gate),
        parts(std::in_place, rig, parameters, runway, baseline_stddev, 0) {}

  void startAnew() {
    parts->track.lose();
    const int resets = parts->track.resets();
    parts.emplace(rig, parameters, runway, baseline_stddev, resets);
  }

  // The steps of a pair, in order.
  LandingResult process(PairInput in) {
    LandingResult result;
    result.stamp = in.stamp();
    if (!std::isfinite(in.stamp())) return withoutStamp(result);
    std::optional<ScopedTimer> timer;
    timer.emplace(timings, "reconstruction");
    // Phase "ground".
    const LandingClock::Time time = clock.follow(in.stamp());
    in.T = time.T;
    if (time.jump) startAnew();
    Look look = lookAt(in);
    const Failure jump = time.jump ? time.jump : clock.compare(in, look.by_ground, look.prior);
    if (jump && !time.jump) {  // the clock was set: what was learned about the rig is forgotten, too
      startAnew();
      in.T = 0;
      look = lookAt(in);
    }
    addFailure(result, jump);

    timer.emplace(timings, "kalman_filter");
    // Phase "pair".
    const auto& [prior, ground, by_ground] = look;
    const MeasuredHeight measured = parts->measurement.propose(in, ground, by_ground, prior);
    const double duration_variance = parts->measurement.durationVariance();
    const PairVerdict pair = parts->monitor.check(in, ground, measured, prior, duration_variance);
    parts->ground.commit(pair.rig_believed, pair.rig_turned);
    // Phase "track".
    const TrackVerdict post =
        parts->track.update(in.stamp(), measured, pair.leftOut(), speedByMotion(in, ground, measured, pair));
    parts->measurement.commit(in, ground, measured, !pair.leftOut() && !post.rejection);
    reportHeight(measured, pair, post, result);
    PairTests tests = pair.tests;
    post.addTo(tests);
    // Phase "memory".
    const Failure waiting = guardHeight({in, look, measured, pair, post}, tests, result);

    if (!in.repeated()) parts->doubt.update(in, ground, tests);
    reportAngle(in, ground, parts->doubt, pair.velocity, result);
    judgeAngle(in, refusalOf(measured, pair, waiting ? result.failure : jump),
               parameters.max_angle_stddev_deg, result);
    reportDirections(in, ground, pair, result);
    // The velocity's scale is that of the height, which has to be believed again first.
    if (!waiting && motionBelieved(ground, pair)) {
      reportTwist(believedTwist(in, pair, scaleOfStep(rig, in, ground, result), doubtOfStep(in, ground)),
                  result);
      // After a contradiction the aircraft may fly at almost any speed, so some steps have to agree first.
      if (parameters.integrity_monitor && pair.velocity.agreed < parameters.recovery_time)
        result.forgetVelocity();
    }
    result.height_origin = originOf(measured, result);
    timer.emplace(timings, "runway_filter");
    reportPosition(in, ground, pair.leftOut() || post.rejection, result);
    timer.reset();
    if (parameters.rig_watch) reportRig(parts->ground.rigRotation(), parameters.max_rig_rotation_deg, result);
    if (!result.height_valid) result.forgetVelocity();
    if (parameters.integrity_monitor) result.tests = parts->failures.count(tests);
    result.resets = parts->track.resets();
    return result;
  }

  Look lookAt(const PairInput& in) {
    const HeightPrior prior = parts->track.predict(in.T);
    const bool rig_doubted = parts->monitor.doubtsRig(in.stereo.vertical_rotation);
    const Ground ground = parts->ground.propose(in, rig_doubted, prior.known());
    return {prior, ground, heightByGround(rig, parameters, in, ground)};
  }

  // When the plane is contradicted, nobody knows which part of the motion was downwards.
  VerticalSpeed speedByMotion(const PairInput& in, const Ground& ground, const MeasuredHeight& measured,
                              const PairVerdict& pair) const {
    if (!parameters.use_motion || !ground.plane.valid() || !pair.knowsDown()) return {};
    const double above_plane = measured.height - ground.surface.bend;
    return withDurations(
        verticalSpeed(in.step(), ground.surface.below, above_plane,
                      {measured.variance, parameters.height_model_error, parameters.acceleration_stddev}),
        parts->measurement.durationVariance());
  }

  // By the doubt as it is: that of the pairs before until this pair has been tested.
  MotionDoubt doubtOfStep(const PairInput& in, const Ground& ground) const {
    return {parts->doubt.variance(in, ground, in.step()), parts->measurement.durationVariance()};
  }

  // Tests the published height and bounds its error. Returns the reason when the height has to wait.
  Failure guardHeight(const Judged& judged, PairTests& tests, LandingResult& result) {
    if (!parameters.integrity_monitor) return {};
    const auto& [in, look, measured, pair, post] = judged;
    const MotionDoubt doubt = doubtOfStep(in, look.ground);
    refuseHeight(result,
                 parts->sink_rate.check(in, look.ground, {post.filter, measured.errors}, doubt, tests));
    const Failure waiting = parts->recovery.follow(in.T, pair, tests, post);
    refuseHeight(result, waiting);
    parts->below.follow(in, look.ground, measured, pair.leftOut(), post);
    if (std::isfinite(result.height))
      reportProtection(parts->track, groundBelow(in, look.ground, result.height), parameters, result);
    return waiting;
  }

  std::optional<GroundMemory::Below> groundBelow(const PairInput& in, const Ground& ground,
                                                 double height) const {
    const std::optional<Eigen::Vector3d> normal = parts->below.normal(in, ground);
    return normal ? parts->below.below(height, *normal) : std::nullopt;
  }

  void reportDirections(const PairInput& in, const Ground& ground, const PairVerdict& pair,
                        LandingResult& result) {
    result.other_runway_probability = in.approach.other_runway_probability;
    result.yaw_failure = yawFailure(in, pair);
    std::optional<GroundDirection> runway;
    if (!result.yaw_failure)
      runway = GroundDirection::of(in.approach.vanishing_direction, in.approach.vanishing_covariance);
    reportAttitude(ground.normalOr(in.normal()), runway, result);
  }

  // A step that contradicts the velocity before may belong to another period of a pattern, or to the other
  // camera. Nobody can tell before three steps have agreed, or in an unusual turn.
  bool motionBelieved(const Ground& ground, const PairVerdict& pair) const {
    const TestResult& compared = pair.tests.result(IntegrityTest::kVelocity);
    const bool agrees = !parameters.integrity_monitor || (compared.possible() && !compared.failed());
    return agrees && !pair.angle_refused && !ground.tilted;
  }

  // Where a pair is refused its stereo is in doubt, and so is what that says of the runway.
  static ApproachAngleResult::Sight believedSight(const PairInput& in, bool refused) {
    ApproachAngleResult::Sight sight = in.approach.sight;
    if (refused && std::isfinite(sight.disparity))
      sight.failure = {Reason::kInconsistent, "the pair is refused"};
    return sight;
  }

  void reportPosition(const PairInput& in, const Ground& ground, bool refused, LandingResult& result) {
    const double bend = ground.surface.bend;
    parts->position.process(in.approach, ground.positionNormalOr(in.approach.n), in.turn,
                            {result.height_valid ? result.height - bend : kUnknown, result.height_variance,
                             result.height_protection_level},
                            result);
    Eigen::Vector3d direction = in.approach.vanishing_direction;
    if (result.yaw_failure) direction.setConstant(kUnknown);
    const ApproachAngleResult::Sight sight = believedSight(in, refused);
    const TrackedPosition outline =
        parts->runway.follow(in.T, sight, runwayVelocity(result, in.approach.n, direction));
    handOver(outline, sight, result);
    reportHeightAboveRunway(outline, bend, parts->measurement.widthKnown(), parameters, result);
  }

  // A pair without a time says nothing, and what is known stays as it is.
  LandingResult withoutStamp(LandingResult result) const {
    result.failure = result.yaw_failure = {Reason::kInputInvalid, "the stamp is not a finite number"};
    result.status = parts->track.status();
    result.resets = parts->track.resets();
    return result;
  }

  LandingResult timeout(double stamp) {
    if (clock.since(stamp).value_or(0) > parameters.reset_timeout) parts->track.lose();
    LandingResult result;
    result.stamp = stamp;
    result.status = Status::kLost;
    result.failure =
        result.yaw_failure = {Reason::kTimeout, text("no image pair for ", parameters.max_age, " s")};
    result.resets = parts->track.resets();
    return result;
  }
};

KalmanHeightStage::KalmanHeightStage(const StereoRig& rig, const KalmanHeightParameters& parameters,
                                     const RunwayParameters& runway, const RigParameters& known_rig)
    : implementation_(std::make_unique<Implementation>(rig, parameters, runway, known_rig)) {}
KalmanHeightStage::KalmanHeightStage(const KalmanHeightStage& other)
    : implementation_(std::make_unique<Implementation>(*other.implementation_)) {}
KalmanHeightStage& KalmanHeightStage::operator=(const KalmanHeightStage& other) {
  return *this = KalmanHeightStage(other);
}
KalmanHeightStage::~KalmanHeightStage() = default;
KalmanHeightStage::KalmanHeightStage(KalmanHeightStage&&) noexcept = default;
KalmanHeightStage& KalmanHeightStage::operator=(KalmanHeightStage&&) noexcept = default;

LandingResult KalmanHeightStage::process(const StereoDepthResult& stereo,
                                         const ApproachAngleResult& approach) {
  implementation_->timings.clear();
  return implementation_->process({implementation_->rig, stereo, approach,
                                   implementation_->parameters.fuse_imu, implementation_->readout_given});
}

LandingResult KalmanHeightStage::timeout(double stamp) { return implementation_->timeout(stamp); }

void KalmanHeightStage::reset() {
  implementation_->startAnew();
  implementation_->clock.reset();
}

const Timings& KalmanHeightStage::timings() const { return implementation_->timings; }

}  // namespace uav_landing
