#pragma once

#include <array>

#include "kernels/image/line_view.h"
#include "kernels/lanes/order_statistic.h"

namespace uav_landing {

/// What is known of the greys of a line, and infinity for the rest.
struct KnownGreys {
  PaddedValues<kLineSamples> greys;
  int count = 0;      ///< of the known ones
  float darkest = 0;  ///< infinity when there are none
};

/// Greys that are no numbers are not known.
void takeKnown(const LineGreys& line, KnownGreys& known);

/// How many of the known greys are so light or lighter.
int countFrom(float light, const KnownGreys& known);

/// Of a sample that is neither dark (-1) nor light (1), and of one whose grey is not known.
constexpr int kBetweenShade = 0, kUnknownShade = 2;
using LineShades = std::array<int, kLineSamples>;

/// Sets -1 for greys in the darkest 35 hundredths of the way from dark to light, or darker, and 1 for the
/// lightest ones in the same way.
void findShades(const KnownGreys& known, float dark, float light, LineShades& shades);

}  // namespace uav_landing
