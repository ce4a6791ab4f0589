#include "runway/threshold/runway_threshold.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "base/text.h"
#include "runway/threshold/runway_top_view.h"
#include "runway/threshold/threshold_bars.h"
#include "runway/threshold/threshold_line.h"

namespace uav_landing {
namespace {

constexpr double kShortestBars = 0.2;  // share of the width
constexpr double kLineSearch = 0.3;    // share of the width, before the bars
constexpr double kLocation = 0.5;      // px, 1 sigma of an edge across the runway
// Bars begin 6 m behind the threshold and are 3.5 m apart (ICAO Annex 14; FAA AC 150/5340-1). On runways that
// follow no standard, they may begin closer to the threshold.
// Largest distance of the bars behind the threshold, in pitches of the bars.
constexpr double kFarthestBars = 1.9;
constexpr double kSearched = 1.3;     // searched distance before the bars, as a multiple of the farthest
constexpr double kPitchError = 0.05;  // 1 sigma as a share of the pitch

template <class... Parts>
tl::unexpected<Failure> noThreshold(const Parts&... parts) {
  return tl::make_unexpected(Failure{Reason::kNoRunway, text(parts...)});
}

}  // namespace

Expected<Threshold> findThreshold(const RectifiedView& image, const StereoRig& rig, const GroundAxes& axes,
                                  const RunwayCrossSection& runway, std::vector<LineGreys>& memory) {
  const TopView view(image, rig, axes, runway, memory);
  const std::optional<ThresholdBars> bars = findThresholdBars(view);
  if (!bars) return noThreshold("no threshold bars in the image");
  const double begin = view.distance(bars->begin);
  if (view.distance(bars->end) - begin < kShortestBars * runway.width)
    return noThreshold("bars of the threshold are too short");
  // The place of a line before the bars must be in the image. Otherwise the bars alone say nothing about the
  // threshold.
  const double pitch = bars->pitch / TopView::kColumns * TopView::kAcross * runway.width;
  const double farthest = kFarthestBars * pitch;
  const double search = begin - std::max(kLineSearch * runway.width, kSearched * farthest);
  int first = 0;
  while (first < view.size() && view.distance(first) < search) ++first;
  if (first == 0) return noThreshold("what lies before the threshold bars is not in the image");
  const ThresholdLine line = findThresholdLine(view, *bars, first);
  std::optional<double> seen;
  if (line.spans()) {
    seen = line.station;
  } else {
    while (view.distance(first) < begin - kSearched * farthest) ++first;
    seen = findPavement(view, *bars, pitch, first);
  }
  if (!seen && line.isSomething())
    return noThreshold("a mark before the bars takes ", line.spanning, " of the width");
  const double station = seen.value_or(bars->begin);
  Threshold threshold;
  threshold.distance = view.distance(station);
  const Eigen::Vector3d by_rotation =
      GroundAxes::meetByRotation({threshold.distance, runway.centre}).row(0).transpose();
  threshold.variance =
      std::pow(kLocation * view.footprint(station), 2) + by_rotation.dot(axes.covariance * by_rotation);
  if (!seen) {
    // The threshold may be at the bars, or as far before them as they ever begin. The standard deviation
    // covers both.
    threshold.distance -= 0.5 * farthest;
    threshold.systematic_variance = std::pow(0.5 * farthest, 2);
    threshold.variance += threshold.systematic_variance + std::pow(kPitchError * farthest, 2);
  }
  return threshold;
}

}  // namespace uav_landing
