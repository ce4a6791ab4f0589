#pragma once

#include <memory>
#include <opencv2/core.hpp>

#include "far/outline_pose.h"

namespace uav_landing {

/// What is painted along the edges of a surface.
enum class EdgePaint { kUnknown, kStripes, kNone };

/// An outline with what tells how clearly it is there.
struct FittedOutline {
  SeenOutline seen;
  double blur = 0;      ///< px
  double contrast = 0;  ///< grey levels between surface and ground, and
  double contrast_stddev = 0;
  double residual = 0;  ///< 1 sigma of what the model leaves, grey levels
  double stripes = 0;   ///< width of the stripes times their contrast against the surface, m x grey levels
  double cost = 0;      ///< -2 log likelihood, with what is known of paint and blur; comparable between the
                        ///< fits of one OutlineFitter
};

/// The runway's outline by least squares over the grey levels around it.
///
/// A surface of one grey level lies on ground of another; both change evenly with the distance, as haze makes
/// them. From afar a painted stripe along an edge is much narrower than a pixel. It looks like an edge that
/// is farther inside, by its width times its contrast over that of the surface: three metres of each side of
/// a dark runway. Bars at the threshold do the same. So stripes, bars and centre line are part of the model,
/// with amplitudes that are not known, and the claimed covariance of the sides takes in what they leave open.
///
/// This makes such fits of the same pixels from several starts.
class OutlineFitter {
 public:
  /// reference: corners within some pixels. All fits tell by how far the sides lie inside of it.
  OutlineFitter(const cv::Mat& image, const cv::Mat& mask, const Corners& reference, const OutlineLook& look);
  ~OutlineFitter();
  /// inward: where to begin, px. Fails where that leads astray, or no contrast is there.
  Expected<FittedOutline> fit(const Vector8d& inward, EdgePaint paint);

 private:
  struct Pixels;
  Corners reference_;
  OutlineLook look_;
  std::unique_ptr<const Pixels> pixels_;
  double noise_ = 0;  // grey levels: that of the first fit, in all costs
};

/// One fit from these corners.
Expected<FittedOutline> fitOutline(const cv::Mat& image, const cv::Mat& mask, const Corners& start,
                                   const OutlineLook& look);

}  // namespace uav_landing
