#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "geometry/stamp_map.h"
#include "kernels/image/line_view.h"
#include "runway/direction/ground_edges.h"
#include "runway/position/runway_edges.h"
#include "uav_landing/base/failure.h"

namespace uav_landing {

/// Where the threshold lies in front of the left camera, in multiples of its height.
struct Threshold {
  double distance = 0, variance = 0;
  /// Part of the variance that is the same error in every picture of this runway; 0 when its line or the
  /// beginning of its pavement is seen.
  double systematic_variance = 0;
};

/// The threshold: the near edge of a bright line across the runway just before its bars, or where the
/// pavement of the bars begins. Where neither is seen it lies up to 6 m of a full-size runway, scaled by the
/// distance between its bars, before them: told in the middle, with a systematic error that takes in both
/// ends. Bars: at least eight edges between light and dark side by side, evenly over the
/// runway's width, unlike the marks of the touchdown zone. image: left rectified mono8. mask: 255 where it
/// has picture. memory: for rows seen from above. rows: of the image.
Expected<Threshold> findThreshold(const cv::Mat& image, const cv::Mat& mask, const StereoRig& rig,
                                  const GroundAxes& axes, const RunwayCrossSection& runway,
                                  std::vector<LineGreys>& memory, const StampMap& rows = {});

}  // namespace uav_landing
