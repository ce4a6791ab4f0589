#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core.hpp>

namespace uav_landing {

/// Sub-pixel place of a window of the reference image in another image.
struct PatchRefinement {
  bool converged = false;
  Eigen::Vector2d position;  ///< in the other image
  double score = 0;
  /// Variance of a pixel, grey levels^2: the noise of both images, and differences of their content.
  double residual_variance = 0;

  /// The texture of the window that tells a place from its neighbours, in pixels of the reference.
  struct Evidence {
    Eigen::Matrix2d gradient;                ///< sums of the products of its components, about their means
    std::array<Eigen::Matrix2d, 2> moments;  ///< the same times the distance from the centre, across and down
    /// Sum of grad (grad.d) d^T over the window, with d the distance from the centre, about the gradient's
    /// mean.
    Eigen::Matrix2d growth;
    Eigen::Vector2d by_gain;          ///< shift that looks like a unit of gain
    double gain = 0;                  ///< factor on the other image that makes it look like the reference
    double mean = 0, mean_there = 0;  ///< grey levels of the window in the reference and in the other image
    double contrast = 0;              ///< part of the other image's that no shift explains
    int count = 0;                    ///< pixels
  } evidence;
  Eigen::Matrix2d warp;  ///< from the reference to the other image

  /// Errors of the position. covariance: of the position, pixels^2. by_warp: effect of a wrong warp, because
  /// gradients lie beside the centre. With a warp that is too large by E, the position is off by -(by_warp[0]
  /// E.col(0) + by_warp[1] E.col(1)).
  struct Claim {
    Eigen::Matrix2d covariance;
    std::array<Eigen::Matrix2d, 2> by_warp;
    /// Perspective shrinks a window by 1 + w.d with the distance d from its centre (w per pixel of the
    /// reference). The position is then off by -by_perspective w.
    Eigen::Matrix2d by_perspective;
    /// Offset of the position per unit by which the gain found is too large. It is smaller where texture is
    /// hardly more than noise, as the gain is uncertain there.
    Eigen::Vector2d by_gain;
  };
  /// noise_variance: of a pixel of either image; at most half of the residuals' variance is used.
  Claim claim(double noise_variance) const;
  Claim claim() const { return claim(0.5 * residual_variance); }
  /// Covariance of the claim alone, pixels^2. It needs no evidence with distances.
  Eigen::Matrix2d covariance(double noise_variance) const;
  Eigen::Matrix2d covariance() const { return covariance(0.5 * residual_variance); }
};

/// Properties of a window of the reference that do not depend on the other image. The first comparison
/// computes them for all later ones. Sums are about their means.
struct OwnTexture {
  bool known = false, usable = false;
  double mean = 0;                    ///< grey level, less that of the middle pixel
  Eigen::Vector2d gradient_mean;      ///< mean of the gradient
  Eigen::Matrix2d gradient, inverse;  ///< sums of the products of the gradient's components; their inverse
  Eigen::Vector2d right;              ///< sums of the gradient's products with the grey levels
  double energy = 0;                  ///< sum of the squared grey levels
  bool distances_known = false;       ///< the values below are computed when a comparison succeeds
  std::array<Eigen::Matrix2d, 2> moments = {Eigen::Matrix2d::Zero(), Eigen::Matrix2d::Zero()};
  Eigen::Matrix2d growth = Eigen::Matrix2d::Zero();  ///< both as in PatchRefinement::Evidence
};

}  // namespace uav_landing
