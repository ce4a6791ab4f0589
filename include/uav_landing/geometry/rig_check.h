#pragma once

#include <string>
#include <vector>

#include "uav_landing/geometry/calibration.h"
#include "uav_landing/parameters/rig_parameters.h"

namespace uav_landing {

// A camera_info can be complete and still not belong to the pictures: it is of another picture size, or its
// baseline is in millimetres. Nothing in the images shows that: heights look right and are wrong by a factor.
// So what is unlikely for a camera is refused, or warned about.
//
// The offset of a principal point is |K[2] - width / 2| / width, and |K[5] - height / 2| / height, in pixels
// of the full resolution: a ROI or binning that camera_info announces does not count. For a K that is s times
// too large it is |s - 1| / 2. P is not asked: rectification may put its principal point anywhere.

/// Baselines between the cameras of an aircraft, m; others are warned about. scripts/calibrate has the same
/// limits (src/tools/calibration/checks.py), and a test compares them.
constexpr double kShortestLikelyBaseline = 0.01, kLongestLikelyBaseline = 10.0;

/// Refuses a camera that passed checkCalibration() when its principal point is too far off the middle. The
/// failure names the field, as that of checkCalibration() does, and the parameter that lets it through.
Failure checkPrincipalPoint(const CameraCalibration& calibration, const RigParameters& limits);

/// As makeStereoRig(left, right), and refuses what is beyond the limits.
Expected<StereoRig> makeStereoRig(const CameraCalibration& left, const CameraCalibration& right,
                                  const RigParameters& limits);

/// What is unlikely about a pair that makeStereoRig() accepts with these limits: for each camera a principal
/// point from half of its limit on, and a baseline that is not likely. Empty for a pair that is refused.
std::vector<std::string> rigWarnings(const CameraCalibration& left, const CameraCalibration& right,
                                     const RigParameters& limits);

}  // namespace uav_landing
