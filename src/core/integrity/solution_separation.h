#pragma once

#include <array>
#include <optional>

#include "height/height_filter.h"
#include "image/input/image_region.h"
#include "uav_landing/parameters/kalman_height_parameters.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// What may be wrong without anything showing it, one at a time: the runway's vanishing point (and its known
/// width); the matches in one part of the image; the motion (the vertical speed, and the ground's normal, by
/// it).
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
/// Beside the height filter with everything in it, one filter more for each source, which leaves that source
/// out. Was the source i wrong, then the filter i was not, so that the published height h is within
///   |h - h_i| + k sigma_i
/// of the truth but with the probability that belongs to k: integrity_risk, less what the prior probability
/// of the fault takes of it. The separation is the one observed and not the threshold of a detector: it
/// bounds faults too small to be detected and those detected alike. The level is the largest over all
/// sources, and of what no source here can tell: a scale common to all heights, whose size is a bound by
/// assumption.
class SolutionSeparation {
 public:
  explicit SolutionSeparation(const KalmanHeightParameters& parameters);

  struct Measurement {
    double height = kUnknown, variance = kUnknown;  ///< m, m^2, of one pair
    CommonVariance common;                          ///< part of the variance
    bool known() const { return height > 0 && variance > 0; }
  };
  /// Of one pair: what it measures with each source left out; not known() where nothing is left.
  using Measurements = std::array<Measurement, kFaultySources>;

  // In step with the height filter: the same calls at the same time.
  void start(const Measurements& without, double height);
  void predict(double T);
  void update(const Measurements& without);
  void updateSpeed(double speed, double variance);
  void reset();

  struct Level {
    double bound = kUnknown;  ///< m
    const char* source = "";  ///< what it is because of
  };
  /// height, variance: published, m, m^2. factor: by which the variances of all pairs are larger than
  /// claimed.
  Level protectionLevel(double height, double variance, double factor = 1) const;
  /// The level, or that because of one more solution for the height (m, m^2), whichever is larger.
  Level larger(const Level& level, double height, double solution, double variance, const char* source) const;

 private:
  double factor_, fault_factor_;  // k without and with a fault
  double unwatched_scale_;        // of height
  double acceleration_stddev_, initial_speed_stddev_;
  std::array<std::optional<HeightFilter>, kFaultySources> solutions_;
};

}  // namespace uav_landing
