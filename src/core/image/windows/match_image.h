#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "uav_landing/geometry/calibration.h"

namespace uav_landing {

/// The first rows of an image's two levels that are needed.
struct FirstRows {
  int fine = 0, coarse = 0;
};

/// First rows that may show ground of a plane with this normal (of any length). They lie above pixels above
/// its horizon. slack: share of the image's rows, by which they lie still farther above, as the normal may be
/// wrong.
FirstRows firstGroundRows(const StereoRig& rig, const Eigen::Vector3d& normal, const FirstRows& above,
                          double slack);

/// An image prepared for matching, in float. It is lightly smoothed, so that interpolation does not pull
/// matches towards whole pixels. It has full size and a coarse level of about 400 columns for wide searches.
struct MatchImage {
  cv::Mat fine;    ///< CV_32F, full size
  cv::Mat coarse;  ///< CV_32F, averaged over factor x factor pixels
  int factor = 1;
  FirstRows first;  ///< rows of the levels above these contain nothing of the image

  /// image: mono8. Rows above the first ones are skipped.
  void assign(const cv::Mat& image, const FirstRows& first_rows = {});
  /// Adds rows above them that are needed after all. image: the same as for assign().
  void extend(const cv::Mat& image, const FirstRows& first_rows);
};

/// Reduction factor of the coarse level for images of this size: 1, 2, 4, ...
int coarseFactor(const cv::Size& size);

/// Coordinate of a full-size pixel at the coarse level, and back. Pixel centres are whole numbers.
inline double toCoarse(double x, int factor) { return (x + 0.5) / factor - 0.5; }
inline double fromCoarse(double x, int factor) { return (x + 0.5) * factor - 0.5; }

}  // namespace uav_landing
