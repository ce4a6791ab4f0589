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

/// Small blocks of the left image that are compared by grey levels with the right image, which is warped by a
/// plane. Each block tells how far the warp is off along its rows. It is blind to gain and offset, and so to
/// vignetting: the parts of the derivative that look like a gain or an offset are taken out.
/// The method is inverse compositional (Baker, Matthews 2004): derivatives are those of the left image,
/// computed once, and the shift found is put before the warp. The noise of the right image is independent of
/// that of the left one's derivatives, so interpolation does not pull towards whole pixels.
class PhotometricBlocks {
 public:
  static constexpr int kWidth = kBlockWidth, kHeight = kBlockHeight, kPixels = kBlockPixels;
  static constexpr int kTogether = 8;  ///< blocks in a row that may be joined
  static constexpr int kMargin = 2;  ///< pixels to the left and right that interpolation and derivatives read

  /// Masks of the rectified images (mono8), eroded by at least two pixels.
  PhotometricBlocks(cv::Mat left_mask, cv::Mat right_mask);

  /// Takes the blocks with most horizontal gradient, some from everywhere. They lie below the horizon of the
  /// shift model, and their places in the right image are inside its mask. left: mono8.
  void choose(const cv::Mat& left, const StereoRig& rig, const ShiftModel& shift, int count);

  using Match = ShiftMatch;
  /// Compares the blocks with the right image (mono8) warped by the model, to first order in the shift.
  /// Blocks with hardly more than noise are joined with others of their row.
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
  // Products of a block with the warped right image r.
  struct Products {
    const Block* block;
    double grey, slope;  // sums of grey r, slope r
    double variance;     // of r's grey levels about the best gain and offset
    /// The same about this gain and the best offset.
    double varianceAt(double gain) const;
  };
  // Gain of the right image over the left one; variance of the noise in one image, and of residuals that are
  // noise only.
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
  // None when the left image shows only noise.
  std::optional<ShiftEvidence> evidenceOf(const Products& products, const Photometry& photometry) const;
  // variance: of the right image's grey levels about gain, offset and shift.
  static bool looksAlike(const Products& products, const Photometry& photometry, double variance);

  cv::Mat left_mask_, right_mask_;
  int first_row_ = 0;
  double usual_energy_ = 0;  // median over the candidates of the sum of slope^2, noise included
  std::vector<Candidate> candidates_;
  std::vector<Block> blocks_;
  std::vector<Products> products_;
};

}  // namespace uav_landing
