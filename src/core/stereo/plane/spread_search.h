#pragma once

#include <Eigen/Core>
#include <optional>

#include "geometry/plane_vector.h"
#include "stereo/plane/plane_search.h"
#include "stereo/plane/plane_tracker.h"

namespace uav_landing {

/// Finds the plane of a pair when nothing is known, by a search that takes several pairs.
class SpreadSearch {
 public:
  SpreadSearch(const RigModel& model, int factor, const StereoDepthParameters& parameters,
               const PlaneLimits& limits);

  /// Call it first for each pair. duration: since the previous pair, s; infinite for the first one.
  void begin(double duration);
  /// The plane in this pair. While the search goes on, the failure is that of the last search that failed,
  /// else `not_yet`. followed: this pair has already spent time on following a plane, in vain.
  Expected<PlaneVector> find(const StereoLevel& coarse, PlaneTracker& tracker, bool followed);
  /// The plane is known in this pair, so there is nothing to search for.
  void stop();
  void reset();

 private:
  double budget(bool followed) const;
  void noteOverhead(bool seen);

  PlaneSearch search_;
  cv::Size size_;  // of the images
  bool at_once_;
  bool first_ = true;                          // no search has ended yet
  double duration_ = 0, duration_before_ = 0;  // s
  double age_ = 0;                             // since the pair that the search began with, s
  Failure not_found_;                          // of the last search; none before it
  std::optional<double> overhead_age_;         // since a plane was first seen above the horizon, s
  bool overhead_lasts_ = false;                // it was seen again, seconds later
};

}  // namespace uav_landing
