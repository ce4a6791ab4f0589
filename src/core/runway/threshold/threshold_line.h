#pragma once

#include <optional>

#include "runway/threshold/threshold_bars.h"

namespace uav_landing {

/// The bright line across the runway before the bars, by its near edge.
struct ThresholdLine {
  double spanning = 0;  ///< largest share of the width on which a line is seen
  double station = 0;   ///< of the near edge; only valid if spans()

  bool spans() const;
  /// Whether there is any mark, even if it is not the line.
  bool isSomething() const;
};

/// Searches from the station `first` to the beginning of the bars.
ThresholdLine findThresholdLine(const TopView& view, const ThresholdBars& bars, int first);

/// Station at which the pavement of the bars begins: a step of the brightness, up or down, across the whole
/// width. Nothing when there is none. A step down as large as behind a painted line may be the far edge of
/// such a line on bright ground. Then the near edge of that line is returned, or nothing if it is not clear.
/// pitch: distance from bar to bar, in heights.
std::optional<double> findPavement(const TopView& view, const ThresholdBars& bars, double pitch, int first);

}  // namespace uav_landing
