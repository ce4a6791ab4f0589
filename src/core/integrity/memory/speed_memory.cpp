#include "integrity/memory/speed_memory.h"

#include <algorithm>

namespace uav_landing {
namespace {

constexpr double kShare = 0.3;      // of the expected distance that is enough
constexpr double kPatience = 30.0;  // s
constexpr int kSteps = 3;           // largest number of steps that are remembered, and that are asked for

}  // namespace

std::optional<SpeedMemory::Speed> SpeedMemory::least(double duration) const {
  if (last_.size() < kSteps) return std::nullopt;
  Speed slowest = *std::min_element(last_.begin(), last_.end(),
                                    [](const Speed& a, const Speed& b) { return a.mean < b.mean; });
  slowest.mean -= max_deceleration_ * (since_ + duration);
  if (!(slowest.mean > 0)) return std::nullopt;
  return slowest;
}

std::optional<SpeedMemory::Shortfall> SpeedMemory::compare(const CameraStep& step) const {
  const std::optional<Speed> least = this->least(step.duration);
  if (!least) return std::nullopt;
  const double share = kShare * step.duration;
  return Shortfall{share * least->mean - step.way, step.variance + share * share * least->variance};
}

void SpeedMemory::learn(const CameraStep& step, bool agrees) {
  if (!agrees) still_ = std::min(still_ + 1, kSteps);
  if (still_ > 0) {
    const std::optional<Shortfall> shortfall = compare(step);
    const bool moved = agrees && shortfall && shortfall->difference <= 0;
    moved_ = moved ? moved_ + 1 : 0;
    contradicted_ += step.duration;
    if (contradicted_ > kPatience) return reset();
    if (moved_ < still_) return;
  }
  Speed speed{step.way / step.duration, step.variance / (step.duration * step.duration)};
  const std::optional<Speed> least = this->least(step.duration);
  if (least && speed.mean < least->mean) speed = *least;
  contradicted_ = since_ = 0;
  still_ = moved_ = 0;
  last_.push_back(speed);
  if (last_.size() > kSteps) last_.pop_front();
}

}  // namespace uav_landing
