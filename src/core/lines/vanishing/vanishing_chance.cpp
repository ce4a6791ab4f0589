#include "lines/vanishing/vanishing_chance.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace uav_landing {

namespace {

/// Log of Chernoff's bound of the probability that random lines with these chances give as much evidence.
double logBound(const std::vector<double>& chances, double evidence) {
  double lowest = 0;
  for (double lambda = 0.1; lambda < 1.05; lambda += 0.1) {
    double bound = -lambda * evidence;
    for (const double p : chances) bound += std::log1p(p * (std::pow(p, -lambda) - 1));
    lowest = std::min(lowest, bound);
  }
  return lowest;
}

}  // namespace

double chanceOfPassing(const VanishingLines& lines, const VanishingCandidate& line,
                       const Eigen::Vector3d& V) {
  return chanceWithin(lines.toleranceOf(line) / line.half * lines.perTurn(line) * line.towards(V).norm() *
                      lines.perPixel(V));
}

// Number of pairs of lines that meet along the runway, times the probability that the other lines pass there
// as well. Each line counts with -log of its own chance, except those that say nothing.
double expectedCoincidences(const VanishingLines& lines, const Eigen::Vector3d& direction,
                            const std::vector<int>& used, double meetings) {
  const Eigen::Vector3d V = lines.K() * direction;
  std::vector<double> passing_by, others;  // chances
  for (int i = 0; i < lines.count(); ++i) {
    const double p = chanceOfPassing(lines, lines[i], V);
    if (p > kLikelyChance) continue;
    const bool passes = std::binary_search(used.begin(), used.end(), i);
    (passes ? passing_by : others).push_back(p);
  }
  if (passing_by.size() <= 2) return meetings;
  const double count = static_cast<double>(passing_by.size() + others.size());
  // Two lines always meet, so the two that say most do not count.
  std::sort(passing_by.begin(), passing_by.end(), std::greater<double>());
  passing_by.resize(passing_by.size() - 2);
  double evidence = 0;
  for (const double p : passing_by) evidence -= std::log(p);
  others.insert(others.end(), passing_by.begin(), passing_by.end());
  return std::min(meetings, 0.5 * count * (count - 1)) * std::exp(logBound(others, evidence));
}

}  // namespace uav_landing
