#pragma once

#include <cmath>
#include <optional>

#include "height/height_filter.h"

namespace uav_landing {

/// The height as it was half a second ago and longer, carried on by the motion alone: what the height's own
/// change is tested against. It survives a loss of track, so that another height afterwards shows.
class HeightMemory {
 public:
  /// Age from which a remembered height is compared, s.
  static constexpr double kAge = 0.5;
  /// 1 sigma by which the horizontal that the motion refers to is wrong for a whole memory, rad.
  static constexpr double kDirectionError = 0.15 * M_PI / 180;

  /// Carries on. speed, variance: vertical speed by motion, NaN when there is none. velocity: m/s, of the
  /// camera: what a wrong direction of the horizontal counts with.
  void carry(double T, double speed, double speed_variance, double velocity);

  struct Expected {
    double height = 0, variance = 0;  ///< m, m^2
  };
  /// The height expected now; none before there was one for long enough.
  std::optional<Expected> expected() const;

  /// After each comparison. filter: with everything in it. A height that does not agree is not remembered:
  /// the old one goes on until its 1 sigma is beyond useful (m).
  void refresh(const HeightFilter& filter, bool agrees, double useful);

 private:
  struct Memory {
    HeightFilter filter;
    double age = 0;       // s
    double distance = 0;  // flown since, m
    double variance() const;
  };
  std::optional<Memory> young_, old_;
};

}  // namespace uav_landing
