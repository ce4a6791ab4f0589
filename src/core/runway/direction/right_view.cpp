#include "runway/direction/right_view.h"

#include "rig/rig_rotation.h"

namespace uav_landing {

std::vector<RoughSegment> linesInRightView(const StereoRig& rig, const SeenGround& ground,
                                           const std::vector<LineSegment>& lines) {
  const auto seen = [&](const Eigen::Vector2d& left) {
    return placeInRightImage(rig, ground.rows, left, ground.plane.disparity(rig, left.x(), left.y()));
  };
  std::vector<RoughSegment> moved;
  moved.reserve(lines.size());
  // The brighter side stays the same, because lines of the ground turn by less than a right angle.
  for (const LineSegment& line : lines) moved.push_back({seen(line.a), seen(line.b), line.line.head<2>()});
  return moved;
}

}  // namespace uav_landing
