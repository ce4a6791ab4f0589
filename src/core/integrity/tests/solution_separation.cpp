#include "integrity/tests/solution_separation.h"

#include <cmath>

namespace uav_landing {
namespace {

// The gate of the filter with all sources decides for these filters, too.
constexpr double kNoGate = 1e6;

}  // namespace

const char* toString(FaultySource source) {
  switch (source) {
    case FaultySource::kVanishingPoint:
      return "vanishing_point";
    case FaultySource::kNear:
      return "near_region";
    case FaultySource::kMiddle:
      return "middle_region";
    case FaultySource::kFar:
      return "far_region";
    case FaultySource::kLeft:
      return "left_region";
    case FaultySource::kRight:
      return "right_region";
    case FaultySource::kMotion:
      return "motion";
  }
  return "";
}

SolutionSeparation::SolutionSeparation(const KalmanHeightParameters& parameters)
    : factors_(parameters),
      unwatched_scale_(parameters.unwatched_scale_error),
      acceleration_stddev_(parameters.acceleration_stddev),
      initial_speed_stddev_(parameters.initial_speed_stddev) {}

void SolutionSeparation::reset() { solutions_.fill(std::nullopt); }

void SolutionSeparation::start(const Measurements& without, double height) {
  for (int i = 0; i < kFaultySources; ++i) {
    HeightFilter filter(acceleration_stddev_, initial_speed_stddev_, kNoGate);
    const Measurement& first = without[i];
    // The height is not known without this source, so it may be anywhere.
    filter.initialise(first.known() ? first.height : height, first.known() ? first.variance : height * height,
                      first.known() ? first.common : CommonVariance());
    solutions_[i] = filter;
  }
}

void SolutionSeparation::predict(double T) {
  for (std::optional<HeightFilter>& solution : solutions_)
    if (solution) solution->predict(T);
}

void SolutionSeparation::update(const Measurements& without) {
  for (int i = 0; i < kFaultySources; ++i) {
    if (!solutions_[i] || !without[i].known()) continue;
    solutions_[i]->update(without[i].height, without[i].variance, without[i].common);
  }
}

void SolutionSeparation::updateSpeed(double speed, double variance) {
  for (int i = 0; i < kFaultySources; ++i)
    if (solutions_[i] && i != static_cast<int>(FaultySource::kMotion))
      solutions_[i]->updateSpeed(speed, variance);
}

SolutionSeparation::Level SolutionSeparation::protectionLevel(double height, double variance,
                                                              double factor) const {
  const double sigma = std::sqrt(variance);
  Level level{factors_.healthy * sigma, "noise"};
  const double scaled = unwatched_scale_ * height + factors_.faulty * sigma;
  if (!(scaled <= level.bound)) level = {scaled, "scale"};
  for (int i = 0; i < kFaultySources; ++i) {
    if (!solutions_[i]) continue;
    const HeightFilter& filter = *solutions_[i];
    level = larger(level, height, filter.state()[0],
                   factor * filter.ownCovariance()(0, 0) + filter.commonVariance().withBaseline(),
                   toString(static_cast<FaultySource>(i)));
  }
  return level;
}

SolutionSeparation::Level SolutionSeparation::larger(const Level& level, double height, double solution,
                                                     double variance, const char* source) const {
  const double bound = factors_.bound(height, solution, variance);
  return bound <= level.bound ? level : Level{bound, source};
}

}  // namespace uav_landing
