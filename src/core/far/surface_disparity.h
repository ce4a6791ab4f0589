#pragma once

#include <opencv2/core.hpp>
#include <optional>

#include "far/outline.h"
#include "uav_landing/geometry/ground_plane.h"
#include "uav_landing/image/rectification.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// The disparity of a surface where it holds.
struct SurfaceDisparity {
  Eigen::Vector2d pixel;   ///< in the left image, px
  double value = 0;        ///< px
  double variance = 0;     ///< by the noise of the images, px^2
  double bias_stddev = 0;  ///< 1 sigma of the error that pairs in a row have in common, px

  double totalVariance() const { return variance + bias_stddev * bias_stddev; }
};

/// Both images of a pair, mono8.
struct RectifiedImages {
  const cv::Mat &left, &right;
};

/// How the right camera is turned against its calibration, as far as that is known.
struct RightCamera {
  RigRotation rows;    ///< by the vertical disparities of this pair: where its rows are
  RigRotation turned;  ///< by the pairs before: what all disparities have in common
};

/// Measures the disparity of the surface within an outline by aligning the grey levels of both images, in one
/// least squares over all pixels, with a common gain and offset. The long edges of a runway tell it to a
/// hundredth of a pixel, so stereo sees a runway of 45 m to some per cent from 1 km. The plane before the
/// threshold says less of the runway than that, as the ground may rise or fall.
///
/// The disparity is that of a rig as calibrated: what the right camera is turned by is taken out. corners: of
/// the surface in the left image. about: plane of the surface, known roughly. Its slope is taken from there,
/// and only its distance is measured. Nothing where the images do not look alike.
std::optional<SurfaceDisparity> measureDisparity(const RectifiedImages& images, const RigModel& model,
                                                 const RightCamera& right, const Corners& corners,
                                                 const GroundPlane& about);

}  // namespace uav_landing
