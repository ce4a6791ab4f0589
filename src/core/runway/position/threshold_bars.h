#pragma once

#include <optional>

#include "runway/position/runway_top_view.h"

namespace uav_landing {

/// The bars side by side behind a runway's threshold.
struct ThresholdBars {
  double contrast = 0;        ///< grey levels between the bars and what lies between them
  double begin = 0, end = 0;  ///< stations
  double pitch = 0;           ///< from bar to bar, columns
};

/// Bars evenly over the runway's width, the same at both of their ends and on both sides of the centre line,
/// unlike the marks of the touchdown zone. Nothing when where they begin is not in the picture.
std::optional<ThresholdBars> findThresholdBars(const TopView& view);

}  // namespace uav_landing
