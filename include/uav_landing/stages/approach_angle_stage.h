#pragma once

#include <memory>
#include <opencv2/core.hpp>

#include "uav_landing/base/timings.h"
#include "uav_landing/image/rectification.h"
#include "uav_landing/parameters/approach_angle_parameters.h"
#include "uav_landing/parameters/runway_parameters.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Monocular branch for one pair (paper 2): lines, vanishing points, ground normal, motion, FOE, angle. It
/// keeps the images of the last angle_window seconds, the path so far, and what is known about the runway.
class ApproachAngleStage {
 public:
  ApproachAngleStage(const RigModel& rig, const ApproachAngleParameters& parameters,
                     const RunwayParameters& runway = {});
  ~ApproachAngleStage();
  ApproachAngleStage(ApproachAngleStage&&) noexcept;

  /// left, right: rectified mono8 of the rig's size. stereo: result of the same pair, ignored when use_stereo
  /// is false. imu: of the same pair, ignored when use_imu is false. When the stamp does not increase, the
  /// stage forgets the past.
  ApproachAngleResult process(double stamp, const cv::Mat& left, const cv::Mat& right,
                              const StereoDepthResult& stereo, const AttitudePrior& imu = {});
  void reset();
  const Timings& timings() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace uav_landing
