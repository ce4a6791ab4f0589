#pragma once

#include <std_msgs/Header.h>
#include <uav_landing/ApproachAngle.h>
#include <uav_landing/LandingEstimate.h>
#include <uav_landing/StereoDepth.h>

#include <string>

#include "uav_landing/results/stage_results.h"

namespace uav_landing {

// Converts stage results to messages and back. Nothing is lost in either direction: messages carry float64,
// so a stage computes the same from a message as from the result itself. A result's stamp is header.stamp in
// seconds.

StereoDepth toMessage(const StereoDepthResult& result, const std_msgs::Header& header, double compute_ms);
StereoDepthResult toResult(const StereoDepth& message);

ApproachAngle toMessage(const ApproachAngleResult& result, const std_msgs::Header& header, double compute_ms);
ApproachAngleResult toResult(const ApproachAngle& message);

/// header: stamp of the image, frame of the runway. skew: stamp of the right image minus that of the left
/// one, s. The protection level stays unknown.
LandingEstimate toMessage(const LandingResult& result, const std_msgs::Header& header,
                          const std::string& child_frame_id, double skew, double compute_ms);
LandingResult toResult(const LandingEstimate& message);

}  // namespace uav_landing
