#pragma once

#include <cmath>
#include <optional>

#include "height/height_filter.h"

namespace uav_landing {

/// The height of half a second ago and longer, carried on by the motion alone. The change of the published
/// height is tested against it. It survives a loss of track, so a different height afterwards is noticed.
class HeightMemory {
 public:
  /// Age from which a remembered height is compared, s.
  static constexpr double kAge = 0.5;
  /// 1 sigma of the direction of "down" that the motion refers to, rad. The error lasts for a whole memory.
  static constexpr double kDirectionError = 0.15 * M_PI / 180;

  /// Carries the memories on over T, s. speed, speed_variance: vertical speed by the motion, or NaN.
  /// velocity: of the camera, m/s; it is what an error of the direction acts on.
  void carry(double T, double speed, double speed_variance, double velocity);

  struct Expected {
    double height = 0, variance = 0;  ///< m, m^2
  };
  /// The height expected now. There is none before one was remembered for long enough.
  std::optional<Expected> expected() const;

  /// Call it after each comparison. filter: the one with all sources. A height that does not agree is not
  /// remembered. The old one stays until its standard deviation is larger than useful (m).
  void refresh(const HeightFilter& filter, bool agrees, double useful);

 private:
  struct Memory {
    HeightFilter filter;
    double age = 0;       // s
    double distance = 0;  // distance flown since, m
    double variance() const;
  };
  std::optional<Memory> young_, old_;
};

}  // namespace uav_landing
