#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core.hpp>

namespace uav_landing {

/// Sub-pixel place of a window of the reference image in another one.
struct PatchRefinement {
  bool converged = false;
  Eigen::Vector2d position;  ///< in the other image
  double score = 0;
  /// Of a pixel, grey levels^2: the noise of both images, and what does not fit.
  double residual_variance = 0;

  /// What the window holds to tell a place from its neighbours, in pixels of the reference.
  struct Evidence {
    Eigen::Matrix2d gradient;                ///< sums of the products of its components, about their means
    std::array<Eigen::Matrix2d, 2> moments;  ///< the same by distance from the centre, across and down
    /// Sum of grad (grad.d) d^T over the window, d the distance from the centre, about the gradient's mean.
    Eigen::Matrix2d growth;
    Eigen::Vector2d by_gain;          ///< shift that a unit of gain looks like
    double gain = 0;                  ///< that the other image is multiplied by to look like the reference
    double mean = 0, mean_there = 0;  ///< grey levels of the window in the reference and in the other image
    double contrast = 0;              ///< of the other image, that no shift explains
    int count = 0;                    ///< pixels
  } evidence;
  Eigen::Matrix2d warp;  ///< from the reference to the other image

  /// Of the position, pixels^2, and how it follows from the warp it was looked for with, as the gradients lie
  /// beside the centre: with a warp that is too large by E it is off by -(by_warp[0] E.col(0) +
  /// by_warp[1] E.col(1)).
  struct Claim {
    Eigen::Matrix2d covariance;
    std::array<Eigen::Matrix2d, 2> by_warp;
    /// In a window that shrinks by 1 + w.d with the distance d from its centre (w per pixel of the
    /// reference), as perspective has it, the place found is off by -by_perspective w.
    Eigen::Matrix2d by_perspective;
    /// By how much the place found is off for each unit by which the gain found is too large; where texture
    /// is hardly more than noise less than that, as it is not told well there.
    Eigen::Vector2d by_gain;
  };
  /// noise_variance: of a pixel of either image; at most half of the residuals'.
  Claim claim(double noise_variance) const;
  Claim claim() const { return claim(0.5 * residual_variance); }
  /// The claim's covariance alone, pixels^2, for which the evidence needs no distances.
  Eigen::Matrix2d covariance(double noise_variance) const;
  Eigen::Matrix2d covariance() const { return covariance(0.5 * residual_variance); }
};

/// What a window of the reference is by itself, whatever it is compared with: found by the first comparison,
/// for those with other images that may follow. Sums are about their means.
struct OwnTexture {
  bool known = false, usable = false;
  double mean = 0;                    ///< grey level, less the one in the middle
  Eigen::Vector2d gradient_mean;      ///< of the gradient
  Eigen::Matrix2d gradient, inverse;  ///< sums of the products of its components; their inverse
  Eigen::Vector2d right;              ///< of its products with the grey levels
  double energy = 0;                  ///< of the squares of the grey levels
  bool distances_known = false;       ///< what follows is found when a comparison succeeds
  std::array<Eigen::Matrix2d, 2> moments = {Eigen::Matrix2d::Zero(), Eigen::Matrix2d::Zero()};
  Eigen::Matrix2d growth = Eigen::Matrix2d::Zero();  ///< both as PatchRefinement::Evidence has them
};

}  // namespace uav_landing
