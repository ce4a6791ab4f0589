#pragma once

#include <array>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "kernels/block/block_texture.h"
#include "stereo/matching/shift_model.h"
#include "stereo/photometric/shift_evidence.h"
#include "stereo/photometric/shift_matching.h"

namespace uav_landing {

/// Small blocks of the left image that are compared, grey level by grey level, with the right image warped by
/// a plane. Each tells by how much the warp is off along its rows. Blind to a gain and an offset of its own
/// in each block, so to those of the cameras and to vignetting: what of the derivative by the shift looks
/// like a gain or an offset is taken out. Inverse compositional (Baker, Matthews 2004): derivatives are of
/// the left image, made once, and the shift found is put before the warp. Noise of the right image and of
/// the left one's derivatives are independent, so that interpolation does not pull towards whole pixels.
class PhotometricBlocks {
 public:
  static constexpr int kWidth = kBlockWidth, kHeight = kBlockHeight, kPixels = kBlockPixels;
  static constexpr int kTogether = 8;  ///< blocks in a row that may speak together
  static constexpr int kMargin = 2;  ///< pixels to the left and right that interpolation and derivatives read

  /// Masks of the rectified images (mono8), eroded by at least two pixels.
  PhotometricBlocks(cv::Mat left_mask, cv::Mat right_mask);

  /// Takes the blocks of most horizontal gradient, some from everywhere, among those that lie below the
  /// horizon of the shift model and whose places in the right image have picture. left: mono8.
  void choose(const cv::Mat& left, const StereoRig& rig, const ShiftModel& shift, int count);

  using Match = ShiftMatch;
  /// Compares the blocks with the right image (mono8) warped by the model: first order in the shift. Blocks
  /// with hardly more than noise are taken together with others in their row.
  void compare(const cv::Mat& right, const ShiftModel& shift, std::vector<Match>& matches);

 private:
  struct Candidate {
    int u, v;  // first pixel
    int energy;
    bool chosen;
  };
  struct Block : BlockTexture {
    int u, v;                  // first pixel
    float centre_u, centre_v;  // where its gradients are
  };
  // What the warped right image r has in common with a block.
  struct Products {
    const Block* block;
    double grey, slope;  // sums of grey r, slope r
    double variance;     // of r's grey levels beside the best gain and offset
    /// The same beside this gain and the best offset.
    double varianceAt(double gain) const;
  };
  // Of the right image over the left one; variance of the noise in one image, and of residuals that are only
  // noise.
  struct Photometry {
    double gain, noise, residual;
  };
  bool usable(const StereoRig& rig, const ShiftModel& shift, int u, int v) const;
  void findCandidates(const cv::Mat& left, const StereoRig& rig, const ShiftModel& shift);
  double usualEnergy() const;
  void pick(int count);
  static bool makeBlock(const cv::Mat& left, const Candidate& candidate, Block& block);
  void multiply(const cv::Mat& right, const ShiftModel& model);
  std::optional<Photometry> photometry() const;
  // None where the left image shows nothing but noise.
  std::optional<ShiftEvidence> evidenceOf(const Products& products, const Photometry& photometry) const;
  // variance: of the right image's grey levels beside gain, offset and shift.
  static bool looksAlike(const Products& products, const Photometry& photometry, double variance);

  cv::Mat left_mask_, right_mask_;
  int first_row_ = 0;
  double usual_energy_ = 0;  // of the candidates, the median: sum of slope^2, with its noise
  std::vector<Candidate> candidates_;
  std::vector<Block> blocks_;
  std::vector<Products> products_;
};

}  // namespace uav_landing
