#pragma once

#include <Eigen/Core>
#include <deque>
#include <optional>
#include <vector>

#include "uav_landing/geometry/calibration.h"
#include "uav_landing/geometry/ground_plane.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// The nearest ground that was in view, carried along by the motion until the camera is above it: what the
/// surface below is, where it is not that of the plane ahead. Where the ground never was in view nothing is
/// known.
class GroundMemory {
 public:
  /// Motion since the pair before, T ago: a point is at R x - t now. t: m; at the usual speed for a step that
  /// is several times as long.
  void move(const Eigen::Matrix3d& R, const Eigen::Vector3d& t, double T);
  /// A step of which the motion is not known, over T: at the usual speed; once the next motion is known, at
  /// the mean of the speeds before and after. R: rotation since the pair before as far as it is known, its
  /// error in pitch and roll: 1 sigma, rad. normal: of the ground before, where known. Some such steps in a
  /// row, and nothing is known, but for those of which only the rotation is doubted.
  void coast(const Eigen::Matrix3d& R, double turn_stddev, double T,
             const std::optional<Eigen::Vector3d>& normal = std::nullopt, bool doubted = false);
  /// After such steps, and for doubted ones also after the next motions: the ground's normal now, which tells
  /// their rotation in pitch and roll to 1 sigma, rad.
  void settleTurn(const Eigen::Vector3d& normal, double turn_stddev);
  /// A step that the next motion has in it, as the pair shows the same picture once more.
  void wait();
  /// Remembers the nearest ground of a pair along the path. plane: the ground's, freed of all errors that are
  /// known; measured: the plane of the points before that. Where the path goes is the direction of
  /// the last moves together.
  void look(const StereoRig& rig, const std::vector<StereoDepthResult::Point>& points,
            const GroundPlane& plane, const Eigen::Vector3d& measured);

  struct Below {
    double height = 0, variance = 0;  ///< m, m^2
  };
  /// The height above the ground straight below, as it was when in view. normal: of the ground.
  std::optional<Below> below(const Eigen::Vector3d& normal) const;
  void reset() { *this = GroundMemory(); }

 private:
  struct Patch {
    Eigen::Vector3d at;      // m, camera frame now
    double information = 0;  // of all looks at its height, were their errors independent, 1/m^2
    double reach = 0;        // of the strip to this side of it, m
    int looks = 1;           // pairs that have seen it
    double drift = 0;        // variance by steps that are not known, m^2
    double flown = 0;        // since the first look, m
    void add(const Patch& look);
    double variance() const;  // of its height, m^2
  };
  /// Steps in a row of which the motion is not known.
  struct Gap {
    std::deque<Patch> patches;              // as they were before it
    Eigen::Vector3d path;                   // m, as it was before it
    std::optional<Eigen::Vector3d> normal;  // before it
    Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
    double turn_variance = 0, time = 0;  // rad^2, s
    size_t seen = 0;                     // patches since, the last ones
    bool doubted = false;
  };
  /// A gap of doubted rotation that motions have followed.
  struct Unsettled {
    std::deque<Patch> patches;                        // as they were before it
    Eigen::Vector3d normal;                           // before it
    Eigen::Vector3d speed_before, speed_after;        // m/s, in the frames before and after it
    double time;                                      // s, of it
    double climb_variance;                            // m^2, of that
    size_t seen;                                      // patches since it began, the last ones
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

  std::deque<Patch> patches_;                       // nearest first
  std::optional<Gap> gap_;                          // just before now
  std::optional<Unsettled> unsettled_;              // before that
  Eigen::Vector3d path_ = Eigen::Vector3d::Zero();  // m, over the last pairs: a single one can be wrong
  double path_time_ = 0;                            // s, that the path took
  double steps_ = 0;                                // that the path is of
  int coasts_ = 0;                                  // steps in a row that are not known
};

}  // namespace uav_landing
