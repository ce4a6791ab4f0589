#pragma once

#include <optional>

#include "runway/threshold/runway_top_view.h"

namespace uav_landing {

/// The bars that lie side by side behind a runway's threshold.
struct ThresholdBars {
  double contrast = 0;        ///< grey levels between the bars and the gaps
  double begin = 0, end = 0;  ///< stations where they begin and end
  double pitch = 0;           ///< distance from bar to bar, columns
};

/// Finds bars that lie evenly over the runway's width. They must look the same at both of their ends and on
/// both sides of the centre line, unlike marks of the touchdown zone. Nothing when their beginning is not in
/// the image.
std::optional<ThresholdBars> findThresholdBars(const TopView& view);

}  // namespace uav_landing
