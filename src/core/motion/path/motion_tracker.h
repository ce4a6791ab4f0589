#pragma once

#include <deque>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "image/windows/match_image.h"
#include "motion/matching/temporal_matching.h"
#include "motion/path/path_angle_filter.h"
#include "motion/step/ego_motion.h"
#include "motion/step/step_search.h"
#include "uav_landing/base/timings.h"
#include "uav_landing/image/rectification.h"
#include "uav_landing/parameters/approach_angle_parameters.h"

namespace uav_landing {

/// How it is known that corners lie on the ground.
enum class GroundProof {
  kGiven,  ///< by their disparities, or they have a depth of their own; or it is assumed, as in the paper
  kMotion  ///< not beforehand: most of them have to move as the points of one plane do
};

struct StepConditions {
  GroundProof proof = GroundProof::kGiven;
  SearchTime time = SearchTime::kAmple;
  ReadoutEstimate readout = {};                                 ///< where none is given
  Eigen::Vector3d normal_by_readout = Eigen::Vector3d::Zero();  ///< derivative of the ground's normal, 1/s
};

/// Follows the motion of the left camera from frame to frame and over the last angle_window seconds.
/// Keeps the images of that time, the motion since each of them, and the last step as the next prediction.
class MotionTracker {
 public:
  MotionTracker(const RigModel& model, const ApproachAngleParameters& parameters);

  struct Result {
    ApproachAngleResult::Motion step, window;
    std::optional<MotionEstimate> step_estimate;
    ReadoutEffect readout;                 ///< by the longest of both, which tells a readout time best
    std::optional<CameraMotion> unproven;  ///< a step that may not be one over a plane
    std::optional<PathAngleFilter::Measurement> step_angle, window_angle;  ///< as far as they have one
  };

  /// normal: unit ground normal now with covariance (rank 2, without what a readout time makes of it);
  /// corners: of the left image now, with depths in units of the height. imu: its rotation since the frame
  /// before leads the search, helps where the corners leave the rotation uncertain, and makes up for half of
  /// the corners; one that contradicts them is left out. Without a ground normal call skip(). Corners that
  /// have to show by their motion that they are on the ground make a step fail (plane_unproven) when too few
  /// do.
  Result process(double stamp, const cv::Mat& left, const Eigen::Vector3d& normal,
                 const Eigen::Matrix3d& normal_covariance, const std::vector<TrackedCorner>& corners,
                 Timings& timings, const AttitudePrior& imu = {}, const StepConditions& conditions = {});
  /// Whether there is an earlier image, but no motion up to it that would lead on.
  bool needsSearch() const { return !past_.empty() && !last_step_; }
  /// How the camera moved at the last stamp, as far as it is known and not long before this one.
  std::optional<RowMotion> lastMotion(double stamp) const;
  /// Keeps the image for the next step although nothing can be said about the motion to it.
  void skip(double stamp, const cv::Mat& left);
  /// The image is the very one of the call before: nothing of the motion since, the next step is from when
  /// the image first came. The window's motion is what it was, its angle less certain the longer that was
  /// ago, and after angle_window, or with a stamp before it, there is none.
  Result repeat(double stamp) const;
  void reset();
  /// Corners followed to the frame before by the last process(), those that contradict the motion included.
  const std::vector<TemporalMatch>& stepMatches() const { return step_matches_; }

 private:
  struct Frame {
    double stamp = 0;
    MatchImage image;
    std::optional<CameraMotion> since;  ///< motion from then to now, when known
    std::optional<RowMotion> motion;    ///< while its rows were exposed
  };

  using Corners = std::vector<TrackedCorner>;
  ReadoutDoubt doubtOf(const StepConditions& conditions) const;
  Frame takeFrame(double stamp, const cv::Mat& left);
  void estimateStep(const Frame& now, const Eigen::Vector3d& normal, const Eigen::Matrix3d& covariance,
                    const Corners& corners, const RotationPrior* rotation, const StepConditions& conditions,
                    Result& result);
  std::vector<CameraMotion> predictions(double duration, const RotationPrior* rotation) const;
  void estimateWindow(const Frame& now, const Eigen::Vector3d& normal, const Eigen::Matrix3d& covariance,
                      const Corners& corners, const StepConditions& conditions, Result& result);
  void advance(Frame&& now, const Result& result);
  void smoothAngle(double stamp, Result& result);
  ApproachAngleResult::Motion describe(const Expected<MotionEstimate>& estimate, double duration,
                                       size_t matches, const ReadoutEstimate& readout,
                                       std::optional<PathAngleFilter::Measurement>& angle) const;

  StereoRig rig_;
  RowTimes times_, unit_times_;
  cv::Mat mask_;  // left, eroded by the window
  ApproachAngleParameters parameters_;
  StepSearch search_;
  std::deque<Frame> past_;         // oldest first
  std::vector<MatchImage> spare_;  // their memory is used again
  cv::Mat spare_coarse_;
  std::vector<TemporalMatch> step_matches_, window_matches_;  // kept, as they are large
  CornerTextures textures_;                                   // of the image now
  MotionSearchMemory memory_;
  std::optional<CameraMotion> last_step_;
  double last_duration_ = 0;  // s, of it
  double last_sink_ = 0;      // in it, in heights at its end
  ShakeMemory step_shake_, window_shake_;
  PathAngleFilter filter_;
  ApproachAngleResult::Motion last_window_;
  double last_rate_stddev_ = 0;  // of its angle, rad/s
};

}  // namespace uav_landing
