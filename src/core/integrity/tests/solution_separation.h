#pragma once

#include <array>
#include <optional>

#include "height/height_filter.h"
#include "image/input/image_region.h"
#include "results/protection_factors.h"
#include "uav_landing/parameters/kalman_height_parameters.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Sources that may be wrong without anything showing it, one at a time. The vanishing point comes with the
/// known width of the runway. The regions are the matches in one part of the image. The motion gives the
/// vertical speed and a normal of the ground.
enum class FaultySource { kVanishingPoint, kNear, kMiddle, kFar, kLeft, kRight, kMotion };
constexpr int kFaultySources = 7;
/// For example "vanishing_point" or "far_region".
const char* toString(FaultySource source);
inline FaultySource faultySource(ImageRegion region) {
  return static_cast<FaultySource>(static_cast<int>(FaultySource::kNear) + static_cast<int>(region));
}

/// Receiver-autonomous integrity monitoring by solution separation (Brown, Chin: GPS fault detection and
/// exclusion using the correlation method / solution separation, ION 1998; Blanch et al.: Baseline advanced
/// RAIM user algorithm and possible improvements, IEEE TAES 51, 2015).
///
/// Beside the height filter with all sources there is one more filter for each source, which leaves that
/// source out. If source i is wrong, filter i is right. The published height h is then within
///   |h - h_i| + k sigma_i
/// of the truth, except with the probability that belongs to k: integrity_risk over the prior probability of
/// the fault. The separation is the observed one and not the threshold of a detector. So the bound holds for
/// faults that are detected and for those that are too small to be detected. The level is the largest bound
/// over all sources. It also covers a scale error common to all heights, which no source here can show; its
/// size is bounded by assumption.
class SolutionSeparation {
 public:
  explicit SolutionSeparation(const KalmanHeightParameters& parameters);

  struct Measurement {
    double height = kUnknown, variance = kUnknown;  ///< m, m^2, of one pair
    CommonVariance common;                          ///< part of the variance
    bool known() const { return height > 0 && variance > 0; }
  };
  /// Measurements of one pair with each source left out; not known() when nothing is left.
  using Measurements = std::array<Measurement, kFaultySources>;

  // These are called together with the same functions of the height filter.
  void start(const Measurements& without, double height);
  void predict(double T);
  void update(const Measurements& without);
  void updateSpeed(double speed, double variance);
  void reset();

  struct Level {
    double bound = kUnknown;  ///< m
    const char* source = "";  ///< source that gives the bound
  };
  /// Level of the published height (m) with its variance (m^2). factor: by which the variances of all pairs
  /// exceed their claims.
  Level protectionLevel(double height, double variance, double factor = 1) const;
  /// The larger one of a level and the bound by one more solution for the height (m, m^2).
  Level larger(const Level& level, double height, double solution, double variance, const char* source) const;

 private:
  ProtectionFactors factors_;
  double unwatched_scale_;  // of height
  double acceleration_stddev_, initial_speed_stddev_;
  std::array<std::optional<HeightFilter>, kFaultySources> solutions_;
};

}  // namespace uav_landing
