#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "lines/vanishing/vanishing_lines.h"
#include "runway/direction/ground_edges.h"

namespace uav_landing {

/// Where a line lies on the ground, in heights of the camera: left of the camera, nearest and farthest end.
struct LinePlace {
  double lateral = 0, near = 0, far = 0;
};

/// The lines of a view on ground that has a direction in it, by line.
struct LinePencil {
  std::vector<std::optional<LinePlace>> places;  ///< none above the horizon of this ground
  std::vector<char> passes;                      ///< the line vanishes in the direction
  std::vector<double> evidence;  ///< log-likelihood ratio that it does so not by chance; 0 if it does not
};

/// Lines of a view, and the rays to them.
class GroundLines {
 public:
  /// normal: of the ground, unit, frame of the view. Refers to the lines.
  GroundLines(const VanishingLines& lines, const Eigen::Vector3d& normal);

  int count() const { return lines_.count(); }
  /// Where two lines meet, as a unit vector towards +z; nothing when a runway does not vanish there, or when
  /// the lines are nearly parallel in the picture.
  std::optional<Eigen::Vector3d> meeting(int i, int j) const;
  /// Whether the line may run along a runway, and whether it may be of a threshold.
  bool isAhead(int i) const { return ahead_[static_cast<size_t>(i)] != 0; }
  bool isAcross(int i) const { return across_[static_cast<size_t>(i)] != 0; }
  /// Whether the line is brighter on its left than on its right.
  bool isBrighterLeft(int i) const { return lines_[i].line.x() < 0; }
  /// The ground turned until it has a direction in it. direction: unit, towards +z.
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
