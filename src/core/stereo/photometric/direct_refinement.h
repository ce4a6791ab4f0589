#pragma once

#include <memory>
#include <opencv2/core.hpp>

#include "stereo/matching/plane_drift.h"
#include "stereo/plane/plane_fit.h"
#include "uav_landing/image/rectification.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// What is known of a pair before its images are aligned.
struct RefinementStart {
  Eigen::Vector3d plane;  ///< good to a fraction of a pixel of disparity, 1/m, at the stamp
  /// Rotation that the vertical disparities of the images have: along a row, slanted edges seem moved by
  /// them.
  RigRotation rows;
  /// What the right image has been freed of before, rad, so that edges of pairs that were levelled otherwise
  /// count as well.
  Eigen::Vector3d levelled_by = Eigen::Vector3d::Zero();
  PlaneDrift drift = {};  ///< of the plane while rows are exposed
  /// Something else took this pair's time: the second step is the last one, and what has not settled by then
  /// is claimed.
  bool brief = false;
};

/// Direct photometric refinement of the ground plane: aligns the left image with the right one warped by the
/// plane's homography (along the rows only, as the images are rectified), over the blocks of ground that have
/// most horizontal gradient. Gauss-Newton, inverse compositional; a gain and an offset of each block are
/// projected out. A block's normal equations say by how much the plane's disparity is off there; the plane is
/// the weighted least squares solution over the blocks, and what stands on the ground loses its weight. Where
/// gradients are mostly noise all of the ground's texture is looked at instead, band by band. Edges aslant
/// tell how far rows are off beside what is known of them, and plane and rows are solved for together.
class DirectRefinement {
 public:
  /// margin: pixels that stay away from the edges of the model's masks, at least 4.
  DirectRefinement(const RigModel& model, int margin);
  ~DirectRefinement();
  DirectRefinement(DirectRefinement&&) noexcept;

  /// left, right: rectified mono8. limits.tolerance: by how much blocks of ground may be off the plane,
  /// pixels. bias_stddev: as for refinePlane, pixels. Fails when the images show too little, or when most of
  /// what they show is not on one plane.
  Expected<PlaneFit> refine(const cv::Mat& left, const cv::Mat& right, const RefinementStart& start,
                            const PlaneLimits& limits, double bias_stddev);
  /// What the last pair's edges said of the rows does not count for the next ones, as of a plane that is not
  /// taken.
  void forgetLast();
  /// Forgets the edges of the pairs before.
  void reset();
  /// Share of the blocks with anything to see that look alike in both images and are on one plane, in the
  /// last refinement; NaN when it had fewer than 20 such blocks.
  double agreement() const;
  /// Whether texture was hardly more than noise in the last refinement.
  bool noisy() const;
  /// What the last refinement was fitted to: one disparity for each block, or for several of faint texture,
  /// at the stamp.
  const std::vector<DisparitySample>& samples() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// Whether two planes from the same pair are the same within their covariances. Errors common to both make
/// this lenient, which is meant: it is to find a refinement that went astray.
bool samePlane(const GroundPlane& a, const GroundPlane& b);

/// Makes a plane as uncertain as another one of the same pair that contradicts it: one of the two is wrong by
/// what is between them, and nothing tells which.
void doubt(GroundPlane& plane, const GroundPlane& contradicting);

}  // namespace uav_landing
