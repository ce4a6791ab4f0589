#include "stereo/plane/plane_rivals.h"

#include <cmath>

#include "image/input/image_check.h"
#include "stereo/matching/row_matching.h"
#include "stereo/matching/shift_model.h"

namespace uav_landing {

RivalPlane::RivalPlane(const StereoLevel& level, const std::vector<cv::Point>& corners,
                       const PlaneVector& plane, const StereoDepthParameters& parameters)
    : g(plane), correlation(corners.size(), -1) {
  constexpr int kSteps = 1;
  const ShiftModel shift(level.rig, g);
  const RowWarp warp = parameters.warp_window ? shift.forward() : RowWarp{};
  RowSearch search(level.left, level.right, parameters.window_radius, parameters.matching_cost);
  for (size_t i = 0; i < corners.size(); ++i) {
    const double column = corners[i].x - shift.at(corners[i].x, corners[i].y);
    if (!isSet(level.right_mask, column, corners[i].y)) continue;
    if (!search.run(corners[i].x, corners[i].y, column, kSteps, warp)) continue;
    correlation[i] = search.best(nullptr).score;
  }
}

bool RivalPlane::matchesBetterThan(const RivalPlane& other, int least) const {
  constexpr double kMatches = 0.6, kSigmas = 3.0;
  int both = 0, better = 0;
  for (size_t i = 0; i < correlation.size(); ++i) {
    if (correlation[i] < kMatches || other.correlation[i] < kMatches) continue;
    ++both;
    better += correlation[i] > other.correlation[i] ? 1 : 0;
  }
  return both >= least && 2 * better - both > kSigmas * std::sqrt(both);
}

}  // namespace uav_landing
