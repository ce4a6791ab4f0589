#pragma once

#include <optional>
#include <vector>

#include "stereo/block_disparities.h"

namespace uav_landing {

/// Disparities of the ground from blocks of a pair's images. Where a block's gradients are mostly noise, as
/// on coarse texture close below, the means of two by two pixels lose little of the texture and most of the
/// noise: each cell of a grid is looked at in the resolution that tells more, so that a painted line stays
/// sharp beside texture that is hardly seen.
class PairDisparities {
 public:
  /// margin: pixels that stay away from the edges of the model's masks, at least 4.
  PairDisparities(const RigModel& model, int margin);

  /// Takes blocks of a pair (mono8) and compares them with the right image warped by the plane g, 1/m. rows:
  /// rotation that the vertical disparities of the images have.
  void begin(const cv::Mat& left, const cv::Mat& right, const Eigen::Vector3d& g, const RigRotation& rows);
  /// Compares them on another plane. right: as for begin.
  void measure(const cv::Mat& right, const Eigen::Vector3d& g, const RigRotation& rows);

  /// Of the last comparison, those that the right image shows.
  const std::vector<BlockDisparity>& found() const { return found_; }
  /// Blocks that show more than noise, also those that the right image does not show.
  int informative() const { return informative_; }

 private:
  void lookAtHalved(const cv::Mat& left, const cv::Mat& right, const Eigen::Vector3d& g,
                    const RigRotation& rows);
  void chooseResolutions();
  size_t cellOf(const BlockDisparity& disparity) const;
  bool anyHalved() const;
  void collect();

  BlockDisparities whole_;
  std::optional<BlockDisparities> halved_;  // none where a halved image would not hold a block
  cv::Mat halved_left_, halved_right_;
  cv::Size cells_;               // of the grid, across and down
  std::vector<char> is_halved_;  // for each cell, row by row, 1 if its halved images are looked at
  std::vector<BlockDisparity> found_;
  int informative_ = 0;
};

}  // namespace uav_landing
