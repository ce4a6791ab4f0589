#pragma once

#include <memory>
#include <opencv2/core.hpp>

#include "uav_landing/base/timings.h"
#include "uav_landing/image/rectification.h"
#include "uav_landing/parameters/stereo_depth_parameters.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

class CornerMatcher;

/// Stereo branch for one pair (paper 3.1): Harris corners, matching along the row, eq (3), ground plane. It
/// keeps the plane of the previous pair to predict where to search. It also keeps the vertical disparities of
/// some twenty pairs, and rows of the last images to recognise repeated ones. And it keeps the part of the
/// left image that does not move with the ground.
class StereoDepthStage {
 public:
  StereoDepthStage(const RigModel& rig, const StereoDepthParameters& parameters);
  /// Uses another matcher than the one along rows (src/core/stereo/matching/corner_matcher.h).
  StereoDepthStage(const RigModel& rig, const StereoDepthParameters& parameters,
                   std::unique_ptr<CornerMatcher> matcher);
  ~StereoDepthStage();
  StereoDepthStage(StereoDepthStage&&) noexcept;

  /// left, right: rectified mono8 of the rig's size. skew: stamp of the right image minus that of the left
  /// one, s. When the stamp does not increase, the search starts anew.
  StereoDepthResult process(double stamp, const cv::Mat& left, const cv::Mat& right, double skew = 0);
  /// Makes the stage as new.
  void reset();
  /// Share of the left image that does not move with the ground, such as the aircraft's nose. The next pair
  /// has no corners there.
  double ownFrame() const;
  const Timings& timings() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace uav_landing
