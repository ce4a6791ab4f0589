#pragma once

#include <Eigen/Core>
#include <optional>

#include "stereo/plane/plane_search.h"
#include "stereo/plane/plane_tracker.h"

namespace uav_landing {

/// The plane of a pair about which nothing is known, by a search that takes several pairs.
class SpreadSearch {
 public:
  SpreadSearch(const RigModel& model, int factor, const StereoDepthParameters& parameters,
               const PlaneLimits& limits);

  /// Before anything else of a pair. duration: since the pair before, s; infinite for the first one.
  void begin(double duration);
  /// The plane in this pair. As long as the search goes on it is not known why there is none, unless an
  /// earlier search has told. followed: time was spent in this pair on following a plane, in vain.
  Expected<Eigen::Vector3d> find(const StereoLevel& coarse, PlaneTracker& tracker, bool followed);
  /// The plane is known in this pair: there is nothing to search for.
  void stop();
  void reset();

 private:
  double budget(bool followed) const;
  void noteOverhead(bool seen);

  PlaneSearch search_;
  cv::Size size_;  // of the pictures
  bool at_once_;
  bool first_ = true;                          // no search has ended yet
  double duration_ = 0, duration_before_ = 0;  // s
  double age_ = 0;                             // of the pair that the search began with, s
  Failure not_found_;                          // by the last search; none before it
  std::optional<double> overhead_age_;         // since a plane was first seen above the horizon, s
  bool overhead_lasts_ = false;                // it was seen again, seconds later
};

}  // namespace uav_landing
