#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "geometry/ground_normal.h"
#include "image/windows/match_image.h"
#include "motion/matching/temporal_matching.h"
#include "motion/step/ego_motion.h"
#include "motion/step/readout_shift.h"
#include "motion/step/row_rates.h"
#include "uav_landing/parameters/approach_angle_parameters.h"

namespace uav_landing {

/// Working memory of a search, kept from image to image.
struct MotionSearchMemory {
  MatchingMemory matching;
  MotionMemory motion;
};

/// Time that a search for the motion has, as other searches in the same pair need time, too.
enum class SearchTime {
  kAmple,  ///< no other search
  kShort,  ///< the runway is searched for, too
  kLeast   ///< the ground and the runway are searched for, too
};

/// Two images of the left camera, and what is known about the later one.
struct StepImages {
  const MatchImage &now, &then;
  double duration;                            ///< time between the two images, s
  const std::vector<TrackedCorner>& corners;  ///< of the image now
  MotionSearchMemory& memory;
  const RowRates& rates;                    ///< for this step
  GroundNormal normal;                      ///< of the ground now
  const RotationPrior* rotation = nullptr;  ///< from an inertial sensor; null: not known
  bool regular = false;  ///< the prediction still holds: hardly longer than the last step (see Steadiness)
  SearchTime time = SearchTime::kAmple;
  const RowTimes* times = nullptr;  ///< row times of the left image
  ReadoutDoubt doubt = {};          ///< when the readout time is not given
  RowDoubt row_doubt = {};
};

/// Follows corners over a step, starting where a motion predicts them, and estimates the motion from the
/// matches.
class StepMatching {
 public:
  /// Fewest matches that make a motion good enough to search from.
  static constexpr int kFewestScouts = 6;

  /// mask: of the left image, eroded by the window.
  StepMatching(const StereoRig& rig, cv::Mat mask, const ApproachAngleParameters& parameters);

  /// Matches the corners. coarse_steps: how far to search around the prediction at the coarse level; 0: the
  /// prediction is good enough. list: a list that is no longer needed, for its memory.
  std::vector<TemporalMatch> match(const StepImages& step, const std::vector<TrackedCorner>& corners,
                                   const CameraMotion& predicted, int coarse_steps,
                                   std::vector<TemporalMatch> list = {}) const;
  /// Shifts the matches by the estimated readout time, if no time is given. motion: of the step.
  void shiftByReadout(const StepImages& step, const CameraMotion& motion,
                      std::vector<TemporalMatch>& matches) const;
  /// Estimates the motion. The known rotation takes part unless the matches contradict it. fewest: number of
  /// matches that must agree.
  Expected<MotionEstimate> estimate(const StepImages& step, const CameraMotion& start,
                                    const std::vector<TemporalMatch>& matches, int fewest) const;
  /// Whether both motions carry rows to the stamps by turns that are alike, compared with what the turns may
  /// be off by.
  bool carryRowsAlike(const StepImages& step, const CameraMotion& a, const CameraMotion& b) const;
  /// Similarity of the corners to the places where the motion puts them; see likenessOverTime().
  double likeness(const StepImages& step, const std::vector<TrackedCorner>& corners,
                  const CameraMotion& motion) const;
  /// Coarse steps of a wide search, for a motion that is hardly known.
  int wideSteps() const;

  const StereoRig& rig() const { return rig_; }

 private:
  TemporalMatchOptions options(int coarse_steps) const;
  CameraFrames framesOf(const StepImages& step) const { return {rig_, step.now, step.then, mask_}; }
  /// The motion with velocities for these row times. While rows are exposed, the camera moves as the motion
  /// says.
  MotionOverGround overGround(const StepImages& step, const CameraMotion& motion,
                              const RowTimes* times) const;
  MotionPrior priorOf(const StepImages& step, const CameraMotion& start, const RotationPrior* rotation) const;

  StereoRig rig_;
  cv::Mat mask_;
  ApproachAngleParameters parameters_;
};

}  // namespace uav_landing
