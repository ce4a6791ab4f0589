#pragma once

#include <vector>

#include "stereo/photometric/band_disparities.h"
#include "stereo/photometric/block_disparities.h"

namespace uav_landing {

/// Disparities of the ground from a pair's images: by the blocks that show most, or, where most of these are
/// hardly more than noise, by all of the ground's texture, faint as it is.
class PairDisparities {
 public:
  /// margin: pixels that stay away from the edges of the model's masks, at least 4.
  PairDisparities(const RigModel& model, int margin);

  /// Takes a pair (mono8) and compares blocks of it with the right image warped by the plane g, 1/m. rows:
  /// rotation that the vertical disparities of the images have. drift: of the plane while rows are exposed.
  void begin(const cv::Mat& left, const cv::Mat& right, const Eigen::Vector3d& g, const RigRotation& rows,
             const PlaneDrift& drift = {});
  /// Compares the same pair once more, on another plane. right, rows: as for begin. Only this looks at faint
  /// texture, as a first comparison does well enough without.
  void measure(const cv::Mat& right, const Eigen::Vector3d& g, const RigRotation& rows,
               const PlaneDrift& drift = {});

  /// Of the last comparison, those that the right image shows.
  const std::vector<BlockDisparity>& found() const { return found_; }
  /// Blocks that show more than noise, also those that the right image does not show.
  int informative() const { return informative_; }
  /// Whether neighbours have errors in common, so that they scatter less than they are wrong.
  bool haveCommonErrors() const { return by_bands_; }
  /// Whether blocks are hardly more than noise in this pair, so that measure() may show more than begin().
  bool areFaint() const { return faint_; }

 private:
  void collect();

  BlockDisparities blocks_;
  BandDisparities bands_;
  bool faint_ = false, by_bands_ = false;
  std::vector<BlockDisparity> found_;
  int informative_ = 0;
};

}  // namespace uav_landing
