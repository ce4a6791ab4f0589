#pragma once

#include <array>

#include "kernels/image/line_view.h"
#include "kernels/lanes/order_statistic.h"

namespace uav_landing {

/// The known greys of a line; unknown ones are infinity.
struct KnownGreys {
  PaddedValues<kLineSamples> greys;
  int count = 0;      ///< of known greys
  float darkest = 0;  ///< infinity when there are none
};

/// Collects the greys that are known, which are those that are numbers.
void takeKnown(const LineGreys& line, KnownGreys& known);

/// Number of known greys that are at least this light.
int countFrom(float light, const KnownGreys& known);

/// Shade of a sample that is neither dark (-1) nor light (1), and of one whose grey is unknown.
constexpr int kBetweenShade = 0, kUnknownShade = 2;
using LineShades = std::array<int, kLineSamples>;

/// Sets -1 for the darkest 35 hundredths of the range from dark to light and anything darker, and 1 for the
/// lightest ones in the same way.
void findShades(const KnownGreys& known, float dark, float light, LineShades& shades);

}  // namespace uav_landing
