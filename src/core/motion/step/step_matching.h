#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "image/windows/match_image.h"
#include "motion/matching/temporal_matching.h"
#include "motion/step/ego_motion.h"
#include "motion/step/readout_shift.h"
#include "uav_landing/parameters/approach_angle_parameters.h"

namespace uav_landing {

/// Memory that a search works in, kept from image to image.
struct MotionSearchMemory {
  MatchingMemory matching;
  MotionMemory motion;
};

/// What else is looked for in a pair, so that a search for its motion has more or less time.
enum class SearchTime {
  kAmple,  ///< nothing
  kShort,  ///< the runway
  kLeast   ///< the ground and the runway
};

/// Two images of the left camera, and what is known of the later one.
struct StepImages {
  const MatchImage &now, &then;
  double duration;                            ///< between the two, s
  const std::vector<TrackedCorner>& corners;  ///< of the image now
  CornerTextures& textures;
  MotionSearchMemory& memory;
  Eigen::Vector3d normal;                   ///< of the ground, unit, now
  Eigen::Matrix3d normal_covariance;        ///< rank 2
  const RotationPrior* rotation = nullptr;  ///< of an inertial sensor; may be none
  bool regular = false;                     ///< is hardly longer than the one before, see Steadiness
  SearchTime time = SearchTime::kAmple;
  const RowTimes* times = nullptr;          ///< of the left image's rows
  ShakeMemory* shake = nullptr;             ///< of steps
  ReadoutDoubt doubt = {};                  ///< where these are not given
  std::optional<RowMotion> rows_then = {};  ///< how the camera moved then, if that is known
};

/// Follows corners over a step from where a motion puts them, and estimates the motion from them.
class StepMatching {
 public:
  /// Fewest matches that make a motion good enough to search from.
  static constexpr int kFewestScouts = 6;

  /// mask: of the left image, eroded by the window.
  StepMatching(const StereoRig& rig, cv::Mat mask, const ApproachAngleParameters& parameters);

  /// coarse_steps: searched to both sides of the prediction at the coarse level; 0: it is good. list: one
  /// that is no longer needed, for its memory.
  std::vector<TemporalMatch> match(const StepImages& step, const std::vector<TrackedCorner>& corners,
                                   const CameraMotion& predicted, int coarse_steps,
                                   std::vector<TemporalMatch> list = {}) const;
  /// For a readout time that is not given, by the motion of the step.
  void shiftByReadout(const StepImages& step, const CameraMotion& motion,
                      std::vector<TemporalMatch>& matches) const;
  /// With the rotation that is known beforehand, where there is one that the matches do not contradict.
  /// fewest: matches that make a motion.
  Expected<MotionEstimate> estimate(const StepImages& step, const CameraMotion& start,
                                    const std::vector<TemporalMatch>& matches, int fewest) const;
  /// How much the corners look like what a motion leads to; see likenessOverTime().
  double likeness(const StepImages& step, const std::vector<TrackedCorner>& corners,
                  const CameraMotion& motion) const;
  /// Coarse steps of a search for what is hardly known.
  int wideSteps() const;

  const StereoRig& rig() const { return rig_; }

 private:
  TemporalMatchOptions options(const StepImages& step, const CameraMotion& predicted, int coarse_steps) const;
  /// While rows are exposed the camera moves as the predicted motion says.
  RowsOverTime rowsBy(const StepImages& step, const RowTimes* times, const CameraMotion& predicted) const;

  StereoRig rig_;
  cv::Mat mask_;
  ApproachAngleParameters parameters_;
};

}  // namespace uav_landing
