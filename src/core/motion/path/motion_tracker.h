#pragma once

#include <deque>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "geometry/ground_normal.h"
#include "image/windows/match_image.h"
#include "motion/matching/temporal_matching.h"
#include "motion/path/motion_description.h"
#include "motion/path/path_angle_filter.h"
#include "motion/step/ego_motion.h"
#include "motion/step/step_search.h"
#include "uav_landing/base/timings.h"
#include "uav_landing/image/rectification.h"
#include "uav_landing/parameters/approach_angle_parameters.h"

namespace uav_landing {

/// Evidence that corners lie on the ground.
enum class GroundProof {
  kGiven,  ///< by disparity, or corners have a depth of their own, or it is assumed as in the paper
  kMotion  ///< not known beforehand: most corners must move like points of one plane
};

/// The ground in the left image now.
struct GroundInView {
  GroundNormal normal;  ///< its covariance leaves out the error by the readout time
  Eigen::Vector3d normal_by_readout = Eigen::Vector3d::Zero();  ///< derivative of the normal, 1/s
  const std::vector<TrackedCorner>& corners;                    ///< with depths in units of the height
};

struct StepConditions {
  GroundProof proof = GroundProof::kGiven;
  SearchTime time = SearchTime::kAmple;
  /// The readout time so far, when it has to be estimated.
  ReadoutEstimate readout = {};
  /// The rotation since the previous frame leads the search and helps when the corners leave the rotation
  /// uncertain. With it, half as many corners are enough. It is rejected when it contradicts them.
  AttitudePrior imu = {};
};

/// Follows the motion of the left camera over each frame step and over the sliding window (angle_window). It
/// keeps the images of that time and the motion since each of them. The last step is the prediction for the
/// next one.
class MotionTracker {
 public:
  MotionTracker(const RigModel& model, const ApproachAngleParameters& parameters);

  struct Result {
    ApproachAngleResult::Motion step, window;
    std::optional<MotionEstimate> step_estimate;
    StepEnds ends;          ///< of the step, when there is an estimate
    ReadoutEffect readout;  ///< of the frame step
    /// Motion of the step when its corners failed to prove that they are on a plane.
    std::optional<CameraMotion> unproven;
    /// Approach angles as measurements for the filter, when there are any.
    std::optional<PathAngleFilter::Measurement> step_angle, window_angle;
  };

  /// Estimates the motion from the earlier frames to this one.
  ///
  /// When the corners have to prove the plane by their motion and too few do, the step fails with
  /// plane_unproven. Without a ground normal, call skip() instead.
  Result process(double stamp, const cv::Mat& left, const GroundInView& seen, Timings& timings,
                 const StepConditions& conditions = {});
  /// Whether there is an earlier image but no motion up to it, so that the next step has no prediction.
  bool needsSearch() const { return !past_.empty() && !last_step_; }
  /// Velocities of the camera at this stamp (s), as the last step or the inertial sensor lets expect them.
  /// Nothing when the last step is not known or too old.
  std::optional<RowMotion> lastMotion(double stamp, const AttitudePrior& imu) const;
  /// What the last motions show of vibration. With a rolling shutter it turns the rows of an image. Nothing
  /// when they are a second old at this stamp (s).
  Vibration vibration(double stamp) const;
  /// Keeps the image for the next step when no motion can be estimated to it.
  void skip(double stamp, const cv::Mat& left, const AttitudePrior& imu = {});
  /// Call it instead of process() for an image that is the same as in the previous call. There is no step;
  /// the next one starts at the stamp at which the image first came. The window keeps its motion, and its
  /// angle becomes less certain with time. It fails when the image is older than angle_window or the stamp is
  /// not later.
  Result repeat(double stamp) const;
  void reset();
  /// Call it when a readout time begins to be estimated. What counted as shake so far may have been that, and
  /// angles so far do not claim its error.
  void forgetRows();
  /// Corners that the last process() followed to the previous frame, including those that contradict the
  /// motion.
  const std::vector<TemporalMatch>& stepMatches() const { return step_matches_; }

 private:
  struct Frame {
    double stamp = 0;
    MatchImage image;
    std::optional<CameraMotion> since;  ///< motion from then to now, when it is known
    std::optional<RowMotion> motion;    ///< velocities while its rows were exposed
  };

  ReadoutDoubt doubtOf(const StepConditions& conditions) const;
  bool mayRoll() const { return !times_.atOnce() || !unit_times_.atOnce(); }
  bool rolls(const ReadoutEstimate& readout) const;
  ShakeWatch watchOf(ShakeMemory& memory, const ReadoutEstimate& readout) const;
  RowDoubt rowDoubt(double duration, ShakeMemory& memory, const GroundInView& seen,
                    const ReadoutEstimate& readout) const;
  Frame takeFrame(double stamp, const cv::Mat& left);
  void estimateStep(const Frame& now, const GroundInView& seen, const StepConditions& conditions,
                    Result& result);
  std::vector<CameraMotion> predictions(double duration, const RotationPrior* rotation) const;
  void estimateWindow(const Frame& now, const GroundInView& seen, const StepConditions& conditions,
                      Result& result);
  void advance(Frame&& now, const Result& result);
  void smoothAngle(double stamp, Result& result);
  MotionFacts factsOf(double duration, const std::vector<TemporalMatch>& matches,
                      const ReadoutEstimate& readout) const;

  StereoRig rig_;
  RowTimes times_, unit_times_;
  cv::Mat mask_;  // of the left image, eroded by the window
  ApproachAngleParameters parameters_;
  StepSearch search_;
  std::deque<Frame> past_;         // oldest first
  std::vector<MatchImage> spare_;  // images no longer used, kept for their memory
  cv::Mat spare_coarse_;
  std::vector<TemporalMatch> step_matches_, window_matches_;  // kept for their memory
  MotionSearchMemory memory_;
  std::optional<CameraMotion> last_step_;
  double last_duration_ = 0;  // of last_step_, s
  double last_sink_ = 0;      // n.t of last_step_, in heights at its end
  RowRates rates_;
  struct Shake {
    ShakeMemory step, window;
    Vibration found;                    // by the last step, or by the window when it is larger there
    double stamp = 0;                   // of that step, s
    std::optional<double> window_then;  // stamp of the image that the window began with, s
  } shake_;
  PathAngleFilter filter_;
  ApproachAngleResult::Motion last_window_;
  double last_rate_stddev_ = 0;  // of the window's angle, rad/s
};

}  // namespace uav_landing
