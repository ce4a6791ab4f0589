#pragma once

#include <opencv2/core.hpp>

#include "uav_landing/failure.h"
#include "uav_landing/ground_edges.h"
#include "uav_landing/runway_edges.h"

namespace uav_landing {

/// Where the threshold lies in front of the left camera, in multiples of its height.
struct Threshold {
  double distance = 0, variance = 0;
};

/// The threshold: the near edge of a bright line across the runway just before its bars, or where the bars
/// begin when there is none. Bars: at least eight edges between light and dark side by side, evenly over the
/// runway's width, unlike the marks of the touchdown zone. image: left rectified mono8. mask: 255 where it
/// has picture.
Expected<Threshold> findThreshold(const cv::Mat& image, const cv::Mat& mask, const StereoRig& rig,
                                  const GroundAxes& axes, const RunwayCrossSection& runway);

}  // namespace uav_landing
