#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core.hpp>

namespace uav_landing {

/// Sub-pixel place by Gauss-Newton over (shift, gain, offset), with the reference's own gradient.
struct PatchRefinement {
  bool converged = false;
  Eigen::Vector2d position;
  Eigen::Matrix2d covariance;  ///< of the position, from residuals and gradient less the noise's, pixels^2
  /// The place found depends on the warp it was looked for with, as the gradients lie beside the centre: with
  /// a warp that is too large by E it is off by -(by_warp[0] E.col(0) + by_warp[1] E.col(1)). pixels
  std::array<Eigen::Matrix2d, 2> by_warp;
  double score = 0;
};
PatchRefinement refinePatch(const cv::Mat& reference, const cv::Mat& other, int u, int v,
                            const Eigen::Vector2d& position, const Eigen::Matrix2d& warp, int radius);

}  // namespace uav_landing
