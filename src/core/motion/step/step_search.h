#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "base/steadiness.h"
#include "motion/step/first_step_search.h"
#include "motion/step/step_matching.h"
#include "uav_landing/parameters/approach_angle_parameters.h"

namespace uav_landing {

/// Finds the motion from one image to the next: from where the last one leads, or without any idea of it.
class StepSearch {
 public:
  /// mask: of the left image, eroded by the window.
  StepSearch(const StereoRig& rig, cv::Mat mask, const ApproachAngleParameters& parameters);

  /// predictions: motions to try first. matches: the corners followed, those that contradict the motion
  /// included; its memory is used again.
  Expected<MotionEstimate> find(const StepImages& step, const std::vector<CameraMotion>& predictions,
                                std::vector<TemporalMatch>& matches);
  /// The next step does not begin where this one ended.
  void interrupt() { first_.restart(); }
  /// Other images come next: what earlier searches found does not matter.
  void reset() {
    first_.reset();
    steadiness_.lose();
  }

 private:
  /// By a narrow search for all corners at once; fails unless what it finds is as predicted.
  Expected<MotionEstimate> followSteadily(const StepImages& step, const CameraMotion& predicted,
                                          std::vector<TemporalMatch>& matches);
  double farthestOff(const StepImages& step, const CameraMotion& predicted, const MotionEstimate& found,
                     const std::vector<TemporalMatch>& matches) const;
  Expected<MotionEstimate> followFrom(const StepImages& step, const CameraMotion& predicted,
                                      std::vector<TemporalMatch>& matches) const;
  Expected<MotionEstimate> findMotion(const StepImages& step, const std::vector<CameraMotion>& predictions,
                                      std::vector<TemporalMatch>& matches);
  /// With nothing known of it; fails as long as the search for it goes on in other pairs.
  Expected<MotionEstimate> findFirst(const StepImages& step, std::vector<TemporalMatch>& matches);
  bool isGood(const Expected<MotionEstimate>& estimate, const std::vector<TemporalMatch>& matches) const;

  StepMatching matching_;
  int min_matches_;
  FirstStepSearch first_;
  Steadiness steadiness_;
};

}  // namespace uav_landing
