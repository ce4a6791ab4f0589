#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "lines/vanishing_lines.h"

namespace uav_landing {

/// Chance from which on a line that passes says nothing.
constexpr double kLikelyChance = 0.05;

/// Chance that a line of random direction on the ground passes as near as within this angle of it, rad. It is
/// small where it matters: larger ones say nothing.
inline double chanceWithin(double turn) { return 2 / M_PI * turn; }

/// Probability that a line of random direction on the ground, seen where this one is, passes through V within
/// the tolerance at its ends. Texture seen at a grazing angle looks like lines along the horizon, so these
/// pass near every point of it and say next to nothing; lines that rise towards it say much.
double chanceOfPassing(const VanishingLines& lines, const VanishingCandidate& line, const Eigen::Vector3d& V);

/// Log-likelihood ratio of a line that passes, where a quarter of the lines does because they are the
/// runway's and the others do by chance.
inline double evidenceOf(double chance) {
  constexpr double kRunwayShare = 0.25;
  return std::log(1 - kRunwayShare + kRunwayShare / chance);
}

/// How many meeting points as well supported as this one are expected of lines of random direction on the
/// ground. used: indices of the lines that pass, in order. meetings: pairs of lines that meet along the
/// runway.
double expectedCoincidences(const VanishingLines& lines, const Eigen::Vector3d& direction,
                            const std::vector<int>& used, double meetings);

}  // namespace uav_landing
