#pragma once

#include <Eigen/Core>
#include <cmath>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "base/steadiness.h"
#include "geometry/plane_limits.h"
#include "image/match_image.h"
#include "stereo/matching/corner_matcher.h"
#include "stereo/matching/stereo_level.h"
#include "uav_landing/base/timings.h"
#include "uav_landing/parameters/stereo_depth_parameters.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Where the ground is expected in a pair, by the pairs before it. Planes are plane vectors, 1/m.
class PlaneTracker {
 public:
  /// corner_count: corners looked for in an image. matcher: finds them; outlives this.
  PlaneTracker(const StereoRig& rig, const StereoDepthParameters& parameters, const PlaneLimits& limits,
               int corner_count, CornerMatcher& matcher);

  /// Before anything else of a pair, with its stamp in seconds. When that is not after the last one all is
  /// forgotten.
  void begin(double stamp);
  void forget();
  /// This pair has no plane: one does not make the last plane a bad guess, many do.
  void miss();
  /// The plane of this pair, for the next one to follow. certain: nothing speaks against it.
  void remember(const StereoDepthResult& result, bool certain);

  bool hasLast() const { return has_last_; }
  /// By how much the plane changes, by the last pairs, 1/m/s; 0 while that is not known.
  const Eigen::Vector3d& steadyRate() const { return steady_rate_; }
  /// Since the pair before, s; infinite for the first one.
  double duration() const { return duration_; }
  /// The plane as it moves on from the pairs before, where it has been where they led: good enough for all
  /// corners to be matched by, without a search for it by a few. Every so often there is none nevertheless.
  std::optional<Eigen::Vector3d> steadyPlane(Timings& timings);
  /// Whether what was matched by that bears it out.
  bool bearsOut(const StereoDepthResult& result) const;
  /// A plane good to about a pixel of disparity, by a few corners where they agree, or by more at the coarse
  /// level. factor: of that level.
  std::optional<Eigen::Vector3d> follow(const StereoLevel& fine, const StereoLevel& coarse, int factor,
                                        Timings& timings);
  /// The same from a plane that a pair shortly before had. reach: in search radii.
  std::optional<Eigen::Vector3d> followFrom(const Eigen::Vector3d& g, const StereoLevel& coarse,
                                            double reach = 1);
  /// Corners on the ground of this plane: those found before, as long as the horizon has hardly moved.
  std::vector<cv::Point> cornersOn(const StereoLevel& fine, const Eigen::Vector3d& g, Timings& timings);

  /// Rows from which on windows on the ground of this plane may reach, and of the last one, with room for
  /// what it moved.
  FirstRows groundRows(const Eigen::Vector3d& g) const;
  FirstRows lastGroundRows() const;

 private:
  double farthestOff(const StereoDepthResult& result) const;
  FirstRows rowsOf(const Eigen::Vector3d& g, double slack) const;

  StereoRig rig_;
  StereoDepthParameters parameters_;
  PlaneLimits limits_;
  int corner_count_;
  CornerMatcher& matcher_;
  double stamp_ = -INFINITY, duration_ = 0;  // of this pair, and since the one before, s
  bool has_last_ = false;
  Eigen::Vector3d last_ = Eigen::Vector3d::Zero(), rate_ = Eigen::Vector3d::Zero();  // of it, by second
  Eigen::Vector3d steady_rate_ = Eigen::Vector3d::Zero();                            // mean of the last ones
  double last_stamp_ = 0;
  int failures_ = 0;                                    // pairs in a row
  Eigen::Vector3d expected_ = Eigen::Vector3d::Zero();  // in this pair
  // Corners of this pair, and the plane on whose ground they are.
  std::vector<cv::Point> corners_;
  Eigen::Vector3d corners_of_ = Eigen::Vector3d::Zero();
  Steadiness steadiness_;
  GroundCornerMemory memory_;
};

}  // namespace uav_landing
