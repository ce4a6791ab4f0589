#pragma once

#include <memory>
#include <opencv2/core.hpp>

#include "geometry/plane_vector.h"
#include "stereo/matching/plane_drift.h"
#include "stereo/plane/plane_fit.h"
#include "uav_landing/image/rectification.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// What is known of a pair before its images are aligned.
struct RefinementStart {
  PlaneVector plane;  ///< at the stamp; good to a fraction of a pixel of disparity
  /// Rotation that the vertical disparities of the images have. They make slanted edges seem to move along a
  /// row.
  RigRotation rows;
  /// Rotation that was removed from the right image before, rad. With it, edges of pairs that were levelled
  /// differently count as well.
  Eigen::Vector3d levelled_by = Eigen::Vector3d::Zero();
  PlaneDrift drift = {};  ///< of the plane while rows are exposed
  /// True when something else took this pair's time. The second step is then the last one, and the covariance
  /// contains what has not converged.
  bool brief = false;
};

/// Direct photometric refinement of the ground plane. It aligns the left image with the right one, warped by
/// the plane's homography (along the rows only, as the images are rectified). It uses the blocks of ground
/// with most horizontal gradient, by Gauss-Newton, inverse compositional; a gain and an offset of each block
/// are projected out.
/// The normal equations of a block tell how far the plane's disparity is off there. The plane is the weighted
/// least squares solution over the blocks, and objects on the ground lose their weight. Where gradients are
/// mostly noise, all of the ground's texture is used instead, band by band. Slanted edges tell how far rows
/// are off beyond what is known of them, so plane and rows are solved for together.
class DirectRefinement {
 public:
  /// margin: pixels to stay away from the edges of the model's masks, at least 4.
  DirectRefinement(const RigModel& model, int margin);
  ~DirectRefinement();
  DirectRefinement(DirectRefinement&&) noexcept;

  /// left, right: rectified mono8. limits.tolerance: largest distance of a ground block from the plane,
  /// pixels. bias_stddev: as for refinePlane(), pixels. Fails when the images show too little, or when most
  /// of the blocks are not on one plane.
  Expected<PlaneFit> refine(const cv::Mat& left, const cv::Mat& right, const RefinementStart& start,
                            const PlaneLimits& limits, double bias_stddev);
  /// Drops the evidence of the last pair's edges about the rows, for example because its plane is not used.
  void forgetLast();
  /// Forgets the edges of the pairs before.
  void reset();
  /// Share of the informative blocks of the last refinement that look alike in both images and are on one
  /// plane. NaN with fewer than 20 such blocks.
  double agreement() const;
  /// Whether texture was hardly more than noise in the last refinement.
  bool noisy() const;
  /// The samples of the last refinement, at the stamp: one disparity per block, or per group of faint blocks.
  const std::vector<DisparitySample>& samples() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// Whether two planes from the same pair agree within their covariances. Errors common to both make this test
/// lenient. That is intended: it only has to find a refinement that went astray.
bool samePlane(const GroundPlane& a, const GroundPlane& b);

/// Makes a plane as uncertain as its difference from a contradicting plane of the same pair. One of the two
/// is wrong, and nothing tells which.
void doubt(GroundPlane& plane, const GroundPlane& contradicting);

}  // namespace uav_landing
