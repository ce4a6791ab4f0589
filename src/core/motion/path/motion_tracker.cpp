#include "motion/path/motion_tracker.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/rare_pairs.h"
#include "base/text.h"
#include "base/thinned.h"
#include "geometry/rotation.h"
#include "image/input/image_check.h"
#include "image/windows/corners.h"
#include "motion/step/plane_proof.h"
#include "results/any_angle.h"

namespace uav_landing {
namespace {

// Largest number of images kept, however close their stamps are: 0.5 s at 100 Hz.
constexpr size_t kMostFrames = 50;

// Number of images allocated at the start: 0.5 s at 20 Hz. Later it would take longer to get the memory from
// the system than to fill it.
constexpr size_t kUsualFrames = 12;

// Largest share of the height that a step is predicted to sink.
constexpr double kMostSunk = 0.5;

// Tolerance of stamps for a frame to count as within the window, s.
constexpr double kWindowSlack = 0.05;

// Rotation from the inertial sensor, if it covers exactly this step.
std::optional<RotationPrior> rotationOf(const AttitudePrior& imu, double duration) {
  constexpr double kStampRounding = 1e-3;
  if (!imu.hasRotation() || std::abs(imu.duration - duration) > kStampRounding) return std::nullopt;
  return RotationPrior{rotationMatrix(imu.rotation), imu.rotation_covariance};
}

// Least 1 sigma of the rate of the angle while no new image shows it, rad/s.
constexpr double kLeastRate = 1 * M_PI / 180;

}  // namespace

MotionTracker::MotionTracker(const RigModel& model, const ApproachAngleParameters& parameters)
    : rig_(model.rig),
      times_(model.left_times),
      unit_times_(model.left_unit_times),
      mask_(erodeMask(model.left_mask, parameters.window_radius + 2)),
      parameters_(parameters),
      search_(rig_, mask_, parameters),
      rates_(parameters.imu_rate_bias_deg * M_PI / 180),
      filter_(parameters.angle_window) {
  reset();
  spare_.resize(kUsualFrames);
  for (MatchImage& image : spare_) image.fine = cv::Mat::zeros(rig_.size, CV_32FC1);
}

MotionTracker::Result MotionTracker::repeat(double stamp) const {
  Result result;
  result.step.failure = {Reason::kNoMotion, "the image is the one of the pair before"};
  result.window = last_window_;
  if (last_window_.failure) return result;
  const double age = stamp - past_.back().stamp;
  if (age > 0 && age <= parameters_.angle_window) {
    result.window.angle_variance += std::pow(std::max(last_rate_stddev_, kLeastRate) * age, 2);
  } else {
    result.window = {};
    result.window.failure = {Reason::kNoMotion, text("the image is the one of ", age, " s ago")};
  }
  return result;
}

void MotionTracker::reset() {
  for (Frame& frame : past_) spare_.push_back(std::move(frame.image));
  past_.clear();
  last_step_.reset();
  search_.reset();
  forgetRows();
  last_rate_stddev_ = 0;
  rates_ = RowRates(parameters_.imu_rate_bias_deg * M_PI / 180);
  last_window_ = {};
  last_window_.failure = {Reason::kNotYet, "no earlier frame"};
}

void MotionTracker::forgetRows() {
  shake_ = {};
  filter_.reset();
}

ReadoutDoubt MotionTracker::doubtOf(const StepConditions& conditions) const {
  if (!conditions.readout.known()) return {};
  return {&unit_times_, conditions.readout.time};
}

bool MotionTracker::rolls(const ReadoutEstimate& readout) const {
  return mayRoll() && (readout.given() || readout.known());
}

ShakeWatch MotionTracker::watchOf(ShakeMemory& memory, const ReadoutEstimate& readout) const {
  if (!mayRoll()) return {};
  return {times_.atOnce() ? &unit_times_ : &times_, &memory, rolls(readout)};
}

RowDoubt MotionTracker::rowDoubt(double duration, ShakeMemory& memory, const GroundInView& seen,
                                 const ReadoutEstimate& readout) const {
  const double estimated = readout.known() ? readout.time : 0;
  RowDoubt doubt = rates_.doubt(duration, times_.atOnce() ? estimated : times_.readoutTime());
  doubt.shake = watchOf(memory, readout);
  if (readout.known()) doubt.normal_by_readout = seen.normal_by_readout;
  return doubt;
}

MotionFacts MotionTracker::factsOf(double duration, const std::vector<TemporalMatch>& matches,
                                   const ReadoutEstimate& readout) const {
  return {duration, matches.size(), readout, mayRoll(), rolls(readout), parameters_.min_motion};
}

MotionTracker::Frame MotionTracker::takeFrame(double stamp, const cv::Mat& left) {
  if (!past_.empty() && !(stamp > past_.back().stamp)) reset();
  Frame frame;
  frame.stamp = stamp;
  if (!spare_.empty()) {
    frame.image = std::move(spare_.back());
    spare_.pop_back();
  }
  if (frame.image.coarse.empty()) frame.image.coarse = std::move(spare_coarse_);
  frame.image.assign(left);
  return frame;
}

std::optional<RowMotion> MotionTracker::lastMotion(double stamp, const AttitudePrior& imu) const {
  if (past_.empty() || !(std::abs(stamp - past_.back().stamp) <= kRarePairs)) return std::nullopt;
  const std::optional<RowMotion>& motion = past_.back().motion;
  if (!motion) return std::nullopt;
  return rates_.expected(*motion, stamp - past_.back().stamp, imu);
}

Vibration MotionTracker::vibration(double stamp) const {
  constexpr double kRemembered = 1;  // s, as long as the likelihoods
  return std::abs(stamp - shake_.stamp) < kRemembered ? shake_.found : Vibration();
}

void MotionTracker::skip(double stamp, const cv::Mat& left, const AttitudePrior& imu) {
  Result nothing;
  nothing.window.failure = {Reason::kNotYet, "no frame step from the previous pair"};
  search_.interrupt();
  Frame frame = takeFrame(stamp, left);
  rates_.see(imu);
  advance(std::move(frame), nothing);
}

MotionTracker::Result MotionTracker::process(double stamp, const cv::Mat& left, const GroundInView& seen,
                                             Timings& timings, const StepConditions& conditions) {
  Result result;
  step_matches_.clear();
  memory_.matching.textures.clear();
  const std::vector<TrackedCorner> corners = thinned(
      seen.corners,
      static_cast<size_t>(cornerBudget(rig_.size, parameters_.corner_count, parameters_.pixels_per_corner)));
  const GroundInView followed{seen.normal, seen.normal_by_readout, corners};
  Frame now;
  {
    ScopedTimer timer(timings, "match_images_motion");
    now = takeFrame(stamp, left);
  }
  rates_.see(conditions.imu);
  shake_.step.begin();
  if (past_.empty()) {
    result.step.failure = {Reason::kNotYet, "no earlier frame"};
  } else {
    ScopedTimer timer(timings, "feature_matching_motion");
    estimateStep(now, followed, conditions, result);
  }
  ScopedTimer timer(timings, "window_motion");
  estimateWindow(now, followed, conditions, result);
  smoothAngle(stamp, result);
  advance(std::move(now), result);
  return result;
}

void MotionTracker::estimateStep(const Frame& now, const GroundInView& seen, const StepConditions& conditions,
                                 Result& result) {
  const double duration = now.stamp - past_.back().stamp;
  const std::optional<RotationPrior> known = rotationOf(conditions.imu, duration);
  const RotationPrior* rotation = known ? &*known : nullptr;
  const bool regular = last_step_ && duration < Steadiness::kLongestRegular * last_duration_;
  const StepImages step{now.image,
                        past_.back().image,
                        duration,
                        seen.corners,
                        memory_,
                        rates_,
                        seen.normal,
                        rotation,
                        regular,
                        conditions.time,
                        &times_,
                        doubtOf(conditions),
                        rowDoubt(duration, shake_.step, seen, conditions.readout)};
  Expected<MotionEstimate> estimate = search_.find(step, predictions(duration, rotation), step_matches_);
  if (estimate) {
    last_duration_ = duration;
    last_sink_ = estimate->normal.dot(estimate->motion.t);
    const Failure failure = conditions.proof == GroundProof::kMotion
                                ? doubtOfPlane(now.image.fine, seen.corners, step_matches_, *estimate)
                                : Failure();
    if (failure) {
      result.unproven = estimate->motion;
      estimate = tl::make_unexpected(failure);
    }
  }
  const MotionDescription described =
      describe(estimate, factsOf(duration, step_matches_, conditions.readout));
  result.step = described.motion;
  result.step_angle = described.angle;
  if (!estimate) return;
  result.ends = rates_.ends(estimate->motion, duration, 1 + estimate->normal.dot(estimate->motion.t));
  // Vibration disturbs the turns of steps, but not the sensor.
  if (const std::optional<Eigen::Vector3d> measured = rates_.measuredNow())
    result.step.turn_rate = *measured;
  else if (mayRoll() && !estimate->vibration.found())
    result.step.turn_rate = result.ends.now.w;
  shake_.found = estimate->vibration;
  shake_.stamp = now.stamp;
  result.step_estimate = *estimate;
  result.readout = estimate->readout;
  claimReadout(conditions.readout, *result.step_estimate);
}

// The camera is predicted to move as before. If its rotation is known, a prediction with that comes first.
std::vector<CameraMotion> MotionTracker::predictions(double duration, const RotationPrior* rotation) const {
  std::vector<CameraMotion> predictions;
  if (!last_step_) return predictions;
  // The same distance is more heights when the height is lower, so sinking lengthens the step. A prediction
  // without this would bias every step over ground with little but lines. Lines are found near the place
  // where they are looked for.
  const double sunk = std::min(last_sink_ * duration / last_duration_, kMostSunk);
  const double times = duration / last_duration_;
  CameraMotion predicted = carriedOn(*last_step_, times);
  predicted.t = last_step_->t * (times / (1 - sunk));
  if (rotation != nullptr) predictions.push_back({rotation->R, predicted.t});
  predictions.push_back(predicted);
  return predictions;
}

void MotionTracker::estimateWindow(const Frame& now, const GroundInView& seen,
                                   const StepConditions& conditions, Result& result) {
  constexpr double kStampRounding = 1e-3;
  if (!result.step_estimate) {
    result.window.failure = result.step.failure;
    return;
  }
  if (parameters_.angle_window <= 0) {
    result.window = result.step;
    return;
  }
  for (const Frame& then : past_) {
    const double duration = now.stamp - then.stamp;
    if (duration > parameters_.angle_window + kStampRounding) continue;
    if (&then == &past_.back()) break;
    if (!then.since) continue;
    const CameraMotion& step = result.step_estimate->motion;
    // Lengths are converted from units of the previous height to units of the height now.
    const double unit = 1 + seen.normal.vector().dot(step.t);
    const CameraMotion predicted{step.R * then.since->R, step.R * then.since->t * unit + step.t};
    const RowMotion& motion = result.ends.now;
    const RowMotion motion_then = then.motion.value_or(motion);
    // As at the ends of a step, see RowRates::ends().
    if ((motion_then.beyond.rows == nullptr) != (motion.beyond.rows == nullptr)) continue;
    memory_.matching.spare = std::move(window_matches_);
    window_matches_ = matchOverTime({rig_, now.image, then.image, mask_}, seen.corners,
                                    {predicted, seen.normal.vector(), {&times_, motion, motion_then}},
                                    {parameters_.window_radius, parameters_.min_zncc, 0}, memory_.matching);
    const ReadoutDoubt doubt = doubtOf(conditions);
    shiftByReadout(rig_, {predicted, seen.normal.vector(), {doubt.times, motion, motion_then}}, doubt.time,
                   window_matches_);
    // One image that is bad must not count in each pair that it is compared with.
    const ShakeMemory kept = shake_.window;
    if (then.stamp != shake_.window_then) shake_.window.begin();
    RowDoubt rows = rowDoubt(result.step.duration, shake_.window, seen, conditions.readout);
    rows.delay.then = motion_then.beyond;
    const MotionPrior prior{predicted, seen.normal, nullptr, rows};
    const Expected<MotionEstimate> estimate =
        estimateMotion(rig_, window_matches_, prior, parameters_.min_matches, memory_.motion);
    if (!estimate) {
      shake_.window = kept;
      continue;
    }
    shake_.window_then = then.stamp;
    const MotionDescription described =
        describe(estimate, factsOf(duration, window_matches_, conditions.readout));
    result.window = described.motion;
    result.window_angle = described.angle;
    if (estimate->vibration.stddev > shake_.found.stddev) shake_.found = estimate->vibration;
    return;
  }
  result.window = result.step;
}

// The chord's angle is half of its duration old. The published angle is the current one.
void MotionTracker::smoothAngle(double stamp, Result& result) {
  if (parameters_.angle_smoothing == AngleSmoothing::kChord || parameters_.angle_window <= 0) return;
  if (!result.step_angle || !std::isfinite(result.step.angle_variance)) {
    filter_.reset();
    return;
  }
  const PathAngleFilter::Measurement& step = *result.step_angle;
  const PathAngleFilter::Estimate estimate = filter_.update(stamp, step, result.window_angle.value_or(step));
  last_rate_stddev_ = estimate.rate_stddev;
  if (result.window.failure) result.window = result.step;
  result.window.angle = estimate.angle;
  result.window.angle_variance = estimate.variance;
  if (step.shaken || (result.window_angle && result.window_angle->shaken))
    result.window.angle_variance = kAnyAngle * kAnyAngle;
}

void MotionTracker::advance(Frame&& now, const Result& result) {
  for (Frame& frame : past_) {
    const bool previous = &frame == &past_.back();
    if (!result.step_estimate || !(previous || frame.since)) {
      frame.since.reset();
      continue;
    }
    const CameraMotion& step = result.step_estimate->motion;
    if (previous) {
      frame.since = step;
    } else {
      const double unit = 1 + result.step_estimate->normal.dot(step.t);
      frame.since = CameraMotion{step.R * frame.since->R, step.R * frame.since->t * unit + step.t};
    }
  }
  now.motion.reset();
  if (result.step_estimate) {
    past_.back().motion = result.ends.then;
    now.motion = result.ends.now;
    rates_.add(result.step_estimate->motion, result.step.duration, result.step_estimate->delay);
  } else {
    rates_.skip();
  }
  last_window_ = result.window;
  last_step_ = result.unproven;
  if (result.step_estimate) last_step_ = result.step_estimate->motion;
  // Only the previous frame is searched widely, so older ones do not need the coarse level.
  if (!past_.empty() && past_.back().image.factor > 1) spare_coarse_ = std::move(past_.back().image.coarse);
  past_.push_back(std::move(now));
  const double oldest = past_.back().stamp - parameters_.angle_window - kWindowSlack;
  while (past_.size() > 2 && (past_.front().stamp < oldest || past_.size() > kMostFrames)) {
    spare_.push_back(std::move(past_.front().image));
    past_.pop_front();
  }
}

}  // namespace uav_landing
