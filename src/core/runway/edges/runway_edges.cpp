#include "runway/edges/runway_edges.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"

namespace uav_landing {
namespace {

constexpr double kLeastMargin = 1.4;  // ratio to the score of any other symmetry

EdgeRefusal noRunway(const std::string& detail) { return {{Reason::kNoRunway, detail}, std::nullopt}; }

}  // namespace

FoundRunway findRunwayEdges(const GroundAxes& axes, const std::vector<GroundEdge>& edges,
                            const RunwayWidth& width, const std::optional<ExpectedCentre>& expected,
                            const Outlook* outlook) {
  const SymmetrySearch search(axes, edges, width.widest);
  const PairEvidence evidence(axes, search.edges());
  const double longest = search.longest();
  const std::vector<Symmetry> found = search.symmetries();
  const auto best = std::find_if(found.begin(), found.end(), [&](const Symmetry& s) {
    return (!expected || std::abs(s.centre - expected->centre) <= expected->tolerance) &&
           outermostPair(s, width.known, longest) != nullptr;
  });
  if (best == found.end())
    return tl::make_unexpected(noRunway(text("none of ", edges.size(), " edges are those of the runway")));
  const MirroredPair& outermost = *outermostPair(*best, width.known, longest);
  // What one view alone sees is no evidence for a pair, but it is evidence against it.
  const std::vector<GroundEdge>& seen = outlook != nullptr ? outlook->edges : edges;
  if (width.known <= 0 && evidence.isHalf(outermost, seen)) {
    EdgeRefusal half = noRunway("the runway reaches as far again beyond its seeming edges");
    half.half = {outermost.centre, outermost.variance, outermost.width};
    return tl::make_unexpected(half);
  }
  if (!expected) {
    if (width.known <= 0 && evidence.isDwarfed(outermost, seen))
      return tl::make_unexpected(noRunway("far longer edges lie beyond those that look like the runway's"));
    if (width.known <= 0 && evidence.areMarks(*best, seen))
      return tl::make_unexpected(noRunway("a longer line goes on behind what looks like the runway's edges"));
    const bool outermost_lines = outlook != nullptr && evidence.areOutermost(*best, outermost, *outlook);
    if (width.known <= 0 && !evidence.hasMoreThanTwoLines(*best, outermost) && !evidence.areTwoLines(*best) &&
        !evidence.isStrip(outermost) && !outermost_lines)
      return tl::make_unexpected(noRunway("one pair of lines alone does not make a runway"));
    for (const Symmetry& other : found) {
      if (other.score * kLeastMargin <= best->score) break;
      if (std::abs(other.centre - best->centre) > other.tolerance + best->tolerance &&
          outermostPair(other, width.known, 0.5 * longest) != nullptr)
        return tl::make_unexpected(noRunway("the edges have more than one symmetry"));
    }
  }
  return search.measure(*best, outermost, {width.known, width.known > 0 && search.isRivalled(*best, found)});
}

}  // namespace uav_landing
