#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "geometry/plane_vector.h"
#include "uav_landing/geometry/calibration.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

// The right camera may have turned against the left one since the calibration. A small rotation vector w =
// (rx, ry, rz) describes this, rad: its axes against the rectified ones, in rectified axes (x right, y down,
// z forward). A ray r0 = (x, y, 1) of the right camera as calibrated is then seen as r0 - w x r0. Its pixel
// moves by
//   du = f (-ry (1 + x^2) + rx x y + rz y),   dv = f (rx (1 + y^2) - ry x y - rz x).
// This is of first order in w and of all orders in x and y. The disparity u_l - u_r grows by -du, the
// vertical disparity v_r - v_l grows by dv.

/// Derivatives of a disparity with respect to w, pixels per rad. column, v: the pixel in the right image.
Eigen::RowVector3d disparityByRotation(const StereoRig& rig, double column, double v);
/// The same for the vertical disparity: row in the right image minus row in the left one.
Eigen::RowVector3d verticalDisparityByRotation(const StereoRig& rig, double column, double v);

/// The same with respect to the direction of the baseline (BaselineDirection). With the right camera at b (1,
/// ty, tz), the right ray of a point is off by b (y tz - ty) / Z, and b / Z = d / f. disparity: that of the
/// point, pixels.
Eigen::RowVector2d verticalDisparityByBaseline(const StereoRig& rig, double disparity, double v);

/// Where the right image shows a pixel of the left one that has this disparity. rows: by vertical
/// disparities; not known: the rows are level.
Eigen::Vector2d placeInRightImage(const StereoRig& rig, const RigRotation& rows, const Eigen::Vector2d& left,
                                  double disparity);

/// Distance from the middle of the image at which vertical disparities show a roll, in focal lengths.
constexpr double kLensReach = 0.3;
/// Lenses leave vertical disparities even after a good calibration: 1 sigma is row_bias_stddev, pixels. They
/// look like a rotation w. Returns the variances of that apparent w, rad^2. No camera has turned, so
/// disparities do not show it.
Eigen::Vector3d lensVariances(const StereoRig& rig, double row_bias_stddev);

/// Derivative A of the plane g that was fitted to these points' disparities by w: dg = A dw, 1/m per rad. The
/// points on the plane are weighted as in the fit (plane_fit.h). Returns zero when the points do not
/// determine a plane.
Eigen::Matrix3d planeByRotation(const StereoRig& rig, const std::vector<StereoDepthResult::Point>& points,
                                const PlaneVector& plane);

}  // namespace uav_landing
