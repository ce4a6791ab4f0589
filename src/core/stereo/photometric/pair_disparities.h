#pragma once

#include <vector>

#include "geometry/plane_vector.h"
#include "stereo/photometric/band_disparities.h"
#include "stereo/photometric/block_disparities.h"

namespace uav_landing {

/// Disparities of the ground from a pair's images. They come from the blocks that show most. When most of
/// these are hardly more than noise, they come from all of the ground's faint texture.
class PairDisparities {
 public:
  /// margin: pixels to stay away from the edges of the model's masks, at least 4.
  PairDisparities(const RigModel& model, int margin);

  /// Takes a pair (mono8) and compares its blocks with the right image warped by the plane g, 1/m. rows:
  /// rotation that the vertical disparities of the images have. drift: of the plane while rows are exposed.
  void begin(const cv::Mat& left, const cv::Mat& right, const PlaneVector& g, const RigRotation& rows,
             const PlaneDrift& drift = {});
  /// Compares the same pair again, on another plane. right, rows: as for begin(). Only this call uses faint
  /// texture, because a first comparison does not need it.
  void measure(const cv::Mat& right, const PlaneVector& g, const RigRotation& rows,
               const PlaneDrift& drift = {});

  /// Disparities of the last comparison, of blocks that the right image shows.
  const std::vector<BlockDisparity>& found() const { return found_; }
  /// Number of blocks that show more than noise, whether the right image shows them or not.
  int informative() const { return informative_; }
  /// Whether neighbours share errors. They then scatter less than they are wrong.
  bool haveCommonErrors() const { return by_bands_; }
  /// Whether the blocks of this pair are hardly more than noise, so that measure() may show more than
  /// begin().
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
