#pragma once

#include <Eigen/Core>
#include <vector>

#include "uav_landing/simulator/parameters.h"

namespace uav_landing {

/// The ground's height along the runway, z(x) in the runway frame. A slope, a parabola and another slope
/// follow each other without a kink, and a hill of four parabolas may lie on them. The height is the same for
/// all y, and 0 at x = 0.
class GroundProfile {
 public:
  explicit GroundProfile(const SimulatedProfileParameters& parameters = {});

  /// True when the ground is the plane z = 0.
  bool flat() const { return flat_; }
  double height(double x) const;

  /// A line z = height + slope x.
  struct Line {
    double slope = 0, height = 0;
    double at(double x) const { return height + slope * x; }
  };
  /// Tangent where a ray first meets the ground. A ray that does not meet it gets the ground's line at
  /// infinity on its side. direction: need not be normalised.
  Line seen(const Eigen::Vector3d& centre, const Eigen::Vector3d& direction) const;

 private:
  /// z = height + slope (x - from) + curvature / 2 (x - from)^2 for x from `begin` to `end`.
  struct Piece {
    double begin, end, from, height, slope, curvature;
    double at(double x) const;
    Line tangent(double x) const;
    /// Distance along the ray to this piece, in units of the direction; infinite when the ray does not meet
    /// it.
    double meet(const Eigen::Vector3d& centre, const Eigen::Vector3d& direction) const;
  };
  const Piece& pieceAt(double x) const;

  bool flat_;
  std::vector<Piece> pieces_;  ///< from near to far, without gaps
};

}  // namespace uav_landing
