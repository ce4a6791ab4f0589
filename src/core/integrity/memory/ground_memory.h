#pragma once

#include <Eigen/Core>
#include <deque>
#include <optional>
#include <vector>

#include "geometry/plane_vector.h"
#include "uav_landing/geometry/calibration.h"
#include "uav_landing/geometry/ground_plane.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Remembers the nearest ground that was in view, and carries it along by the motion until the camera is
/// above it. So it knows the surface below where that is not the plane ahead. Where the ground was never in
/// view, nothing is known.
class GroundMemory {
 public:
  /// Carries the ground along by the motion since the pair before: a point is now at R x - t. t: m. T: s
  /// since that pair. A step that is several times as long as usual is wrong, and the usual speed replaces
  /// it.
  void move(const Eigen::Matrix3d& R, const Eigen::Vector3d& t, double T);
  /// Carries the ground along over a step whose motion is not known, at the usual speed. T: s. Once the next
  /// motion is known, the mean of the speeds before and after replaces that speed. R: rotation since the pair
  /// before as far as it is known. turn_stddev: 1 sigma of its pitch and roll, rad. normal: of the ground
  /// before, if known. doubted: only the rotation is doubted. After several unknown steps in a row the memory
  /// is emptied; steps whose rotation alone is doubted do not count.
  void coast(const Eigen::Matrix3d& R, double turn_stddev, double T,
             const std::optional<Eigen::Vector3d>& normal = std::nullopt, bool doubted = false);
  /// Corrects the rotation in pitch and roll over such steps, by the ground's normal now. turn_stddev: its 1
  /// sigma, rad. For doubted steps it may also be called after the next motions.
  void settleTurn(const Eigen::Vector3d& normal, double turn_stddev);
  /// A pair that shows the same image once more. The next motion contains this step.
  void wait();
  /// Remembers the nearest ground of a pair along the path. The path has the direction of the last moves
  /// together. plane: the ground's plane, freed of all known errors. measured: the plane of the points before
  /// that.
  void look(const StereoRig& rig, const std::vector<StereoDepthResult::Point>& points,
            const GroundPlane& plane, const PlaneVector& measured);

  struct Below {
    double height = 0, variance = 0;  ///< m, m^2
  };
  /// Height above the ground straight below, as it was when in view. normal: of the ground.
  std::optional<Below> below(const Eigen::Vector3d& normal) const;
  void reset() { *this = GroundMemory(); }

 private:
  struct Patch {
    Eigen::Vector3d at;      // m, camera frame now
    double information = 0;  // of all looks at its height, if their errors were independent, 1/m^2
    double reach = 0;        // distance to this side that the strip covers, m
    int looks = 1;           // pairs that have seen it
    double drift = 0;        // variance of its height by unknown steps, m^2
    double flown = 0;        // distance flown since the first look, m
    void add(const Patch& look);
    double variance() const;  // of its height, m^2
  };
  /// Steps in a row whose motion is not known.
  struct Gap {
    std::deque<Patch> patches;              // as they were before it
    Eigen::Vector3d path;                   // m, as it was before it
    std::optional<Eigen::Vector3d> normal;  // before it
    Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
    double turn_variance = 0, time = 0;  // rad^2, s
    size_t seen = 0;                     // number of patches seen since, at the end of the list
    bool doubted = false;
  };
  /// A gap whose rotation is doubted, with motions after it.
  struct Unsettled {
    std::deque<Patch> patches;                  // as they were before it
    Eigen::Vector3d normal;                     // before it
    Eigen::Vector3d speed_before, speed_after;  // m/s, in the frames before and after it
    double time;                                // s, of the gap
    double climb_variance;                      // m^2, of the climb over the gap
    size_t seen;  // number of patches seen since it began, at the end of the list
    Eigen::Matrix3d R = Eigen::Matrix3d::Identity();  // since the gap
    Eigen::Vector3d t = Eigen::Vector3d::Zero();
  };
  void remember(const Patch& look, const Eigen::Vector3d& ahead, double spacing);
  double climbVariance(double T) const;
  void replaceBefore(std::deque<Patch> patches, size_t seen);
  void settleLater(const Eigen::Vector3d& normal, double turn_stddev);
  void closeGap(const Eigen::Vector3d& speed_after, double usual_time);
  static void carry(std::deque<Patch>& patches, const Eigen::Matrix3d& R, const Eigen::Vector3d& step,
                    double turn_variance, double climb_variance);

  std::deque<Patch> patches_;           // nearest first
  std::optional<Gap> gap_;              // just before now
  std::optional<Unsettled> unsettled_;  // before that
  // m, over the last pairs, because a single one can be wrong.
  Eigen::Vector3d path_ = Eigen::Vector3d::Zero();
  double path_time_ = 0;  // s, that the path took
  double steps_ = 0;      // number of steps in the path
  int coasts_ = 0;        // unknown steps in a row
};

}  // namespace uav_landing
