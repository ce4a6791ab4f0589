#pragma once

#include <optional>

#include "landing/height/pair_input.h"
#include "uav_landing/geometry/ground_plane.h"

namespace uav_landing {

/// How uneven the surface ahead is, and how it bends down to the ground straight below.
class SurfaceAhead {
 public:
  struct Shape {
    GroundPlane below;         ///< tangent of the surface straight below
    double bend = 0;           ///< its height less that of the plane ahead, m
    double bend_variance = 0;  ///< m^2
    double unevenness = 0;     ///< variance of the surface about its plane as far as it is certain, m^2
  };
  /// follow_bend: the tangent below is wanted, else the plane itself is taken.
  explicit SurfaceAhead(bool follow_bend) : follow_bend_(follow_bend) {}

  /// A pair with a plane. known: there is a height already; while there is none each pair begins anew.
  Shape follow(const StereoDepthResult& stereo, const GroundPlane& plane, bool known);
  /// A pair without a plane: as on the last one that had one, which is soon another ground.
  Shape carry(double stamp) const;

 private:
  void followUnevenness(double surface_variance, bool known);

  struct Bend {
    double height, variance, stamp;  // m, m^2; s
  };
  bool follow_bend_;
  std::optional<Bend> last_bend_;
  double mean_ = 0, scatter_ = 0;  // of the surface's variance of the recent pairs, m^2, m^4
  int pairs_ = 0;                  // that the mean is of
  double unevenness_ = 0;          // m^2
};

}  // namespace uav_landing
