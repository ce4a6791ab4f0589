#pragma once

#include <Eigen/Core>
#include <cmath>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "base/steadiness.h"
#include "geometry/plane_limits.h"
#include "image/windows/match_image.h"
#include "stereo/matching/corner_matcher.h"
#include "stereo/matching/stereo_level.h"
#include "uav_landing/base/timings.h"
#include "uav_landing/parameters/stereo_depth_parameters.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Predicts the ground plane of a pair from the pairs before it. Planes are plane vectors g, 1/m.
class PlaneTracker {
 public:
  /// corner_count: corners looked for in an image. matcher: finds them; must outlive this object.
  PlaneTracker(const StereoRig& rig, const StereoDepthParameters& parameters, const PlaneLimits& limits,
               int corner_count, CornerMatcher& matcher);

  /// Call it first for each pair, with its stamp in seconds. A stamp that is not after the last one makes it
  /// forget everything.
  void begin(double stamp);
  void forget();
  /// This pair has no plane. The last plane stays a good guess after one such pair, but not after many.
  void miss();
  /// The plane of this pair, for the next one to follow. certain: no test speaks against it.
  void remember(const StereoDepthResult& result, bool certain);

  bool hasLast() const { return has_last_; }
  /// Mean change of the plane over the last pairs, 1/m/s; 0 when not known.
  const Eigen::Vector3d& steadyRate() const { return steady_rate_; }
  /// Time since the previous pair, s; infinite for the first one.
  double duration() const { return duration_; }
  /// The plane carried on from the pairs before, when earlier predictions were right. It is good enough to
  /// match all corners directly, without a search by a few of them. Every so often there is none, so that a
  /// search checks it.
  std::optional<Eigen::Vector3d> steadyPlane(Timings& timings);
  /// Whether the corners matched by the steady plane agree with it.
  bool bearsOut(const StereoDepthResult& result) const;
  /// A plane good to about a pixel of disparity: by a few corners if they agree, else by more at the coarse
  /// level. factor: full size over the coarse level's size.
  std::optional<Eigen::Vector3d> follow(const StereoLevel& fine, const StereoLevel& coarse, int factor,
                                        Timings& timings);
  /// The same from a plane that a pair shortly before had. reach: in search radii.
  std::optional<Eigen::Vector3d> followFrom(const Eigen::Vector3d& g, const StereoLevel& coarse,
                                            double reach = 1);
  /// Corners on the ground of this plane. Those found before are used again while the horizon has hardly
  /// moved.
  std::vector<cv::Point> cornersOn(const StereoLevel& fine, const Eigen::Vector3d& g, Timings& timings);

  /// First rows that windows on the ground of this plane, or of the last one, may reach, with room for its
  /// movement.
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
  double stamp_ = -INFINITY, duration_ = 0;  // of this pair, and since the previous one, s
  bool has_last_ = false;
  Eigen::Vector3d last_ = Eigen::Vector3d::Zero(), rate_ = Eigen::Vector3d::Zero();  // of the last pair; its
                                                                                     // change by second
  Eigen::Vector3d steady_rate_ = Eigen::Vector3d::Zero();  // mean over the last pairs
  double last_stamp_ = 0;
  int failures_ = 0;                                    // pairs in a row
  Eigen::Vector3d expected_ = Eigen::Vector3d::Zero();  // in this pair
  // Corners of this pair, and the plane on whose ground they lie.
  std::vector<cv::Point> corners_;
  Eigen::Vector3d corners_of_ = Eigen::Vector3d::Zero();
  Steadiness steadiness_;
  GroundCornerMemory memory_;
};

}  // namespace uav_landing
