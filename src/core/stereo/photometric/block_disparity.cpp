#include "stereo/photometric/block_disparity.h"

#include <cmath>

namespace uav_landing {

BlockDisparity disparityOf(const ShiftMatch& match, const StereoRig& rig, const ShiftModel& model,
                           const Eigen::Vector3d& w) {
  // Comparisons are first order in the shift, so a larger one (pixels) means nothing.
  constexpr double kLargestShift = 1.5;
  // The warp puts a right pixel on u; it belongs to the left pixel u + shift. The disparity is stated for u
  // itself, because a place that contains the error of the shift would pull the plane.
  const ShiftModel shift = model.around(match.u, match.v);
  const double density = 1 - shift.a;  // of right pixels over left ones
  const double place = shift.at(match.u, match.v);
  const double disparity = place + match.shift * density - rig.principalOffset();
  // A row that is off shows ground that is nearer or farther, and moves slanted edges.
  const double by_row = -(shift.b + density * match.lean);
  const Eigen::RowVector3d leak = by_row * verticalDisparityByRotation(rig, match.u - place, match.v);
  return {{match.u, match.v, density * match.stddev, disparity - leak.dot(w)},
          leak,
          match.blocks,
          match.alike && std::abs(match.shift) < kLargestShift};
}

}  // namespace uav_landing
