#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "geometry/plane_vector.h"
#include "stereo/matching/stereo_level.h"
#include "stereo/photometric/block_disparity.h"
#include "stereo/photometric/photometric_blocks.h"

namespace uav_landing {

/// Disparities of the ground from blocks of a pair's images.
class BlockDisparities {
 public:
  /// level: of the whole images; its masks are eroded by at least two pixels.
  explicit BlockDisparities(const StereoLevel& level);

  /// Takes blocks of the left image (mono8) below the horizon of the plane g, 1/m. drift: of the plane while
  /// rows are exposed.
  void choose(const cv::Mat& left, const PlaneVector& g, const PlaneDrift& drift = {});
  /// Compares them with the right image (mono8) warped by the plane g, 1/m. rows: rotation that the vertical
  /// disparities of the images have.
  void measure(const cv::Mat& right, const PlaneVector& g, const RigRotation& rows,
               const PlaneDrift& drift = {});

  /// Disparities of the last measurement.
  const std::vector<BlockDisparity>& disparities() const { return disparities_; }
  /// Share of the blocks that tell it beyond doubt, each alone or a few together.
  double certainShare() const;

 private:
  StereoRig rig_;
  PhotometricBlocks blocks_;
  std::vector<PhotometricBlocks::Match> matches_;
  std::vector<BlockDisparity> disparities_;
};

}  // namespace uav_landing
