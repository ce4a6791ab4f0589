#include "uav_landing/stages/kalman_height_stage.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "height/attitude.h"
#include "height/vertical_speed.h"
#include "uav_landing/height/height_limit.h"
#include "uav_landing/height/reconstruction.h"
#include "uav_landing/height/runway_height.h"
#include "uav_landing/results/result_check.h"
#include "uav_landing/rig/rig_rotation.h"

namespace uav_landing {
KalmanHeightStage::KalmanHeightStage(const StereoRig& rig, const KalmanHeightParameters& parameters)
    : rig_(rig),
      parameters_(parameters),
      filter_(parameters.acceleration_stddev, parameters.initial_speed_stddev, parameters.gate),
      scatter_(parameters.gate * parameters.gate),
      speed_scatter_(parameters.gate * parameters.gate),
      rig_rotation_(rig, parameters.rig_memory),
      width_(parameters.known_runway_width),
      separation_(parameters),
      tests_(parameters.false_alarm_rate),
      speed_(parameters.max_deceleration),
      stamps_(parameters.max_deceleration),
      recovery_(parameters.recovery_time),
      doubt_(parameters.fault_probability, parameters.reset_timeout),
      motion_doubt_(parameters.fault_probability, parameters.reset_timeout) {}

LandingResult KalmanHeightStage::process(const StereoDepthResult& given_stereo,
                                         const ApproachAngleResult& given_approach) {
  timings_.clear();
  const StereoDepthResult stereo = checked(rig_, given_stereo);
  ApproachAngleResult approach = checked(given_approach);
  if (stereo.left_repeated)  // seen from where the camera was before
    approach.runway.failure =
        approach.runway.threshold_failure = {Reason::kInconsistent, toString(Consistency::kRepeatedImage)};
  tests_.begin();
  LandingResult result;
  result.stamp = stereo.stamp;
  if (!std::isfinite(stereo.stamp)) return withoutStamp(result);
  const double T = last_stamp_ ? stereo.stamp - *last_stamp_ : 0;
  Failure jump = followTime(stereo.stamp);
  Reconstruction reconstruction = reconstruct(stereo, approach);
  if (!jump) {
    jump = followClock(stereo, approach.step, reconstruction);
    // What was learned of the rig goes with the rest.
    if (jump) reconstruction = reconstruct(stereo, approach);
  }
  result.failure = jump;
  {
    const ScopedTimer timer(timings_, "kalman_filter");
    if (!stereo.left_repeated) {  // else the next motion is from the pair before
      averageAttitude(stereo, approach, reconstruction, result);
      followStamps(approach.step, reconstruction);
    }
    useWidth(approach.runway, reconstruction, result);
    leaveOutSources(stereo, approach, reconstruction);
    testPair(T, stereo, approach, reconstruction, result);
    // Of images that do not belong together the rig learns nothing.
    rig_rotation_.settle(!failedTestOfPair());
    if (!result.failure) result.failure = reconstruction.failure;
    filterHeight(stereo.stamp, reconstruction, approach.step, result);
    learnWidth(approach.runway, reconstruction, result);
    reportHeight(result);
    testMemory(T, reconstruction, approach, result);
    awaitRecovery(T, result);
    rememberGround(stereo, approach.step, reconstruction, result.rejected);
    reportProtection(knownNormal(reconstruction, approach), result);
  }
  if (!stereo.left_repeated) doubtNormal(reconstruction, approach);
  reportAngle(approach, reconstruction, jump, result);
  reportPlane(reconstruction, approach, stereo.left_repeated, result);
  reportMotion(stereo, approach, reconstruction, result);
  {
    const ScopedTimer timer(timings_, "runway_filter");
    Eigen::Vector3d n = approach.n;
    if (reconstruction.plane.valid())
      n = reconstruction.tilted ? reconstruction.normal.n : reconstruction.plane.normal();
    position_.process(approach, n, turnSince(approach),
                      result.height_valid ? result.height - reconstruction.bend : kUnknown,
                      result.height_variance, result);
    const RunwayHeight above = runwayHeight(result, reconstruction.bend, width_.independent());
    result.height_above_runway = above.height;
    result.height_above_runway_variance = above.variance;
  }
  reportRig(result);
  if (parameters_.integrity_monitor) result.tests = tests_.finish();
  return result;
}

// A pair of no time says nothing, and what is known stays as it is.
LandingResult KalmanHeightStage::withoutStamp(LandingResult result) const {
  result.failure = {Reason::kInputInvalid, "the stamp is not a finite number"};
  result.status = filter_.initialised() ? Status::kCoasting : lost_ ? Status::kLost : Status::kSearching;
  result.resets = resets_;
  return result;
}

LandingResult KalmanHeightStage::timeout(double stamp) {
  if (last_stamp_ && filter_.initialised() && stamp - *last_stamp_ > parameters_.reset_timeout) loseTrack();
  LandingResult result;
  result.stamp = stamp;
  result.status = Status::kLost;
  result.failure = {Reason::kTimeout, text("no image pair for ", parameters_.max_age, " s")};
  result.resets = resets_;
  return result;
}

void KalmanHeightStage::reset() {
  position_.reset();
  attitude_.reset();
  width_.reset();
  rig_rotation_.reset();
  width_variance_ = rig_variance_ = 0;
  last_bend_.reset();
  rig_change_.reset();
  tests_.reset();
  pairs_failed_ = pairs_passed_ = 0;
  if (filter_.initialised()) loseTrack();
  memory_.reset();
  speed_.reset();
  velocity_.reset();
  window_ = 0;
  stamps_.reset();
  clock_ = ClockWatch();
  recovery_.reset();
  doubt_.reset();
  motion_doubt_.reset();
  vanishing_.reset();
  heading_.reset();
  headings_held_ = 0;
  ground_.reset();
  ground_stamp_.reset();
  ground_height_ = kUnknown;
  last_normal_.reset();
  last_stamp_.reset();
  lost_ = false;
}

VanishingMemory::Direction KalmanHeightStage::runwayDirection(bool repeated, const Eigen::Vector3d& n,
                                                              const ApproachAngleResult& approach) {
  constexpr int kMostHeld = 2;
  const VanishingMemory::Direction seen{approach.vanishing_direction, approach.vanishing_covariance};
  if (!repeated) {  // else it is as it was
    const Eigen::Vector3d across = n.cross(seen.direction).normalized();
    headings_held_ =
        heading_.leaps(approach.stamp, seen, across, turnSince(approach)) ? headings_held_ + 1 : 0;
    if (headings_held_ > kMostHeld) {
      heading_.reset();
      headings_held_ = 0;
    }
  }
  return headings_held_ > 0 ? *heading_.remembered() : seen;
}

void KalmanHeightStage::reportPlane(const Reconstruction& reconstruction, const ApproachAngleResult& approach,
                                    bool repeated, LandingResult& result) {
  const GroundNormal normal =
      reconstruction.plane.valid() ? reconstruction.normal : GroundNormal{approach.n, approach.n_covariance};
  const VanishingMemory::Direction runway = runwayDirection(repeated, normal.n, approach);
  reportAttitude(normal.n, normal.covariance, runway.direction, runway.covariance, result);
}

Failure KalmanHeightStage::followTime(double stamp) {
  const std::optional<double> last = last_stamp_;
  const double T = last ? stamp - *last : 0;
  if (last && (T <= 0 || T > parameters_.reset_timeout)) {
    reset();
    last_stamp_ = stamp;
    return {Reason::kTimeJump, text("the stamp went ", T < 0 ? "back" : "ahead", " by ", std::abs(T), " s")};
  }
  last_stamp_ = stamp;
  if (filter_.initialised()) {
    filter_.predict(T);
    separation_.predict(T);
  }
  return {};
}

Failure KalmanHeightStage::followClock(const StereoDepthResult& stereo,
                                       const ApproachAngleResult::Motion& step,
                                       const Reconstruction& reconstruction) {
  if (stereo.left_repeated) return {};  // the next step has the time of both
  // By the pair's own height: the one expected is that of the wrong time.
  const std::optional<CameraStep> way =
      reconstruction.failure ? std::nullopt : cameraStep(step, reconstruction.height);
  if (!way) {
    clock_.skip();
    return {};
  }
  const std::optional<double> by_way = clock_.follow(*way);
  if (!by_way || !filter_.initialised()) return {};
  // A way can be wrong, a period of a pattern too long for example. The height has to say the same.
  constexpr double kTells = 2;  // sigma by which the height agrees better
  const double off = reconstruction.height - filter_.state()[0];
  const double off_by_way = off - filter_.state()[1] * (*by_way - step.duration);
  const double gate = parameters_.gate * parameters_.gate;
  const double sum = reconstruction.variance + filter_.covariance()(0, 0);
  if (off * off - off_by_way * off_by_way < kTells * kTells * reconstruction.variance) return {};
  if (off_by_way * off_by_way > gate * sum) return {};
  // The next step of the clock is to be noticed as well.
  const ClockWatch clock = clock_;
  reset();
  clock_ = clock;
  last_stamp_ = stereo.stamp;
  return {Reason::kTimeJump,
          text("the stamp went ahead by ", rounded(step.duration), " s, the camera moved as far as in ",
               rounded(*by_way), " s: the clock was set")};
}

void KalmanHeightStage::start(double stamp, const Reconstruction& reconstruction) {
  filter_.initialise(reconstruction.height, reconstruction.variance, commonVariance(reconstruction.height));
  if (parameters_.integrity_monitor) separation_.start(reconstruction.without, reconstruction.height);
  confirmations_ = 0;
  accept(stamp);
}

void KalmanHeightStage::accept(double stamp) {
  last_accepted_ = stamp;
  confirmations_ = std::min(confirmations_ + 1, kConfirmations);
  consecutive_rejections_ = 0;
  lost_ = false;
}

void KalmanHeightStage::loseTrack() {
  ++resets_;
  filter_.reset();
  scatter_.reset();
  speed_scatter_.reset();
  separation_.reset();
  confirmations_ = 0;
  consecutive_rejections_ = 0;
  lost_ = true;
}

void KalmanHeightStage::filterHeight(double stamp, const Reconstruction& reconstruction,
                                     const ApproachAngleResult::Motion& step, LandingResult& result) {
  result.points_height = reconstruction.points_height;
  const bool measured = !reconstruction.failure;
  if (measured) {
    result.raw_height = reconstruction.height;
    result.raw_height_variance = reconstruction.variance;
    if (filter_.initialised()) {
      updateHeight(stamp, reconstruction, step, result);
    } else {
      start(stamp, reconstruction);
    }
  }
  const double age = stamp - last_accepted_;
  if (filter_.initialised() && age >= parameters_.reset_timeout) {
    loseTrack();
    if (measured) start(stamp, reconstruction);
  }

  const bool tracking = filter_.initialised() && stamp == last_accepted_;
  if (filter_.initialised()) {
    result.status = tracking ? Status::kTracking : Status::kCoasting;
  } else {
    result.status = lost_ ? Status::kLost : Status::kSearching;
  }
  result.consecutive_rejections = consecutive_rejections_;
  result.resets = resets_;
}

void KalmanHeightStage::updateHeight(double stamp, const Reconstruction& reconstruction,
                                     const ApproachAngleResult::Motion& step, LandingResult& result) {
  const HeightFilter::Update update =
      filter_.update(reconstruction.height, reconstruction.variance, commonVariance(reconstruction.height));
  result.innovation = update.innovation;
  result.innovation_variance = update.innovation_variance;
  scatter_.add(update.innovation * update.innovation / update.innovation_variance);
  tests_.addRatio(Consistency::kInnovation, update.innovation,
                  update.innovation * update.innovation / update.innovation_variance,
                  parameters_.gate * parameters_.gate);
  if (update.accepted) {
    accept(stamp);
    separation_.update(reconstruction.without);
    // Of a plane that is contradicted nobody knows which part of the motion was downwards.
    if (parameters_.use_motion && reconstruction.plane.valid() &&
        !tests_.failed(Consistency::kVanishingPoint) && !tests_.failed(Consistency::kMotionNormal))
      updateSpeed(reconstruction, step);
    return;
  }
  result.rejected = true;
  ++consecutive_rejections_;
  result.failure = {Reason::kRejected,
                    text("raw height ", rounded(reconstruction.height), " m, expected ",
                         rounded(reconstruction.height - update.innovation), " m with 1 sigma of ",
                         rounded(std::sqrt(update.innovation_variance)), " m")};
  if (confirmations_ < kConfirmations) {
    // Two measurements that contradict each other, and nothing yet that says which one is wrong.
    loseTrack();
    start(stamp, reconstruction);
  }
}

double KalmanHeightStage::heightSoFar(const Reconstruction& reconstruction) const {
  return filter_.initialised() ? filter_.state()[0] : reconstruction.height;
}

// Whether the motion is certain enough for an angle does not matter here: that of a picture that stands still
// is not.
std::optional<CameraStep> KalmanHeightStage::cameraStep(const ApproachAngleResult::Motion& step,
                                                        double height) {
  const Eigen::Vector3d& t = step.translation_over_height;
  const Eigen::Matrix3d covariance = step.covariance.bottomRightCorner<3, 3>();
  if (!t.allFinite() || !covariance.allFinite() || !(step.duration > 0) || !(height > 0)) return std::nullopt;
  // Of any direction: the length of a vector that is nothing but noise has none.
  return CameraStep{step.duration, t.norm() * height, height * height * covariance.trace()};
}

void KalmanHeightStage::followStamps(const ApproachAngleResult::Motion& step,
                                     Reconstruction& reconstruction) {
  const std::optional<CameraStep> way = cameraStep(step, heightSoFar(reconstruction));
  way ? stamps_.follow(*way) : stamps_.skip();
  if (!filter_.initialised() || !(step.duration > 0)) return;
  // A duration has the errors of two stamps in it.
  const double stamp_variance = 0.5 * stamps_.ofDuration() * step.duration * step.duration;
  reconstruction.variance += std::pow(filter_.state()[1], 2) * stamp_variance;
}

VerticalSpeed KalmanHeightStage::withStamps(VerticalSpeed speed) const {
  speed.variance += speed.speed * speed.speed * stamps_.ofDuration();
  return speed;
}

void KalmanHeightStage::updateSpeed(const Reconstruction& reconstruction,
                                    const ApproachAngleResult::Motion& step) {
  const VerticalSpeed claimed = withStamps(verticalSpeed(
      step, reconstruction.below, reconstruction.height - reconstruction.bend, reconstruction.variance,
      parameters_.height_model_error, parameters_.acceleration_stddev));
  const double variance = claimed.variance * (parameters_.integrity_monitor ? speed_scatter_.factor() : 1);
  const HeightFilter::Update update = filter_.updateSpeed(claimed.speed, variance);
  speed_scatter_.add(update.innovation * update.innovation /
                     (update.innovation_variance - variance + claimed.variance));
  if (update.accepted) separation_.updateSpeed(claimed.speed, variance);
}

void KalmanHeightStage::reportHeight(LandingResult& result) const {
  if (!filter_.initialised()) return;
  const double h = filter_.state()[0];
  result.height = h;
  result.height_variance =
      varianceFactor() * filter_.ownCovariance()(0, 0) + filter_.commonVariance().total();
  result.vertical_speed = filter_.state()[1];
  // Motions are given as much as they scatter themselves; where heights alone tell the speed it scatters as
  // they do.
  result.vertical_speed_variance =
      filter_.covariance()(1, 1) * (parameters_.use_motion ? 1 : varianceFactor());

  const double age = result.stamp - last_accepted_;
  Failure failure;
  if (confirmations_ < kConfirmations) {
    failure = {Reason::kNotYet, text(confirmations_, " of ", kConfirmations, " agreeing heights")};
  } else if (!(age <= parameters_.max_age)) {
    failure = {Reason::kTimeout, text("no believable height for ", age, " s")};
  } else {
    failure = tooUncertain(h, result.height_variance, parameters_);
  }
  result.height_valid = !failure;
  if (!result.failure) result.failure = failure;
}

}  // namespace uav_landing
