#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "lines/vanishing/vanishing_lines.h"

namespace uav_landing {

/// A line that passes with at least this chance says nothing.
constexpr double kLikelyChance = 0.05;

/// Chance that a line of random direction on the ground passes within this angle (rad) of a point. The
/// formula holds for small angles, and larger ones say nothing.
inline double chanceWithin(double turn) { return 2 / M_PI * turn; }

/// Probability that a line of random direction on the ground, seen at the place of this line, passes through
/// V within the tolerance at its ends. Texture seen at a grazing angle looks like lines along the horizon.
/// Such lines pass near every point of the horizon, so they say little; lines that rise towards it say much.
double chanceOfPassing(const VanishingLines& lines, const VanishingCandidate& line, const Eigen::Vector3d& V);

/// Log-likelihood ratio of a line that passes. A quarter of the lines is assumed to be the runway's; the
/// others pass by chance.
inline double evidenceOf(double chance) {
  constexpr double kRunwayShare = 0.25;
  return std::log(1 - kRunwayShare + kRunwayShare / chance);
}

/// Expected number of meeting points as well supported as this one, if lines on the ground had random
/// directions. used: indices of the lines that pass, in order. meetings: number of pairs of lines that meet
/// along the runway.
double expectedCoincidences(const VanishingLines& lines, const Eigen::Vector3d& direction,
                            const std::vector<int>& used, double meetings);

}  // namespace uav_landing
