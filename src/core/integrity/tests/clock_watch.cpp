#include "integrity/tests/clock_watch.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "estimation/robust.h"

namespace uav_landing {
namespace {

// Number of regular steps that must come before. The period and the speed are their medians.
constexpr size_t kSteps = 5;
// Share by which the distance of a regular step may differ from the one expected, because of gusts and
// brakes.
constexpr double kRegular = 0.15;
// Share by which a distance must differ to contradict the stamps. It is larger because distances come in
// units of the height, which is not exact either.
constexpr double kContradicts = 0.25;
// Largest number of frame periods that a distance may belong to: one, and those whose stamps were left out as
// late (StampOrder).
constexpr int kMostPeriods = 4;
// Largest deviation from a whole number of periods, in periods.
constexpr double kWhole = 0.25;
// Smaller differences of time, s, are jitter of stamps, which StampScatter follows. To start anew for each of
// them would do more harm.
constexpr double kLeastStep = 0.045;
// Largest 1 sigma of a distance over itself. A worse distance tells no time.
constexpr double kLargestRelative = 0.08;

}  // namespace

std::optional<double> ClockWatch::follow(const CameraStep& step) {
  const auto [duration, way, variance] = step;
  if (!(duration > 0 && way > 0 && variance >= 0) || std::sqrt(variance) > kLargestRelative * way) {
    skip();
    return std::nullopt;
  }
  const bool enough = regular_.size() == kSteps;
  double period = duration, speed = way / duration;
  if (!regular_.empty()) {
    std::vector<double> durations, speeds;
    for (const Step& before : regular_) {
      durations.push_back(before.duration);
      speeds.push_back(before.speed);
    }
    period = medianOf(durations);
    speed = medianOf(speeds);
  }
  const double by_way = way / speed;
  const double off = std::abs(by_way - duration);
  if (off <= kRegular * duration) {
    regular_.push_back({duration, way / duration});
    if (regular_.size() > kSteps) regular_.pop_front();
    return std::nullopt;
  }
  const double periods = std::round(by_way / period);
  const bool whole = periods >= 1 && periods <= kMostPeriods && std::abs(by_way / period - periods) <= kWhole;
  if (enough && whole && off > std::max(kLeastStep, kContradicts * duration)) return periods * period;
  regular_.assign(1, {duration, way / duration});
  return std::nullopt;
}

void ClockWatch::skip() { regular_.clear(); }

}  // namespace uav_landing
