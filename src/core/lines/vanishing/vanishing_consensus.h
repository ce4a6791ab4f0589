#pragma once

#include <Eigen/Core>
#include <optional>

#include "lines/vanishing/vanishing_lines.h"

namespace uav_landing {

/// The direction on which the lines of a view agree best.
struct VanishingConsensus {
  Eigen::Vector3d direction;
  double meetings;  ///< pairs of lines that meet along the runway, anywhere
};

/// RANSAC: the meeting point of two lines on which most lines agree. Each line counts by how unlikely it is
/// to pass there by chance. All pairs are tried when they are few, else random ones in proportion to length.
/// Nothing when no two lines meet along the runway.
std::optional<VanishingConsensus> findConsensus(const VanishingLines& lines);

}  // namespace uav_landing
