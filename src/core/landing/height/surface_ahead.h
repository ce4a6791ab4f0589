#pragma once

#include <optional>

#include "landing/height/pair_input.h"
#include "uav_landing/geometry/ground_plane.h"

namespace uav_landing {

/// Unevenness of the surface ahead, and its bend towards the ground straight below.
class SurfaceAhead {
 public:
  struct Shape {
    GroundPlane below;         ///< tangent of the surface straight below
    double bend = 0;           ///< height of the tangent minus height of the plane ahead, m
    double bend_variance = 0;  ///< m^2
    /// Variance of the surface about its plane, as far as it is certain, m^2.
    double unevenness = 0;
  };
  /// follow_bend: use the tangent below; otherwise the plane itself is used.
  explicit SurfaceAhead(bool follow_bend) : follow_bend_(follow_bend) {}

  /// Call it for a pair with a plane. known: there is already a height. Until then each pair starts again.
  Shape follow(const StereoDepthResult& stereo, const GroundPlane& plane, bool known);
  /// Call it for a pair without a plane. It keeps the shape of the last pair that had one. The variance grows
  /// with time, because other ground follows soon.
  Shape carry(double stamp) const;

 private:
  void followUnevenness(double surface_variance, bool known);

  struct Bend {
    double height, variance, stamp;  // m, m^2; s
  };
  bool follow_bend_;
  std::optional<Bend> last_bend_;
  // Mean of the surface's variance over recent pairs, m^2, and the variance of single pairs about it, m^4.
  double mean_ = 0, scatter_ = 0;
  int pairs_ = 0;          // number of pairs in the mean
  double unevenness_ = 0;  // m^2
};

}  // namespace uav_landing
