#include "integrity/memory/height_memory.h"

#include <cmath>

namespace uav_landing {

double HeightMemory::Memory::variance() const {
  return filter.covariance()(0, 0) + std::pow(kDirectionError * distance, 2);
}

void HeightMemory::carry(double T, double speed, double speed_variance, double velocity) {
  for (std::optional<Memory>* memory : {&young_, &old_}) {
    if (!*memory) continue;
    (*memory)->age += T;
    (*memory)->filter.predict(T);
    if (std::isfinite(velocity)) (*memory)->distance += velocity * T;
    if (std::isfinite(speed) && speed_variance > 0) (*memory)->filter.updateSpeed(speed, speed_variance);
  }
}

std::optional<HeightMemory::Expected> HeightMemory::expected() const {
  if (!old_) return std::nullopt;
  return Expected{old_->filter.state()[0], old_->variance()};
}

void HeightMemory::refresh(const HeightFilter& filter, bool agrees, double useful) {
  if (old_ && !(std::sqrt(old_->variance()) < useful)) old_.reset();
  if (old_ && !agrees) return;
  if (!old_ && !agrees) young_.reset();
  if (young_ && young_->age < kAge) return;
  if (young_) old_ = young_;
  young_.reset();
  if (filter.initialised()) young_.emplace(Memory{filter, 0, 0});
}

}  // namespace uav_landing
