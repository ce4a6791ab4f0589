#include "runway/direction/runway_hypothesis.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/text.h"
#include "runway/direction/line_pencil.h"
#include "runway/direction/runway_evidence.h"

namespace uav_landing {
namespace {

constexpr double kOther = 1 * M_PI / 180;  // least angle between two directions that count as different
constexpr double kByChance = 4;            // evidence of two lines that meet by chance, as any two do
// Least far end over near end of the part in which two lines lie side by side.
constexpr double kSideBySide = 1.05;

class Search {
 public:
  Search(const GroundLines& lines, const RunwayPrior& prior) : lines_(lines), prior_(prior) {}

  std::vector<RunwayHypothesis> all() const {
    std::vector<RunwayHypothesis> found;
    for (int i = 0; i < lines_.count(); ++i) {
      if (!lines_.isAhead(i)) continue;
      for (int j = 0; j < i; ++j) {
        if (!lines_.isAhead(j) || lines_.isBrighterLeft(i) == lines_.isBrighterLeft(j)) continue;
        const auto direction = lines_.meeting(i, j);
        if (!direction) continue;
        if (const auto object = between(i, j, *direction)) found.push_back(*object);
      }
    }
    return found;
  }

 private:
  std::optional<RunwayHypothesis> between(int i, int j, const Eigen::Vector3d& direction) const {
    const GroundAxes axes = lines_.axesAlong(direction);
    const auto a = lines_.place(axes, i), b = lines_.place(axes, j);
    if (!a || !b || !mayBeEdges(*a, *b)) return std::nullopt;
    std::optional<RunwayHypothesis> object = runwayBetween(
        lines_, lines_.pencil(axes), std::max(a->lateral, b->lateral), std::min(a->lateral, b->lateral));
    if (!object) return std::nullopt;
    object->direction = direction;
    object->evidence -=
        againstHorizon(direction, prior_) + againstPath(*object, prior_) + againstSize(*object, prior_);
    object->lead = object->evidence - againstTurn(direction, prior_);
    return object;
  }

  /// Whether two lines are seen side by side, at a distance that the edges of a runway may have.
  bool mayBeEdges(const LinePlace& a, const LinePlace& b) const {
    if (std::min(a.far, b.far) < kSideBySide * std::max(a.near, b.near)) return false;
    if (!prior_.height) return true;
    const double width = std::abs(a.lateral - b.lateral) * *prior_.height;
    return width >= kNarrowestRunway && width <= std::max(kWidestRunway, prior_.runway.width);
  }

  const GroundLines& lines_;
  const RunwayPrior& prior_;
};

}  // namespace

Expected<RunwayChoice> findRunwayHypothesis(const std::vector<LineSegment>& segments,
                                            const Eigen::Matrix3d& K,
                                            const ApproachAngleParameters& parameters,
                                            const RunwayPrior& prior) {
  const VanishingLines lines(segments, K, parameters, &prior.normal);
  const std::vector<RunwayHypothesis> found = Search(GroundLines(lines, prior.normal), prior).all();
  const auto best = std::max_element(found.begin(), found.end(),
                                     [](const auto& a, const auto& b) { return a.lead < b.lead; });
  if (best == found.end())
    return tl::make_unexpected(Failure{
        Reason::kNoRunway, text("no two of ", segments.size(), " lines may be the edges of a runway")});
  const auto azimuth = [&](const RunwayHypothesis& h) { return azimuthOn(prior.normal, h.direction); };
  const auto isOther = [&](const RunwayHypothesis& h) {
    return std::abs(azimuth(h) - azimuth(*best)) > kOther;
  };
  double evidence = kByChance, lead = kByChance;
  for (const RunwayHypothesis& h : found) {
    if (!isOther(h)) continue;
    evidence = std::max(evidence, h.evidence);
    lead = std::max(lead, h.lead);
  }
  // The margin is that of the direction. Half of a runway has the same one, and may lead with fewer bars.
  double margin = -std::numeric_limits<double>::infinity();
  for (const RunwayHypothesis& h : found)
    if (!isOther(h)) margin = std::max(margin, std::min(h.evidence - evidence, mostOfMargin(h, prior)));
  return RunwayChoice{*best, margin, best->lead - lead};
}

}  // namespace uav_landing
