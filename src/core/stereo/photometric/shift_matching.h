#pragma once

#include <array>
#include <utility>
#include <vector>

#include "stereo/photometric/shift_evidence.h"

namespace uav_landing {

/// Shift between the left image and the warped right one, from a block that shows more than noise or from
/// several.
struct ShiftMatch {
  double u, v;    ///< where the gradients are in the left image, pixels
  double shift;   ///< shift of the left image, in left pixels, that makes it fit the warped right one
  double stddev;  ///< if the residuals of the pixels are independent, pixels
  double lean;    ///< growth of the shift when the right image lies a pixel higher, due to slanted edges
  int blocks;     ///< number of blocks in it
  bool certain;   ///< whether their signal is beyond doubt
  bool alike;     ///< whether the right image shows them; else the shift means nothing
};

/// Turns the evidence of blocks into matches. Weak blocks of a section of a row are joined until they are
/// certain or the section ends. Alone, the shift of each would be the ratio of two numbers that are mostly
/// noise. Blocks that the right image shows are kept apart from those that it does not.
class ShiftMatching {
 public:
  /// gain: of the right image over the left one. section: width of a section, pixels.
  ShiftMatching(double gain, int section, std::vector<ShiftMatch>& matches)
      : gain_(gain), width_(section), matches_(matches) {}

  /// Adds a block; blocks come row by row. alike: whether the right image shows the block whose first pixel
  /// is (u, v).
  void add(const ShiftEvidence& evidence, bool alike, int u, int v);
  /// Call it after the last block.
  void finish();

 private:
  using Section = std::pair<int, int>;
  void endSection();
  void tellWeak(bool alike);
  void tell(const ShiftEvidence& evidence, bool alike);

  double gain_;
  int width_;
  std::vector<ShiftMatch>& matches_;
  Section section_{};
  std::array<ShiftEvidence, 2> weak_;  // of blocks that do not look alike, and of those that do
};

}  // namespace uav_landing
