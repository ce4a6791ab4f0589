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

/// Square of the height by which the surface near the camera rises and falls about the plane. Matches
/// scatter, too, and not only by what they claim: but an undulation is common to neighbours and the scatter
/// is not. So it is what the means of patches differ by, beyond what the scatter within the patches explains.
/// Within a patch matches count by their stddevs, which need to be true but for a factor; patches count by
/// how well their means are known: heights scatter the more the farther away (Paule, Mandel: Consensus values
/// and weighting factors, Journal of Research of the National Bureau of Standards 87, 1982). Matches whose
/// windows (squares of so many pixels) overlap have that share of their errors in common; 1 for blocks, which
/// share no pixel. Where rows are not level all matches along a marking aslant are off together, which looks
/// the same as a surface that rises. Below zero by chance on flat ground. m^2
double surfaceVariance(const StereoRig& rig, const std::vector<DisparitySample>& samples, const PlaneFit& fit,
                       int window, SurfaceMemory& memory);
/// The same with memory of its own.
double surfaceVariance(const StereoRig& rig, const std::vector<DisparitySample>& samples, const PlaneFit& fit,
                       int window);

}  // namespace uav_landing
