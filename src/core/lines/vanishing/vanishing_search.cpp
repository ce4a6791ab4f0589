#include "lines/vanishing/vanishing_search.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/text.h"
#include "estimation/limits.h"
#include "lines/vanishing/vanishing_chance.h"
#include "lines/vanishing/vanishing_consensus.h"
#include "lines/vanishing/vanishing_fit.h"
#include "lines/vanishing/vanishing_lines.h"

namespace uav_landing {

namespace {

constexpr double kDegree = M_PI / 180;
constexpr double kMinSpread = 3 * kDegree;  // between the inlier lines in the image
constexpr Sigmas kGate(4);                  // robust sigmas; lines within it count in the end
constexpr double kChance = 1;               // largest accepted number of such coincidences among random lines

template <class... Parts>
Failure noVanishingPoint(const Parts&... parts) {
  return {Reason::kNoVanishingPoint, text(parts...)};
}

int leastLines(const VanishingLines& lines) { return std::max(lines.parameters().min_lines, 2); }

Failure checkDirection(const VanishingLines& lines, const Eigen::Vector3d& direction,
                       const LineIndices& used) {
  if (direction.allFinite() && direction.z() > 0 && lines.alongRunway(direction)) return {};
  return noVanishingPoint(used.size(), " lines meet, but not along the runway");
}

/// Largest angle between the lines in the image: pi minus the widest gap between their directions.
double directionSpread(const VanishingLines& lines, const LineIndices& used) {
  std::vector<double> angles;
  for (const int i : used) {
    const double angle = std::atan2(lines[i].along.y(), lines[i].along.x());
    angles.push_back(angle < 0 ? angle + M_PI : angle);
  }
  std::sort(angles.begin(), angles.end());
  double gap = angles.front() + M_PI - angles.back();
  for (size_t i = 1; i < angles.size(); ++i) gap = std::max(gap, angles[i] - angles[i - 1]);
  return M_PI - gap;
}

Failure check(const VanishingLines& lines, const Eigen::Vector3d& direction, const LineIndices& used,
              double coincidences) {
  if (const Failure failure = checkDirection(lines, direction, used)) return failure;
  const double spread = directionSpread(lines, used);
  if (spread < kMinSpread)
    return noVanishingPoint("lines are parallel within ", std::round(10 * spread / kDegree) / 10,
                            " deg, less than ", kMinSpread / kDegree);
  if (lines.parameters().min_lines > 2 && coincidences > kChance)
    return noVanishingPoint("as many lines would meet by chance: ", used.size(), " of ", lines.count());
  return {};
}

/// The lines that pass through the direction of the consensus, and the point fitted to them.
Expected<VanishingPoint> fitTo(const VanishingLines& lines, const VanishingConsensus& consensus) {
  VanishingFit fit(lines, consensus.direction);
  LineIndices used = lines.passing(fit.direction());
  double scale = 1;
  for (int iteration = 0; iteration < 8 && used.size() >= 2; ++iteration) {
    scale = fit.robustStep(used);
    if (!fit.direction().allFinite())
      return tl::unexpected(noVanishingPoint(lines.count(), " lines are parallel"));
    used = lines.passing(fit.direction());
  }
  used = fit.within(used, kGate.count() * scale);
  const int n = static_cast<int>(used.size());
  if (n < leastLines(lines))
    return tl::unexpected(
        noVanishingPoint(n, " lines of at least ", lines.parameters().min_lines, " meet in one point"));
  for (int iteration = 0; iteration < 3; ++iteration) fit.plainStep(used);
  const double coincidences = expectedCoincidences(lines, fit.direction(), used, consensus.meetings);
  if (const Failure failure = check(lines, fit.direction(), used, coincidences))
    return tl::unexpected(failure);
  Expected<VanishingPoint> point = fit.describe(used);
  if (point) point->coincidences = coincidences;
  return point;
}

/// Where those two of the lines meet that differ most in direction; nothing when all are parallel.
std::optional<Eigen::Vector3d> widestMeeting(const VanishingLines& lines, const LineIndices& used) {
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  double widest = 0;
  for (const int i : used) {
    for (const int j : used) {
      const double sine =
          std::abs(lines[i].along.x() * lines[j].along.y() - lines[i].along.y() * lines[j].along.x());
      Eigen::Vector3d candidate;
      if (sine <= widest || !lines.meeting(i, j, candidate)) continue;
      widest = sine;
      direction = candidate;
    }
  }
  if (widest < std::sin(kMinSpread)) return std::nullopt;
  return direction;
}

}  // namespace

Expected<VanishingPoint> findVanishingPoint(const std::vector<LineSegment>& segments,
                                            const Eigen::Matrix3d& K,
                                            const ApproachAngleParameters& parameters,
                                            const Eigen::Vector3d* prior_normal) {
  const VanishingLines lines(segments, K, parameters, prior_normal);
  if (lines.count() < leastLines(lines))
    return tl::unexpected(
        Failure{Reason::kTooFewFeatures, text(lines.count(), " lines of at least ", parameters.min_lines)});
  const std::optional<VanishingConsensus> consensus = findConsensus(lines);
  if (!consensus)
    return tl::unexpected(noVanishingPoint("none of the ", lines.count(), " lines meet along the runway"));
  return fitTo(lines, *consensus);
}

Expected<VanishingPoint> fitVanishingPoint(const std::vector<LineSegment>& segments, const Eigen::Matrix3d& K,
                                           const ApproachAngleParameters& parameters,
                                           const std::vector<char>& members,
                                           const Eigen::Vector3d* prior_normal) {
  const VanishingLines lines(segments, K, parameters, prior_normal);
  LineIndices used;
  for (size_t i = 0; i < members.size(); ++i)
    if (members[i] != 0) used.push_back(static_cast<int>(i));
  const std::optional<Eigen::Vector3d> start = widestMeeting(lines, used);
  if (!start) return tl::unexpected(noVanishingPoint(used.size(), " lines are parallel"));
  VanishingFit fit(lines, *start);
  for (int iteration = 0; iteration < 5; ++iteration) {
    fit.robustStep(used);
    if (const Failure failure = checkDirection(lines, fit.direction(), used)) return tl::unexpected(failure);
  }
  return fit.describe(used);
}

}  // namespace uav_landing
