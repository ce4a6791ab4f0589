#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "lines/vanishing/vanishing_lines.h"
#include "runway/direction/ground_edges.h"

namespace uav_landing {

/// Place of a line on the ground in heights of the camera: lateral position (left is positive), nearest and
/// farthest end.
struct LinePlace {
  double lateral = 0, near = 0, far = 0;
};

/// The lines of a view on a ground that contains a given direction, one entry per line.
struct LinePencil {
  std::vector<std::optional<LinePlace>> places;  ///< nothing for lines above the horizon of this ground
  std::vector<char> passes;                      ///< 1 if the line vanishes in this direction
  /// Log-likelihood ratio that the line does not pass there by chance; 0 if it does not pass.
  std::vector<double> evidence;
};

/// The lines of a view, with the rays to them.
class GroundLines {
 public:
  /// normal: of the ground, unit, frame of the view. The object refers to the lines, which must outlive it.
  GroundLines(const VanishingLines& lines, const Eigen::Vector3d& normal);

  int count() const { return lines_.count(); }
  /// Meeting point of two lines as a unit vector towards +z. Nothing when no runway can vanish there, or when
  /// the lines are nearly parallel in the image.
  std::optional<Eigen::Vector3d> meeting(int i, int j) const;
  /// Whether the line may run along a runway, and whether it may belong to a threshold.
  bool isAhead(int i) const { return ahead_[static_cast<size_t>(i)] != 0; }
  bool isAcross(int i) const { return across_[static_cast<size_t>(i)] != 0; }
  /// Whether the line is brighter on its left than on its right.
  bool isBrighterLeft(int i) const { return lines_[i].line.x() < 0; }
  /// Axes of the ground, turned until it contains this direction. direction: unit, towards +z.
  GroundAxes axesAlong(const Eigen::Vector3d& direction) const;
  std::optional<LinePlace> place(const GroundAxes& axes, int i) const;
  LinePencil pencil(const GroundAxes& axes) const;

 private:
  struct Rays {
    Eigen::Vector3d a, b, middle;
  };

  const VanishingLines& lines_;
  Eigen::Vector3d normal_;
  std::vector<Rays> rays_;
  std::vector<char> ahead_, across_;
};

}  // namespace uav_landing
