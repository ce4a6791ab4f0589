#pragma once

#include <array>
#include <optional>

#include "far/outline_fit.h"

namespace uav_landing {

/// Two readings of a runway's edges from pair to pair: as the outsides of painted stripes, and as the edges
/// of a surface without any.
///
/// A stripe that is narrower than a pixel moves the edge that shows by its width times its contrast over the
/// surface's. So both readings explain the same image from afar, metres apart. Each pair fits the better one,
/// and by turns the other one or an end from another place. The outline that is returned is their
/// mean, with a covariance that holds both.
class EdgeReadings {
 public:
  struct Outline {
    FittedOutline fitted;
    Corners corners;  ///< by the better reading, px: where the next pair begins
  };
  /// start: corners of the pair before.
  Expected<Outline> fit(const cv::Mat& image, const cv::Mat& mask, const Corners& start,
                        const OutlineLook& look);

 private:
  /// A less likely outline, as it was last fitted.
  struct Rival {
    Vector8d offset;  // from the best one, px
    Matrix8d covariance;
    double excess;  // of -2 log probability over the best one's
  };
  static constexpr int kRivals = 7;  // the other paint, and ends from other places
  void compare(OutlineFitter& fitter, const OutlineLook& look, FittedOutline& best);
  void tellFrom(const Rival& winner);
  FittedOutline mean(const FittedOutline& best, const OutlineLook& look) const;

  EdgePaint paint_ = EdgePaint::kStripes;  // of the best outline
  std::array<std::optional<Rival>, kRivals> rivals_;
  int turn_ = 0;
};

}  // namespace uav_landing
