#pragma once

#include <array>
#include <utility>
#include <vector>

#include "stereo/photometric/shift_evidence.h"

namespace uav_landing {

/// What a block that shows more than noise, or several together, say of the shift between left image and
/// warped right one.
struct ShiftMatch {
  double u, v;    ///< where in the left image the gradients are, pixels
  double shift;   ///< left pixels by which the left image is to be shifted to fit the warped right one
  double stddev;  ///< of it if the residuals of the pixels are independent, pixels
  double lean;    ///< by how much the shift grows where the right image lies a pixel higher: slanted edges
  int blocks;     ///< that say so
  bool certain;   ///< whether their signal is beyond doubt
  bool alike;     ///< whether the right image shows them: of others the shift means nothing
};

/// Makes matches of what the blocks tell. Weak ones of a section of a row speak together, until they are
/// certain or the section ends: the shift of each alone would be the ratio of two numbers that are mostly
/// noise. Those that the right image shows and those that it does not are kept apart.
class ShiftMatching {
 public:
  /// gain: of the right image over the left one. section: width of a section, pixels.
  ShiftMatching(double gain, int section, std::vector<ShiftMatch>& matches)
      : gain_(gain), width_(section), matches_(matches) {}

  /// Blocks come row by row. alike: whether the right image shows the block whose first pixel is (u, v).
  void add(const ShiftEvidence& evidence, bool alike, int u, int v);
  /// After the last block.
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
  std::array<ShiftEvidence, 2> weak_;  // of those that do not look alike, and of those that do
};

}  // namespace uav_landing
