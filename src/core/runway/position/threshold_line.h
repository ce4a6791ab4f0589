#pragma once

#include <optional>

#include "runway/position/threshold_bars.h"

namespace uav_landing {

/// The near edge of the line before the bars.
struct ThresholdLine {
  double spanning = 0;  ///< largest share of the width on which there is something like it
  double station = 0;   ///< unset when that is less than the whole, see spans()

  bool spans() const;
  /// Whether there is something, be it not the line.
  bool isSomething() const;
};

/// Looks from the station `first` to where the bars begin.
ThresholdLine findThresholdLine(const TopView& view, const ThresholdBars& bars, int first);

/// Station at which the pavement of the bars begins: a step of the brightness, either way, right across.
/// Where it falls by as much as behind a line, the ground before may be almost as bright as a line that is
/// there: its near edge is told, or nothing. pitch: from bar to bar, in heights.
std::optional<double> findPavement(const TopView& view, const ThresholdBars& bars, double pitch, int first);

}  // namespace uav_landing
