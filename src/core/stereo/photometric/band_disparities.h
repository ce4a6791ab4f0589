#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "geometry/plane_vector.h"
#include "rig/rig_rotation.h"
#include "stereo/bands/band_evidence.h"
#include "stereo/bands/texture_bands.h"
#include "stereo/matching/stereo_level.h"
#include "stereo/photometric/aligned_rows.h"
#include "stereo/photometric/block_disparity.h"

namespace uav_landing {

/// Disparities of ground whose texture is hardly more than noise. Such texture is faint in other frequencies
/// than a painted line beside it. So the aligned images are split into bands, and each block counts in each
/// band by the signal that it has there.
class BandDisparities {
 public:
  /// level: of the whole images; its masks are eroded by at least two pixels.
  explicit BandDisparities(const StereoLevel& level);

  /// Takes the left image (mono8) below the horizon of the plane g, 1/m. drift: of the plane while rows are
  /// exposed.
  void choose(const cv::Mat& left, const PlaneVector& g, const PlaneDrift& drift = {});
  /// Takes the right image (mono8) of the same pair. rows: rotation that its vertical disparities have.
  void takeRight(const cv::Mat& right, const RigRotation& rows);
  /// Compares the left image with the right one warped by the plane g, 1/m.
  void measure(const PlaneVector& g, const PlaneDrift& drift = {});

  /// Whether the images differed by noise only in the last measurement. Otherwise they show different things,
  /// and there are no disparities.
  bool differByNoise() const { return differ_by_noise_; }
  /// Disparities of the last measurement, each from some blocks of a row.
  const std::vector<BlockDisparity>& disparities() const { return disparities_; }

 private:
  bool isSeen(int column, int line) const;
  void weigh();
  void tellLine(int line, const ShiftModel& shift);
  /// Blocks of a row that are joined.
  struct Group {
    BandEvidence sum;
    double place = 0;  // column times information
    int blocks = 0;
    void add(const BandEvidence& block, double u);
  };
  void tell(const Group& group, double v, const ShiftModel& shift);

  StereoRig rig_;
  AlignedRows rows_;
  cv::Mat grey_, straightened_, level_;  // the right image as floats; level_ is one of the others
  BlockGrid grid_;
  TextureBands left_, right_;
  std::vector<BandSums> sums_, around_;  // of one band
  std::vector<BandScore> scores_;        // of the band before
  std::vector<BandEvidence> evidence_;
  std::vector<BlockDisparity> disparities_;
  bool differ_by_noise_ = false;
};

}  // namespace uav_landing
