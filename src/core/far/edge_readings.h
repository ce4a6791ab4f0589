#pragma once

#include <array>
#include <optional>

#include "far/outline_fit.h"

namespace uav_landing {

/// What else a runway's outline may be than the best fit says, from pair to pair.
///
/// A stripe along an edge that is narrower than a pixel moves the edge that shows by its width times its
/// contrast over the surface's. So an outline with stripes and one without explain the same image, metres
/// apart. The image decides where stripes would outshine the surface. Elsewhere it hardly tells, until the
/// runway is near, and what is usual counts.
/// Bars, and strips of ground that are as dark as the runway, hold an end where it is not. So each pair also
/// fits an outline with an end from another place.
///
/// The outline that is returned is the mean of all that is possible, with a covariance that holds it.
class EdgeReadings {
 public:
  struct Outline {
    FittedOutline fitted;
    Corners corners;  ///< by the best fit, px: where the next pair begins
  };
  /// start: corners of the pair before.
  Expected<Outline> fit(const cv::Mat& image, const cv::Mat& mask, const Corners& start,
                        const OutlineLook& look);

 private:
  struct Reading {
    FittedOutline outline;
    EdgePaint paint;  // kUnknown: fitted without stripes, but there may be some
  };
  /// A less likely outline.
  struct Rival {
    Vector8d offset;  // from the best one, px
    Matrix8d covariance;
    double excess;  // of -2 log probability over the best one's
  };
  static constexpr int kRivals = 6;  // ends from other places
  static Expected<Reading> read(OutlineFitter& fitter, const Corners& start, const OutlineLook& look);
  void tryEnd(OutlineFitter& fitter, Reading& reading);
  void tellFrom(const Rival& winner);
  FittedOutline mean(const FittedOutline& best) const;
  Rival withStripes(OutlineFitter& fitter, const FittedOutline& plain, const OutlineLook& look);

  std::array<std::optional<Rival>, kRivals> rivals_;  // as they were last fitted
  int turn_ = 0;
  double stripes_excess_ = 0;  // of outlines with stripes over those without, mean of the last pairs
  int compared_ = 0;           // pairs in that mean
};

}  // namespace uav_landing
