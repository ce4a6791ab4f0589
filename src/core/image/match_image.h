#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "uav_landing/geometry/calibration.h"

namespace uav_landing {

/// The first rows of an image's two levels that are looked at.
struct FirstRows {
  int fine = 0, coarse = 0;
};

/// Where there may be ground, of a plane with this normal (of any length): from so many pixels of the levels
/// above its horizon on, and from slack, a share of the image's rows, farther above as the normal may be off.
FirstRows firstGroundRows(const StereoRig& rig, const Eigen::Vector3d& normal, const FirstRows& above,
                          double slack);

/// An image prepared for matching: lightly smoothed (so that interpolation does not pull matches towards
/// whole pixels) in float, at full size and at a coarse level of about 400 columns for wide searches.
struct MatchImage {
  cv::Mat fine;    ///< CV_32F, full size
  cv::Mat coarse;  ///< CV_32F, averaged over factor x factor pixels
  int factor = 1;
  FirstRows first;  ///< what the levels have above these rows is not of the image

  /// image: mono8. Rows above the first ones are left out.
  void assign(const cv::Mat& image, const FirstRows& first_rows = {});
  /// Adds rows above them, when they are looked at after all. image: the same.
  void extend(const cv::Mat& image, const FirstRows& first_rows);
};

/// Reduction of the coarse level for images of this size: 1, 2, 4, ...
int coarseFactor(const cv::Size& size);

/// Coordinate of a full-size pixel at the coarse level, and back (pixel centres are whole numbers).
inline double toCoarse(double x, int factor) { return (x + 0.5) / factor - 0.5; }
inline double fromCoarse(double x, int factor) { return (x + 0.5) * factor - 0.5; }

}  // namespace uav_landing
