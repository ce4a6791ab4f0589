#pragma once

#include <opencv2/core.hpp>

#include "uav_landing/geometry/calibration.h"
#include "uav_landing/parameters/overlay_parameters.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

// Images for people that show what the stages found. The functions are pure. Input images are rectified mono8
// of the rig's size, and the results are new BGR8 images. Missing results (NaN, empty) are not drawn.

/// Factor by which an image of this width is enlarged: the parameter or, for 0, the smallest one that makes
/// the result at least 640 pixels wide.
int overlayScale(int width, const OverlayParameters& parameters);

/// What the stages found in a pair. It refers to the results, which have to live as long.
struct PairFindings {
  const StereoDepthResult& stereo;
  const ApproachAngleResult& approach;
  const LandingResult& landing;
};

/// The left image with everything that was found:
/// - lines, those through the vanishing point bright and others dim, and the vanishing point;
/// - horizons of the stereo plane and of the fused ground normal, and the focus of expansion;
/// - matches coloured by disparity, those off the plane dim.
///
/// Below the image is a strip of instruments: height, sink rate, approach angle, attitude, status and reason.
/// The image itself is the top left (scale * size) part.
cv::Mat drawOverlay(const StereoRig& rig, const cv::Mat& left, const PairFindings& found,
                    const OverlayParameters& parameters);

/// The lines of one view (the paper's Fig. 4).
cv::Mat drawLines(const cv::Mat& image, const ApproachAngleResult::View& view,
                  const OverlayParameters& parameters);

/// Harris corners in both views side by side, with a line for each match (the paper's Fig. 5). The right view
/// begins at column scale * width.
cv::Mat drawMatches(const StereoRig& rig, const cv::Mat& left, const cv::Mat& right,
                    const StereoDepthResult& stereo, const OverlayParameters& parameters);

}  // namespace uav_landing
