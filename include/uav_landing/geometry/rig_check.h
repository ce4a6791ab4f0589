#pragma once

#include <string>
#include <vector>

#include "uav_landing/geometry/calibration.h"
#include "uav_landing/parameters/rig_parameters.h"

namespace uav_landing {

// A camera_info can be complete and still not belong to the images. It may be for another image size, or its
// baseline may be in millimetres. No image shows that: heights look right and are wrong by a factor. So
// values that are unlikely for a camera are refused, or give a warning.
//
// The offset of a principal point is |K[2] - width / 2| / width, and |K[5] - height / 2| / height, in pixels
// of the full resolution, without ROI or binning. For a K that is s times too large it is |s - 1| / 2. P is
// not tested, because rectification may put its principal point anywhere.

/// Baselines between the cameras of an aircraft, m; others give a warning. scripts/calibrate has the same
/// limits (src/tools/calibration/checks.py), and a test compares them.
constexpr double kShortestLikelyBaseline = 0.01, kLongestLikelyBaseline = 10.0;

/// Refuses a camera that passed checkCalibration() when its principal point is too far off the middle. The
/// failure names the field, and the parameter that lets it through.
Failure checkPrincipalPoint(const CameraCalibration& calibration, const RigParameters& limits);

/// Makes the rig as makeStereoRig(left, right) does, and refuses what is beyond the limits.
Expected<StereoRig> makeStereoRig(const CameraCalibration& left, const CameraCalibration& right,
                                  const RigParameters& limits);

/// Warnings about a pair that makeStereoRig() accepts with these limits: a principal point beyond half of its
/// limit, and an unlikely baseline. Empty for a pair that is refused.
std::vector<std::string> rigWarnings(const CameraCalibration& left, const CameraCalibration& right,
                                     const RigParameters& limits);

}  // namespace uav_landing
