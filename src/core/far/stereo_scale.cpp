#include "far/stereo_scale.h"

#include <cmath>

#include "estimation/limits.h"

namespace uav_landing {
namespace {

constexpr double kMemory = 1.5;  // s
constexpr Sigmas kGate(4);       // farther off, another edge is followed

}  // namespace

SurfaceDisparity StereoScale::follow(double T, const SurfaceDisparity& seen, double width) {
  const Ratio now{seen.value / width, seen.variance / (width * width), 1 / width};
  if (mean_) mean_->variance *= std::exp(T / kMemory);
  if (!mean_ || !kGate.admits(now.value - mean_->value, now.variance + mean_->variance)) {
    mean_ = now;
  } else {
    const double gain = mean_->variance / (mean_->variance + now.variance);
    mean_->value += gain * (now.value - mean_->value);
    mean_->by_bias += gain * (now.by_bias - mean_->by_bias);
    mean_->variance *= 1 - gain;
  }
  return {seen.pixel, mean_->value * width, mean_->variance * width * width,
          mean_->by_bias * width * seen.bias_stddev};
}

}  // namespace uav_landing
