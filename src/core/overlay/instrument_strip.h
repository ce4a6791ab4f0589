#pragma once

#include <opencv2/core.hpp>

#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// A BGR8 strip of this width (pixels) that shows an estimate to a person: height, sink rate, approach angle,
/// attitude, status and reason. Numbers that must not be used to fly are dim, unknown ones a dash.
cv::Mat drawInstrumentStrip(const LandingResult& landing, int width);

}  // namespace uav_landing
