#pragma once

#include <cstddef>

#include "kernels/samples/plane_votes.h"

namespace uav_landing {

/// Samples by columns of whole lanes. value: what is known of each; flat: the same less something that a
/// plane does not have. The last three are results.
struct SurfaceColumns {
  const double *x, *y, *value, *flat;
  double *by_plane, *expected, *reach;
  size_t count;
};

/// Sets what a plane gives at each sample, the same with what the plane does not have, but at least least,
/// and another linear value. Both linear values are multiplied by scale.
void placeOnSurface(const LinearValue& plane, const LinearValue& reach, double scale, double least,
                    const SurfaceColumns& columns);

}  // namespace uav_landing
