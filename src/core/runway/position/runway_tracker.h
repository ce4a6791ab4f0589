#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "kernels/image/line_view.h"
#include "runway/direction/runway_direction.h"
#include "runway/position/runway_edges.h"
#include "uav_landing/image/rectification.h"
#include "uav_landing/parameters/approach_angle_parameters.h"
#include "uav_landing/parameters/runway_parameters.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Position over the runway from pair to pair. One pair alone may take other edges for the runway's, so a
/// position is told only after several pairs in a row that agree with the motion between them, and from then
/// on only edges where the motion says they must be are taken. All in multiples of the height, which needs no
/// stereo.
class RunwayTracker {
 public:
  /// Pairs in a row that must agree.
  static constexpr int kConfirmations = 3;

  RunwayTracker(const RigModel& rig, const ApproachAngleParameters& parameters,
                const RunwayParameters& runway = {});

  /// left: rectified image. approach: of this pair, with n, the vanishing direction and the step; direction:
  /// the lines it was found from. height: by stereo, m, or NaN; without it only the left view counts. rows:
  /// of the left image.
  ApproachAngleResult::Runway process(double stamp, const cv::Mat& left, const ApproachAngleResult& approach,
                                      const RunwayDirection& direction, double height,
                                      const StampMap& rows = {});
  /// A pair of which nothing is known but that the motion up to the next one does not begin before it.
  void skip(double stamp);
  void reset();
  /// Whether the pair before the one of this stamp has shown the runway where those before it did. Until then
  /// it also matters which lines are not there.
  bool isSettled(double stamp) const { return follows(stamp) && centre_.isSeen() && contradicted_ == 0; }

 private:
  /// A place on the ground followed over pairs: its distance from the camera along one axis.
  class Follower {
   public:
    /// scale: height before over height now. motion: along the axis, over the height now.
    void predict(double scale, double motion, double variance);
    /// Where it must be by what was seen before; none when nothing was.
    std::optional<ExpectedCentre> expected(double slack) const;
    /// Whether the measurement is confirmed by those before it.
    bool update(double value, double variance, double slack);
    void miss(double seconds, double patience);
    double value() const { return value_.value_or(0); }
    int confirmations() const { return confirmations_; }
    bool isSeen() const { return confirmations_ >= kConfirmations && missed_ == 0; }

   private:
    std::optional<double> value_;
    double variance_ = 0;
    int confirmations_ = 0;
    double missed_ = 0;  // s
  };

  /// Whether the pair before is near enough in time for what it has shown to count.
  bool follows(double stamp) const;
  /// Since the pair before, s; forgets that when it does not follow.
  double advance(double stamp);
  void predict(const GroundAxes* axes, const ApproachAngleResult::Motion& step);
  /// Edges along the runway that both views see, and those that at least one does.
  struct Edges {
    std::vector<GroundEdge> both, either;
  };
  Edges edgesOf(const GroundAxes& axes, const RunwayDirection& direction, double height) const;
  void findCentre(double seconds, const GroundAxes& axes, const RunwayDirection& direction, double height,
                  ApproachAngleResult::Runway& result);
  void findThresholdLine(double seconds, const cv::Mat& left, const StampMap& rows, const GroundAxes& axes,
                         ApproachAngleResult::Runway& result);

  void missAll(double seconds);
  void missCentre(double seconds);
  void forgetRunway();
  void followWidth(const RunwayCrossSection& seen, ApproachAngleResult::Runway& result);

  RigModel model_;
  ApproachAngleParameters parameters_;
  double known_width_;  // m; 0: unknown
  std::optional<double> last_stamp_;

  Follower centre_, threshold_;
  Follower width_, wider_;       // between the outermost edges; edges farther out that are not confirmed yet
  std::vector<LineGreys> rows_;  // memory for the view from above
  double contradicted_ = 0;      // s for which the pairs have told of another runway
};

}  // namespace uav_landing
