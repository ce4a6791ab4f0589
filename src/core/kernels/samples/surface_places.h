#pragma once

#include <cstddef>

#include "kernels/samples/plane_votes.h"

namespace uav_landing {

/// Samples by columns of whole lanes. value: of each sample. flat: the value minus a part that a plane does
/// not have. The last three columns are results.
struct SurfaceColumns {
  const double *x, *y, *value, *flat;
  double *by_plane, *expected, *reach;
  size_t count;
};

/// For each sample, sets the value of a plane; this value plus the part that the plane does not have, at
/// least least; and another linear value, reach. Both linear values are multiplied by scale.
void placeOnSurface(const LinearValue& plane, const LinearValue& reach, double scale, double least,
                    const SurfaceColumns& columns);

}  // namespace uav_landing
