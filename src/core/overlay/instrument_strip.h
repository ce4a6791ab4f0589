#pragma once

#include <opencv2/core.hpp>

#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// A BGR8 strip of this width (pixels) that shows an estimate to a person: height, sink rate, approach angle,
/// attitude, status and reason. Numbers that must not be used to fly are red and marked as not valid. Unknown
/// numbers are a dash. The reason takes up to two lines and is cut at a word. The strip's height depends only
/// on its width, so that images of one size make a video.
cv::Mat drawInstrumentStrip(const LandingResult& landing, int width);

}  // namespace uav_landing
