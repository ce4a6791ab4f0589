#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "uav_landing/geometry/calibration.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

// The right camera may have turned against the left one since the calibration, by a small rotation vector w =
// (rx, ry, rz): of its axes against the rectified ones, in rectified axes (x right, y down, z forward), rad.
// A ray r0 = (x, y, 1) of the right camera as calibrated is then seen as r0 - w x r0, which moves its pixel
// by
//   du = f (-ry (1 + x^2) + rx x y + rz y),   dv = f (rx (1 + y^2) - ry x y - rz x),
// first order in w, all orders in x and y. The disparity u_l - u_r grows by -du, the vertical disparity v_r -
// v_l by dv.

/// Derivatives of a disparity by w, pixels per rad. column, v: of the pixel in the right image.
Eigen::RowVector3d disparityByRotation(const StereoRig& rig, double column, double v);
/// The same of the vertical disparity, row in the right image minus row in the left one.
Eigen::RowVector3d verticalDisparityByRotation(const StereoRig& rig, double column, double v);

/// The same by the direction of the baseline (BaselineDirection): with the right camera at b (1, ty, tz) the
/// right ray of a point is off by b (y tz - ty) / Z, and b / Z = d / f. disparity: of the point, pixels.
Eigen::RowVector2d verticalDisparityByBaseline(const StereoRig& rig, double disparity, double v);

/// How far from the middle of the image, in focal lengths, vertical disparities tell a roll.
constexpr double kLensReach = 0.3;
/// Variances of the w, rad^2, that the vertical disparities look like which the lenses of a good calibration
/// leave, 1 sigma of row_bias_stddev, pixels. Nothing has turned: disparities do not show it.
Eigen::Vector3d lensVariances(const StereoRig& rig, double row_bias_stddev);

/// How the plane g fitted to these points' disparities follows w: dg = A dw, with the points on the plane
/// weighted as the fit does (plane_fit.h). 1/m per rad. Points that leave a plane undetermined give zero.
Eigen::Matrix3d planeByRotation(const StereoRig& rig, const std::vector<StereoDepthResult::Point>& points,
                                const Eigen::Vector3d& g);

}  // namespace uav_landing
