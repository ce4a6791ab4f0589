#pragma once

#include <vector>

#include "stereo/plane/plane_fit.h"

namespace uav_landing {

/// Memory for the matches of each patch of the image.
struct SurfaceMemory {
  struct Point {
    double u, v;
    double height;     ///< over the plane, m
    double precision;  ///< 1 over the claimed stddev of the height, 1/m
  };
  std::vector<std::vector<Point>> patches;
};

/// Variance of the surface's height about the plane near the camera, m^2. It is unbiased, so on flat ground
/// it may be negative by chance.
/// Matches scatter as well, and by more than they claim. But neighbours share an undulation and do not share
/// scatter. So the variance is the excess of the differences between patch means over the scatter within the
/// patches. Within a patch, matches count by their stddevs, which need to be true up to a common factor.
/// Patches count by how well their means are known, as heights scatter more far away (Paule, Mandel:
/// Consensus values and weighting factors, Journal of Research of the National Bureau of Standards 87, 1982).
/// window: size of the matches' square windows, pixels. Windows that overlap share this part of their errors.
/// Blocks share no pixel: 1. When rows are not level, all matches along a slanted marking are off together,
/// and this looks like a surface that rises.
double surfaceVariance(const StereoRig& rig, const std::vector<DisparitySample>& samples, const PlaneFit& fit,
                       int window, SurfaceMemory& memory);
/// The same with memory of its own.
double surfaceVariance(const StereoRig& rig, const std::vector<DisparitySample>& samples, const PlaneFit& fit,
                       int window);

}  // namespace uav_landing
