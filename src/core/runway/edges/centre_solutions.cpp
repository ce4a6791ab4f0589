#include "runway/edges/centre_solutions.h"

#include <algorithm>
#include <cmath>

namespace uav_landing {
namespace {

using Solution = CentreSolutions::Solution;

// Share of the width; lines along the edges and the surface's own edges lie within it.
constexpr double kAtEdge = 0.8;
constexpr double kWidthStddev = 0.03;  // of the known width, as a share of it; paint may lie beside the edge

/// What the sides of a line on the runway belong to.
enum class Part { kEdges, kStripe, kMarks };

class Solutions {
 public:
  Solutions(const GroundAxes& axes, const std::vector<MirroredEdges>& pairs, size_t outermost)
      : axes_(axes), pairs_(pairs), outermost_(pairs[outermost]), width_(widthOf(outermost_)) {}

  Part partOf(const MirroredEdges& pair) const {
    if (widthOf(pair) >= kAtEdge * width_) return Part::kEdges;
    const bool bright = !pair.left->brighter_left;
    return bright && widthOf(pair) < kStripeShare * width_ ? Part::kStripe : Part::kMarks;
  }
  bool has(Part part) const {
    return std::any_of(pairs_.begin(), pairs_.end(),
                       [&](const MirroredEdges& pair) { return partOf(pair) == part; });
  }

  Solution without(Part part) const {
    std::vector<MirroredEdges> left;
    for (const MirroredEdges& pair : pairs_)
      if (partOf(pair) != part) left.push_back(pair);
    return solve(axes_, left);
  }

  Solution withoutDirection() const {
    GroundAxes axes = axes_;
    axes.covariance(2, 2) = 1;  // rad^2: any direction
    return solve(axes, pairs_);
  }

  /// By one of the outermost edges and half of the known width.
  void takeSingleEdges(double known_width, CentreSolutions& found) const {
    const RunwayCrossSection edges = fitRunway(axes_, {outermost_}, 0);
    const double off = 0.5 * (edges.width - known_width);
    const double variance =
        edges.variance + 0.25 * edges.width_variance + std::pow(0.5 * kWidthStddev * known_width, 2);
    found[CentreSource::kLeftEdge] = {edges.centre - off, variance};
    found[CentreSource::kRightEdge] = {edges.centre + off, variance};
  }

 private:
  static double widthOf(const MirroredEdges& pair) { return pair.left->lateral - pair.right->lateral; }

  static Solution solve(const GroundAxes& axes, const std::vector<MirroredEdges>& pairs) {
    if (pairs.empty()) return {};
    const auto longest =
        std::max_element(pairs.begin(), pairs.end(), [](const MirroredEdges& l, const MirroredEdges& r) {
          return std::min(l.left->extent, l.right->extent) < std::min(r.left->extent, r.right->extent);
        });
    const RunwayCrossSection found = fitRunway(axes, pairs, static_cast<size_t>(longest - pairs.begin()));
    return {found.centre, found.variance};
  }

  const GroundAxes& axes_;
  const std::vector<MirroredEdges>& pairs_;
  MirroredEdges outermost_;
  double width_;
};

}  // namespace

CentreSolutions centreSolutions(const GroundAxes& axes, const std::vector<MirroredEdges>& pairs,
                                size_t outermost, const Solution& whole, const ChartWidth& chart) {
  const Solutions solutions(axes, pairs, outermost);
  const bool stripe = solutions.has(Part::kStripe), marks = solutions.has(Part::kMarks);
  CentreSolutions found;
  if (stripe || marks) {
    found[CentreSource::kLeftEdge] = found[CentreSource::kRightEdge] = solutions.without(Part::kEdges);
  } else if (chart.width > 0) {
    solutions.takeSingleEdges(chart.width, found);
  }
  found[CentreSource::kStripe] = stripe ? solutions.without(Part::kStripe) : whole;
  found[CentreSource::kMarks] = marks ? solutions.without(Part::kMarks) : whole;
  found[CentreSource::kDirection] = solutions.withoutDirection();
  if (stripe || (chart.width > 0 && !chart.rivalled)) found[CentreSource::kWholeRunway] = whole;
  return found;
}

}  // namespace uav_landing
