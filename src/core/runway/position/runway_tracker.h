#pragma once

#include <optional>
#include <vector>

#include "image/input/rectified_view.h"
#include "kernels/image/line_view.h"
#include "runway/direction/runway_direction.h"
#include "runway/edges/runway_edges.h"
#include "uav_landing/image/rectification.h"
#include "uav_landing/parameters/approach_angle_parameters.h"
#include "uav_landing/parameters/runway_parameters.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Follows the position over the runway from pair to pair. A single pair may take other edges for the
/// runway's. So a position is reported only after several pairs in a row that agree with the motion between
/// them. From then on, only edges where the motion predicts them are accepted. All lengths are in multiples
/// of the height, so stereo is not needed.
class RunwayTracker {
 public:
  /// Number of pairs in a row that must agree.
  static constexpr int kConfirmations = 3;

  RunwayTracker(const RigModel& rig, const ApproachAngleParameters& parameters,
                const RunwayParameters& runway = {});

  /// Processes one pair.
  /// - left: the rectified left image with the camera's whole mask and its row times.
  /// - approach: result of this pair, with its stamp, n and the step.
  /// - direction: vanishing direction and lines of this pair.
  /// - height: from stereo, m, or NaN. Without it only the left view is used.
  ApproachAngleResult::Runway process(const RectifiedView& left, const ApproachAngleResult& approach,
                                      const RunwayDirection& direction, double height);
  /// Call it for a pair without any result. The motion of the next pair must begin at this one.
  void skip(double stamp);
  void reset();
  /// Whether the pair before this stamp showed the runway at the same place as earlier pairs. Until then,
  /// missing lines are evidence, too.
  bool isSettled(double stamp) const { return follows(stamp) && centre_.isSeen() && contradicted_ == 0; }

 private:
  /// Follows one quantity on the ground over pairs, such as a distance from the camera along one axis.
  class Follower {
   public:
    /// scale: previous height over height now. motion: along the axis, over the height now.
    void predict(double scale, double motion, double variance);
    /// Range in which the next measurement must lie; nothing before the first one.
    std::optional<ExpectedCentre> expected(double slack) const;
    /// Adds a measurement. Returns whether earlier ones confirm it.
    bool update(double value, double variance, double slack);
    void miss(double seconds, double patience);
    double value() const { return value_.value_or(0); }
    int confirmations() const { return confirmations_; }
    bool isSeen() const { return confirmations_ >= kConfirmations && missed_ == 0; }

   private:
    std::optional<double> value_;
    double variance_ = 0;
    int confirmations_ = 0;
    double missed_ = 0;  // time without a measurement, s
  };

  /// Whether the previous pair is recent enough to be used.
  bool follows(double stamp) const;
  /// Returns the time since the previous pair, s. Resets the tracker when that pair is too old.
  double advance(double stamp);
  void predict(const GroundAxes* axes, const ApproachAngleResult::Motion& step);
  /// Edges along the runway: those that both views see, and those that at least one view sees.
  struct Edges {
    std::vector<GroundEdge> both, either;
  };
  Edges edgesOf(const GroundAxes& axes, const RunwayDirection& direction, double height) const;
  void findCentre(double seconds, const GroundAxes& axes, const RunwayDirection& direction, double height,
                  ApproachAngleResult::Runway& result);
  void findThresholdLine(double seconds, const RectifiedView& left, const GroundAxes& axes,
                         ApproachAngleResult::Runway& result);

  /// Follows lines that are half of a wider runway. Returns what was seen, or a refusal when it is such a
  /// half and its other half is out of sight.
  FoundRunway withoutKnownHalf(double seconds, FoundRunway seen);
  void missAll(double seconds);
  void missCentre(double seconds);
  void forgetRunway();
  void followWidth(const RunwayCrossSection& seen, ApproachAngleResult::Runway& result);

  RigModel model_;
  ApproachAngleParameters parameters_;
  double known_width_;  // from the chart, m; 0: unknown
  std::optional<double> last_stamp_;

  Follower centre_, threshold_;
  // Width between the outermost edges, and a larger one that is not confirmed yet.
  Follower width_, wider_;
  Follower half_;                // centre of lines that were half of a wider runway
  std::vector<LineGreys> rows_;  // memory for the view from above
  double contradicted_ = 0;      // s for which pairs have shown another runway
};

}  // namespace uav_landing
