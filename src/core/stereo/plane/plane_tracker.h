#pragma once

#include <Eigen/Core>
#include <cmath>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "base/steadiness.h"
#include "geometry/plane_limits.h"
#include "geometry/plane_vector.h"
#include "image/windows/match_image.h"
#include "stereo/matching/corner_matcher.h"
#include "stereo/matching/stereo_level.h"
#include "uav_landing/base/timings.h"
#include "uav_landing/parameters/stereo_depth_parameters.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Predicts the ground plane of a pair from the pairs before it.
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

  bool hasLast() const { return last_.has_value(); }
  /// Mean change of the plane over the last pairs, 1/m/s; 0 when not known.
  const Eigen::Vector3d& steadyRate() const { return steady_rate_; }
  /// Time since the previous pair, s; infinite for the first one.
  double duration() const { return duration_; }
  /// The plane carried on from the pairs before, when earlier predictions were right. It is good enough to
  /// match all corners directly, without a search by a few of them. Every so often there is none, so that a
  /// search checks it.
  std::optional<PlaneVector> steadyPlane(Timings& timings);
  /// Whether the corners matched by the steady plane agree with it.
  bool bearsOut(const StereoDepthResult& result) const;
  /// A plane good to about a pixel of disparity: by a few corners if they agree, else by more at the coarse
  /// level. factor: full size over the coarse level's size.
  std::optional<PlaneVector> follow(const StereoLevel& fine, const StereoLevel& coarse, int factor,
                                    Timings& timings);
  /// The same from a plane that a pair shortly before had. reach: in search radii.
  std::optional<PlaneVector> followFrom(const PlaneVector& g, const StereoLevel& coarse, double reach = 1);
  /// Corners on the ground of this plane. Those found before are used again while the horizon has hardly
  /// moved.
  std::vector<cv::Point> cornersOn(const StereoLevel& fine, const PlaneVector& g, Timings& timings);

  /// First rows that windows on the ground of this plane may reach. The same of the last plane, if it
  /// hasLast(), with room for its movement.
  FirstRows groundRows(const PlaneVector& g) const;
  FirstRows lastGroundRows() const;

 private:
  // The plane of the last pair that had one, and its change.
  struct Last {
    PlaneVector g;
    Eigen::Vector3d rate;  // of g, 1/m/s
    double stamp;          // s
    int misses = 0;        // pairs since then
  };
  // Corners of this pair that lie on the ground of a plane.
  struct GroundCorners {
    PlaneVector g;
    std::vector<cv::Point> places;
  };

  double farthestOff(const StereoDepthResult& result) const;
  FirstRows rowsOf(const PlaneVector& g, double slack) const;

  StereoRig rig_;
  StereoDepthParameters parameters_;
  PlaneLimits limits_;
  int corner_count_;
  CornerMatcher& matcher_;
  double stamp_ = -INFINITY, duration_ = 0;  // of this pair, and since the previous one, s
  std::optional<Last> last_;
  std::optional<PlaneVector> expected_;                    // in this pair
  Eigen::Vector3d steady_rate_ = Eigen::Vector3d::Zero();  // mean over the last pairs
  std::optional<GroundCorners> corners_;
  Steadiness steadiness_;
  GroundCornerMemory memory_;
};

}  // namespace uav_landing
