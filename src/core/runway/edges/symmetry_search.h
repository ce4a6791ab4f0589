#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "runway/direction/ground_edges.h"
#include "runway/edges/centre_columns.h"
#include "runway/edges/centre_solutions.h"
#include "runway/edges/runway_cross_section.h"

namespace uav_landing {

// Share of the longest pair's extent. Such an edge is long enough to be the runway's.
constexpr double kLongEdge = 0.4;
constexpr double kLeastEdgeExtent = 0.3;  // log(far / near) of the runway's edges

/// An edge and its counterpart on the other side.
struct MirroredPair {
  size_t left, right;  // indices of edges
  double centre, width;
  double variance;              // of the centre: from the image and from asymmetric paint
  Eigen::Vector3d by_rotation;  // derivatives of the centre
  double extent;
};

/// A centre line and the pairs that agree on it.
struct Symmetry {
  double centre = 0, tolerance = 0, score = 0;
  std::vector<const MirroredPair*> pairs;
};

/// The widest long pair of the symmetry, or null. With a known width, it is the longest pair of that width.
/// longest: extent of the longest pair of all.
const MirroredPair* outermostPair(const Symmetry& symmetry, double width, double longest);

/// Finds the lines about which edges are symmetric.
class SymmetrySearch {
 public:
  /// Only the longest edges are used, and pairs that are at most so wide.
  SymmetrySearch(const GroundAxes& axes, const std::vector<GroundEdge>& edges, double widest);

  /// One around each pair, the best one first. They point to pairs of this search.
  std::vector<Symmetry> symmetries() const;
  RunwayCrossSection measure(const Symmetry& symmetry, const MirroredPair& outermost,
                             const ChartWidth& chart) const;
  /// Whether other long edges than those of this symmetry have another one that is about as good.
  bool isRivalled(const Symmetry& symmetry, const std::vector<Symmetry>& all) const;
  /// Extent of the longest pair. Its middle may be anywhere, but stripes of paint do not count.
  double longest() const;
  /// The edges that pairs are made of.
  const std::vector<GroundEdge>& edges() const { return edges_; }

 private:
  /// Working memory for one centre after another.
  struct Memory {
    // Pairs with their distance from the centre, in tolerances.
    std::vector<std::pair<double, const MirroredPair*>> near;
    std::vector<char> used;    // per edge
    std::vector<uchar> apart;  // per pair: 1 when it is certainly too far away
  };

  MirroredPair mirrored(size_t i, size_t j) const;
  double toleranceOf(const MirroredPair& a, const MirroredPair& b) const;
  double widthOfLongest() const;
  bool isSharper(const MirroredPair& pair, const MirroredPair& centre) const;
  Symmetry around(const MirroredPair& centre, Memory& memory) const;

  const GroundAxes& axes_;
  const double spread_ = axes_.covariance.trace();
  std::vector<GroundEdge> edges_;
  std::vector<MirroredPair> pairs_;
  CentreColumns columns_;  // of pairs_
  // Variance of a centre from inexact paint, for the width of the longest pair instead of the pair's own.
  double paint_ = 0;
};

}  // namespace uav_landing
