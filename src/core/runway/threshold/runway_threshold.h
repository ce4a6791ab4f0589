#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "image/input/rectified_view.h"
#include "kernels/image/line_view.h"
#include "runway/direction/ground_edges.h"
#include "runway/edges/runway_edges.h"
#include "uav_landing/base/failure.h"

namespace uav_landing {

/// Distance of the threshold ahead of the left camera, in multiples of its height.
struct Threshold {
  double distance = 0, variance = 0;
  /// Part of the variance from an error that is the same in every image of this runway. It is 0 when the
  /// threshold's line or the beginning of the pavement is seen.
  double systematic_variance = 0;
};

/// Finds the threshold by its bars: at least eight edges between light and dark side by side, evenly over the
/// runway's width. Marks of the touchdown zone are not like that.
///
/// The threshold is the near edge of a bright line across the runway just before the bars, or the beginning
/// of the pavement. If neither is seen, the threshold of a full-size runway lies up to 6 m before the bars.
/// On other runways the distance scales with that between the bars. The middle of that range is reported, and
/// the systematic variance covers both of its ends.
///
/// - image: of the left camera.
/// - memory: for rows seen from above.
///
/// Fails with no_runway when there are no bars or the ground before them is not in the image. It also fails
/// when something before the bars is not clearly a line.
Expected<Threshold> findThreshold(const RectifiedView& image, const StereoRig& rig, const GroundAxes& axes,
                                  const RunwayCrossSection& runway, std::vector<LineGreys>& memory);

}  // namespace uav_landing
