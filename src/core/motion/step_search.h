#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "base/steadiness.h"
#include "image/match_image.h"
#include "motion/ego_motion.h"
#include "motion/temporal_matching.h"
#include "uav_landing/parameters/approach_angle_parameters.h"

namespace uav_landing {

/// Memory that a search works in, kept from image to image.
struct MotionSearchMemory {
  MatchingMemory matching;
  MotionMemory motion;
};

/// Two images of the left camera, and what is known of the later one.
struct StepImages {
  const MatchImage &now, &then;
  const std::vector<TrackedCorner>& corners;  ///< of the image now
  CornerTextures& textures;
  MotionSearchMemory& memory;
  Eigen::Vector3d normal;                   ///< of the ground, unit, now
  Eigen::Matrix3d normal_covariance;        ///< rank 2
  const RotationPrior* rotation = nullptr;  ///< of an inertial sensor; may be none
  bool regular = false;                     ///< is hardly longer than the one before, see Steadiness
  double duration = 0;                      ///< s
  const RowTimes* times = nullptr;          ///< of the left image's rows
  std::optional<RowMotion> rows_then = {};  ///< how the camera moved then, if that is known
};

/// Finds the motion from one image to the next: from where the last one leads, or without any idea of it.
class StepSearch {
 public:
  /// mask: of the left image, eroded by the window.
  StepSearch(const StereoRig& rig, cv::Mat mask, const ApproachAngleParameters& parameters);

  /// predictions: motions to try first. matches: the corners followed, those that contradict the motion
  /// included; its memory is used again.
  Expected<MotionEstimate> find(const StepImages& step, const std::vector<CameraMotion>& predictions,
                                std::vector<TemporalMatch>& matches);
  /// Other images come next: what earlier searches found does not matter.
  void reset() {
    unsure_ = 0;
    steadiness_.lose();
  }

 private:
  TemporalMatchOptions options(int coarse_steps) const;
  /// While rows are exposed the camera moves as the predicted motion says.
  RowsOverTime rowsBy(const StepImages& step, const CameraMotion& predicted) const;
  Expected<MotionEstimate> findMotion(const StepImages& step, const std::vector<CameraMotion>& predictions,
                                      std::vector<TemporalMatch>& matches);
  int wideSteps() const;  // of the coarse level, to both sides
  std::vector<TemporalMatch> match(const StepImages& step, const std::vector<TrackedCorner>& corners,
                                   const CameraMotion& predicted, int coarse_steps,
                                   std::vector<TemporalMatch> list = {}) const;
  /// By a narrow search for all corners at once; fails unless what it finds is as predicted.
  Expected<MotionEstimate> followSteadily(const StepImages& step, const CameraMotion& predicted,
                                          std::vector<TemporalMatch>& matches);
  double farthestOff(const StepImages& step, const CameraMotion& predicted, const MotionEstimate& found,
                     const std::vector<TemporalMatch>& matches) const;
  Expected<MotionEstimate> followFrom(const StepImages& step, const CameraMotion& predicted,
                                      std::vector<TemporalMatch>& matches) const;
  // fewest: matches that make a motion.
  Expected<MotionEstimate> estimate(const StepImages& step, const CameraMotion& start,
                                    const std::vector<TemporalMatch>& matches, int fewest) const;
  CameraMotion searchFirst(const StepImages& step, const Eigen::Matrix3d& R);
  CameraMotion mostAlike(const StepImages& step, const std::vector<CameraMotion>& guesses) const;

  StereoRig rig_;
  cv::Mat mask_;
  ApproachAngleParameters parameters_;
  int unsure_ = 0;  // searches in a row that few corners agreed with
  Steadiness steadiness_;
};

}  // namespace uav_landing
