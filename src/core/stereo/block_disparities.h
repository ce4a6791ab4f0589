#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "stereo/photometric_blocks.h"
#include "uav_landing/results/disparity_sample.h"
#include "uav_landing/rig/rig_rotation.h"
#include "uav_landing/stereo/stereo_level.h"

namespace uav_landing {

/// What one block that shows more than noise, or several together, say of the disparity.
struct BlockDisparity {
  DisparitySample sample;   ///< pixels of the whole images
  Eigen::RowVector3d leak;  ///< the disparity's derivative by the rows' rotation, pixels per rad
  int blocks;               ///< that say so, as many as they are in whole images
  bool alike;               ///< whether the right image shows them: of others the disparity means nothing
};

/// Disparities of the ground from blocks of a pair's images, reduced by a factor: the means of as many pixels
/// along each side, or at factor 1 the whole images. Reduced ones show less, through less noise.
class BlockDisparities {
 public:
  /// level: of the reduced images; its masks are eroded by at least two pixels.
  BlockDisparities(const StereoLevel& level, int factor);

  /// Takes blocks of the reduced left image (mono8) below the horizon of the plane g, 1/m.
  void choose(const cv::Mat& left, const Eigen::Vector3d& g);
  /// Compares them with the reduced right image (mono8) warped by the plane g. rows: rotation that the
  /// vertical disparities of the images have.
  void measure(const cv::Mat& right, const Eigen::Vector3d& g, const RigRotation& rows);
  /// After that, with the same arguments: measures how much of a shift those blocks show whose signal is not
  /// beyond doubt, for this and later measurements. Noise makes gradients that show nothing of it: these
  /// blocks would have too much to say. Where they do not clearly show it they say nothing.
  void measureResponse(const cv::Mat& right, const Eigen::Vector3d& g, const RigRotation& rows);

  /// Of the last measurement.
  const std::vector<BlockDisparity>& disparities() const { return disparities_; }
  /// Share of their blocks that do so beyond doubt, each alone or a few together.
  double certainShare() const;

 private:
  void convert(const ShiftModel& shift, const RigRotation& rows);
  double responseAround(const cv::Mat& right, const Eigen::Vector3d& g);
  /// At a place of the reduced images, pixels of which stddev and disparity are.
  DisparitySample inWholeImages(double u, double v, double stddev, double disparity) const;

  int factor_;
  StereoRig rig_;  // of the reduced images
  PhotometricBlocks blocks_;
  std::vector<PhotometricBlocks::Match> matches_;
  std::vector<BlockDisparity> disparities_;
  double response_ = 1;  // of the matches that are not beyond doubt: the share of a shift that they show
};

}  // namespace uav_landing
