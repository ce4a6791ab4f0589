#pragma once

#include <opencv2/core.hpp>
#include <optional>

#include "far/edge_readings.h"
#include "far/outline_fit.h"
#include "geometry/ground_normal.h"
#include "uav_landing/image/rectification.h"
#include "uav_landing/parameters/approach_angle_parameters.h"
#include "uav_landing/parameters/runway_parameters.h"

namespace uav_landing {

/// The ground as it is known without the runway; see SeenGround.
struct KnownGround {
  std::optional<GroundNormal> normal;  ///< without what the runway slopes against it
  GroundPlane plane;                   ///< by stereo, without the rig's rotation, or not valid
  RightCamera right;
};

/// A runway's outline in one image, with the pose that belongs to it.
struct SightedRunway {
  FittedOutline outline;
  OutlinePose pose;
  Corners corners;        ///< px
  EdgeReadings readings;  ///< of this image and those before
};

/// The one of two fits that agrees better with its own pose; the other one when one has failed.
Expected<SightedRunway> betterOf(Expected<SightedRunway> first, Expected<SightedRunway> second);

/// Fits the outline of a surface and says whether it may be the runway. It may be the runway when it has a
/// runway's size, is seen as on an approach, and agrees with charts, horizon and stereo.
class SightFit {
 public:
  SightFit(const RigModel& rig, const ApproachAngleParameters& parameters, const RunwayParameters& runway);

  /// One fit from corners within some pixels. about: size of the surface, m, where the chart does not give
  /// it; 0: not known. Fails where no outline is found there.
  Expected<SightedRunway> fit(const cv::Mat& left, const Corners& start, const KnownGround& ground,
                              const RunwaySize& about) const;
  /// The same for a runway that is followed. last: in the image before.
  Expected<SightedRunway> follow(const cv::Mat& left, const Corners& start, const KnownGround& ground,
                                 const SightedRunway& last) const;
  /// Corners to fit once more from: those of the pose, when outline and pose differ. Otherwise nothing.
  std::optional<Corners> betterStart(const SightedRunway& seen) const;
  /// Why this surface is no runway on an approach; no failure: it may be one.
  Failure problemOf(const OutlinePose& pose, const KnownGround& ground) const;

  /// Before anything is fitted: false when the near side has too many pixels, or a width that no runway has.
  bool isPlausible(const Corners& corners, const KnownGround& ground) const;
  /// True when an outline is too near to begin with it.
  static bool isNear(const OutlinePose& pose);

  /// Where in the image a runway's far part may be.
  cv::Rect region(const KnownGround& ground) const;
  PoseKnowledge knowledge(const KnownGround& ground) const;
  /// The disparity of the runway in this pair alone; nothing where stereo has no plane.
  std::optional<SurfaceDisparity> disparityOf(const RectifiedImages& images, const SightedRunway& seen,
                                              const KnownGround& ground) const;
  const RigModel& model() const { return model_; }
  /// True when an outline is worth looking for: a chart gives the size, and the ground is not known to be
  /// near.
  bool mayStart(const KnownGround& ground) const;

 private:
  OutlineLook lookOf(const RunwaySize& about) const;
  Failure faintness(const FittedOutline& outline, const Corners& corners, double width,
                    const KnownGround& ground) const;
  /// corners: by the best reading. width: of the surface, about, m.
  Expected<SightedRunway> withPose(const FittedOutline& outline, const Corners& corners, double width,
                                   const KnownGround& ground) const;

  RigModel model_;
  double max_yaw_, slope_;  // rad
  RunwayParameters runway_;
};

}  // namespace uav_landing
