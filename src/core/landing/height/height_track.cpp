#include "landing/height/height_track.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "height/height_limit.h"

namespace uav_landing {

void TrackVerdict::addTo(PairTests& tests) const {
  if (std::isfinite(gate_variance))
    tests.addRatio(IntegrityTest::kInnovation, innovation, innovation * innovation / gate_variance);
}

HeightTrack::HeightTrack(const KalmanHeightParameters& parameters, int resets)
    : parameters_(parameters),
      filter_(parameters.acceleration_stddev, parameters.initial_speed_stddev, parameters.gate),
      separation_(parameters),
      scatter_(parameters.gate * parameters.gate),
      speed_scatter_(parameters.gate * parameters.gate),
      resets_(resets) {}

HeightPrior HeightTrack::predict(double T) {
  if (known()) {
    filter_.predict(T);
    separation_.predict(T);
  }
  return {filter_, confirmations_};
}

TrackVerdict HeightTrack::update(double stamp, const MeasuredHeight& measured, bool left_out,
                                 const VerticalSpeed& speed) {
  TrackVerdict verdict(filter_);
  if (left_out) ++rejections_;
  const bool is_measured = !measured.failure && !left_out;
  if (is_measured) known() ? follow(stamp, measured, speed, verdict) : start(stamp, measured);
  if (known() && stamp - last_accepted_ >= parameters_.reset_timeout) {
    lose();
    if (is_measured) start(stamp, measured);
  }
  judge(stamp, verdict);
  return verdict;
}

void HeightTrack::start(double stamp, const MeasuredHeight& measured) {
  filter_.initialise(measured.height, measured.variance, measured.common());
  if (parameters_.integrity_monitor) separation_.start(measured.without, measured.height);
  confirmations_ = 0;
  accept(stamp);
}

void HeightTrack::follow(double stamp, const MeasuredHeight& measured, const VerticalSpeed& speed,
                         TrackVerdict& verdict) {
  const HeightFilter::Update update = filter_.update(measured.height, measured.variance, measured.common());
  verdict.innovation = update.innovation;
  verdict.innovation_variance = update.innovation_variance;
  verdict.gate_variance = update.gate_variance;
  scatter_.add(update.innovation * update.innovation / update.innovation_variance);
  if (update.accepted) {
    accept(stamp);
    separation_.update(measured.without);
    followSpeed(speed);
    return;
  }
  ++rejections_;
  verdict.rejection = {Reason::kRejected,
                       text("raw height ", rounded(measured.height), " m, expected ",
                            rounded(measured.height - update.innovation), " m with 1 sigma of ",
                            rounded(std::sqrt(update.gate_variance)), " m")};
  if (confirmations_ < kConfirmations) {
    // Two measurements contradict each other, and nothing says which one is wrong. So the track starts again.
    lose();
    start(stamp, measured);
  }
}

void HeightTrack::followSpeed(const VerticalSpeed& claimed) {
  const double variance = claimed.variance * (parameters_.integrity_monitor ? speed_scatter_.factor() : 1);
  const HeightFilter::Update update = filter_.updateSpeed(claimed.speed, variance);
  speed_scatter_.add(update.innovation * update.innovation /
                     (update.innovation_variance - variance + claimed.variance));
  if (update.accepted) separation_.updateSpeed(claimed.speed, variance);
}

void HeightTrack::accept(double stamp) {
  last_accepted_ = stamp;
  confirmations_ = std::min(confirmations_ + 1, kConfirmations);
  rejections_ = 0;
  lost_ = false;
}

void HeightTrack::lose() {
  if (!known()) return;
  ++resets_;
  filter_.reset();
  scatter_.reset();
  speed_scatter_.reset();
  separation_.reset();
  confirmations_ = 0;
  rejections_ = 0;
  lost_ = true;
}

Status HeightTrack::status() const {
  return known() ? Status::kCoasting : lost_ ? Status::kLost : Status::kSearching;
}

void HeightTrack::judge(double stamp, TrackVerdict& verdict) const {
  const double age = stamp - last_accepted_;
  verdict.filter = filter_;
  verdict.status = known() && age == 0 ? Status::kTracking : status();
  verdict.confirmed = confirmations_ >= kConfirmations;
  verdict.outdated = rejections_ > 0 && age > parameters_.max_age;
  verdict.consecutive_rejections = rejections_;
  if (!known()) return;
  const double h = filter_.state()[0];
  verdict.height = h;
  verdict.height_variance =
      varianceFactor() * filter_.ownCovariance()(0, 0) + filter_.commonVariance().withBaseline();
  verdict.vertical_speed = filter_.state()[1];
  // Speeds from the motion already entered the filter with their own scatter. When the heights alone give the
  // speed, it scatters as they do.
  verdict.vertical_speed_variance =
      filter_.covariance()(1, 1) * (parameters_.use_motion ? 1 : varianceFactor());
  if (!verdict.confirmed) {
    verdict.failure = {Reason::kNotYet,
                       text("agreeing heights so far: ", confirmations_, " of ", kConfirmations, " needed")};
  } else if (!(age <= parameters_.max_age)) {
    verdict.failure = {Reason::kTimeout, text("no accepted height for ", age, " s")};
  } else {
    verdict.failure = tooUncertain(h, verdict.height_variance, parameters_);
  }
  verdict.height_valid = !verdict.failure;
}

SolutionSeparation::Level HeightTrack::protectionLevel(
    double height, double height_variance, const std::optional<GroundMemory::Below>& below) const {
  const SolutionSeparation::Level level =
      separation_.protectionLevel(height, height_variance, varianceFactor());
  if (!below) return level;
  return separation_.larger(level, height, below->height, below->variance + filter_.commonVariance().baseline,
                            "surface_below");
}

// Ratio of the filter's real variance to the one that follows from the pairs' claims.
double HeightTrack::varianceFactor() const { return parameters_.integrity_monitor ? scatter_.factor() : 1; }

}  // namespace uav_landing
