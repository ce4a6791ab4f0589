#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "base/steadiness.h"
#include "motion/step/first_step_search.h"
#include "motion/step/step_matching.h"
#include "uav_landing/parameters/approach_angle_parameters.h"

namespace uav_landing {

/// Finds the motion from one image to the next, either from predictions or without any.
class StepSearch {
 public:
  /// mask: of the left image, eroded by the window.
  StepSearch(const StereoRig& rig, cv::Mat mask, const ApproachAngleParameters& parameters);

  /// Finds the motion of the step. predictions: motions to try first, the best one first. matches: receives
  /// the corners that were followed, including those that contradict the motion; its memory is reused. Fails
  /// with not_yet while a search over several pairs goes on.
  Expected<MotionEstimate> find(const StepImages& step, const std::vector<CameraMotion>& predictions,
                                std::vector<TemporalMatch>& matches);
  /// Call it when the next step does not begin where this one ended.
  void interrupt() { first_.restart(); }
  /// Call it when other images come next. It forgets earlier searches.
  void reset() {
    first_.reset();
    steadiness_.lose();
  }

 private:
  /// Follows all corners at once with a narrow search. Fails when the result differs from the prediction.
  Expected<MotionEstimate> followSteadily(const StepImages& step, const CameraMotion& predicted,
                                          std::vector<TemporalMatch>& matches);
  double farthestOff(const StepImages& step, const CameraMotion& predicted, const MotionEstimate& found,
                     const std::vector<TemporalMatch>& matches) const;
  Expected<MotionEstimate> followFrom(const StepImages& step, const CameraMotion& predicted,
                                      std::vector<TemporalMatch>& matches) const;
  Expected<MotionEstimate> findMotion(const StepImages& step, const std::vector<CameraMotion>& predictions,
                                      std::vector<TemporalMatch>& matches);
  /// Searches for a motion that is not known at all. Fails while the search has to go on in the next pairs.
  Expected<MotionEstimate> findFirst(const StepImages& step, std::vector<TemporalMatch>& matches);
  bool isGood(const Expected<MotionEstimate>& estimate, const std::vector<TemporalMatch>& matches) const;

  StepMatching matching_;
  int min_matches_;
  FirstStepSearch first_;
  Steadiness steadiness_;
};

}  // namespace uav_landing
