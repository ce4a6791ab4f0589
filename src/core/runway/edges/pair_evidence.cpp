#include "runway/edges/pair_evidence.h"

#include <algorithm>
#include <cmath>

namespace uav_landing {
namespace {

// Ratio between the widths of two pairs that are not the sides of one line.
constexpr double kOtherWidth = 1.5;
constexpr double kLeastDash = 0.1;       // log(far / near) of a dash of 30 m at 300 m
constexpr double kLongestMark = 1;       // log(far / near) of bars of 30 m that begin 17 m ahead
constexpr double kGoesOn = 2;            // ratio of the distances at which two lines end
constexpr double kThinner = 2;           // ratio by which a line may look thinner at another place
constexpr double kHalf = 0.5;            // share of the extent
constexpr double kHalfTolerance = 0.15;  // share of a pair's width, between marks and edges side by side
constexpr double kFarTolerance = 0.01;   // rad about the vanishing point; a thin far line may be off by this
constexpr double kUnbroken = 0.9;        // share of an edge's length that is seen
constexpr double kSameExtent = 0.4;      // log of the ratio of their extents
constexpr double kSameBeginning = 0.3;   // log of the ratio of the distances at which two edges begin

bool hasEdge(const std::vector<GroundEdge>& edges, double lateral, const MirroredPair& pair, double extent) {
  const double tolerance = kHalfTolerance * pair.width + kFarTolerance * (1 + lateral * lateral);
  return std::any_of(edges.begin(), edges.end(), [&](const GroundEdge& edge) {
    return edge.extent >= extent && std::abs(edge.lateral - lateral) < tolerance;
  });
}

}  // namespace

bool PairEvidence::isStrip(const MirroredPair& pair) const {
  const GroundEdge& l = edges_[pair.left];
  return isEven(pair) && l.begins && l.brighter_left && beginAlike(pair);
}

bool PairEvidence::isHalf(const MirroredPair& pair, const std::vector<GroundEdge>& edges) const {
  const double left = edges_[pair.left].lateral, right = edges_[pair.right].lateral;
  const double extent = std::max(kLongEdge * pair.extent, kLeastEdgeExtent);
  return hasEdge(edges, 2 * left - right, pair, extent) != hasEdge(edges, 2 * right - left, pair, extent);
}

bool PairEvidence::isDwarfed(const MirroredPair& pair, const std::vector<GroundEdge>& edges) const {
  const double left = edges_[pair.left].lateral + kHalfTolerance * pair.width;
  const double right = edges_[pair.right].lateral - kHalfTolerance * pair.width;
  return std::any_of(edges.begin(), edges.end(), [&](const GroundEdge& edge) {
    return (edge.lateral > left || edge.lateral < right) && kLongEdge * edge.extent > pair.extent;
  });
}

bool PairEvidence::areMarks(const Symmetry& symmetry, const std::vector<GroundEdge>& edges) const {
  double extent = 0, end = 0;
  for (const MirroredPair* pair : symmetry.pairs) {
    extent = std::max(extent, pair->extent);
    end = std::max(end, std::min(edges_[pair->left].far, edges_[pair->right].far));
  }
  return extent < kLongestMark && std::any_of(edges.begin(), edges.end(), [&](const GroundEdge& edge) {
           return edge.extent > extent && edge.far > kGoesOn * end;
         });
}

bool PairEvidence::areOutermost(const Symmetry& symmetry, const MirroredPair& outermost,
                                const Outlook& outlook) const {
  const auto isLong = [&](bool bright) {
    return std::any_of(symmetry.pairs.begin(), symmetry.pairs.end(), [&](const MirroredPair* pair) {
      return pair->extent >= kLeastEdgeExtent && edges_[pair->left].brighter_left != bright;
    });
  };
  const double left = edges_[outermost.left].lateral, right = edges_[outermost.right].lateral;
  return isLong(true) && isLong(false) && isBare(2 * left - right, outermost, outlook) &&
         isBare(2 * right - left, outermost, outlook);
}

bool PairEvidence::areTwoLines(const Symmetry& symmetry) const {
  return symmetry.pairs.size() >= 2 &&
         std::all_of(symmetry.pairs.begin(), symmetry.pairs.end(), [this](const MirroredPair* pair) {
           return isEven(*pair) && beginAlike(*pair) && isUnbroken(edges_[pair->left]) &&
                  isUnbroken(edges_[pair->right]);
         });
}

bool PairEvidence::isEven(const MirroredPair& pair) const {
  return std::abs(std::log(edges_[pair.left].extent / edges_[pair.right].extent)) < kSameExtent;
}

bool PairEvidence::isUnbroken(const GroundEdge& edge) {
  return edge.extent >= kUnbroken * std::log(edge.far / edge.near);
}

bool PairEvidence::beginAlike(const MirroredPair& pair) const {
  const GroundEdge &l = edges_[pair.left], &r = edges_[pair.right];
  return l.begins == r.begins && (!l.begins || std::abs(std::log(l.near / r.near)) < kSameBeginning);
}

bool PairEvidence::hasMoreThanTwoLines(const Symmetry& symmetry, const MirroredPair& outermost) const {
  double narrowest = outermost.width, widest = outermost.width;
  int lines = 0, marks = 0;
  for (const MirroredPair* pair : symmetry.pairs) {
    if (pair->extent < kLeastDash) continue;
    if (pair->width < kStripeShare * outermost.width && !edges_[pair->left].brighter_left) return true;
    if (kOtherWidth * pair->width < outermost.width) ++marks;
    if (pair->extent < kLeastEdgeExtent) continue;
    narrowest = std::min(narrowest, pair->width);
    widest = std::max(widest, pair->width);
    ++lines;
  }
  return lines > 2 || marks > 1 || widest > kOtherWidth * narrowest;
}

bool PairEvidence::isBare(double lateral, const MirroredPair& pair, const Outlook& outlook) const {
  const GroundEdge &l = edges_[pair.left], &r = edges_[pair.right];
  // The same line looks thinner farther to the side.
  const double nearer = std::min(std::abs(l.lateral), std::abs(r.lateral));
  if (std::hypot(1, lateral) > kThinner * std::hypot(1, nearer)) return false;
  const double near = std::max(l.near, r.near), far = std::min(l.far, r.far);
  return seenExtent(lateral, near, far, outlook.rig) > std::max(kHalf * pair.extent, kLeastEdgeExtent) &&
         !hasEdge(outlook.edges, lateral, pair, kLeastDash);
}

double PairEvidence::seenExtent(double lateral, double near, double far, const StereoRig& rig) const {
  constexpr int kSteps = 16;
  int seen = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double forward = near * std::pow(far / near, (i + 0.5) / kSteps);
    const Eigen::Vector3d ray = axes_.down + forward * axes_.forward + lateral * axes_.left;
    if (ray.z() <= 0) continue;
    const Eigen::Vector2d pixel = rig.project(ray);
    seen += static_cast<int>(pixel.x() > 0 && pixel.x() < rig.size.width && pixel.y() > 0 &&
                             pixel.y() < rig.size.height);
  }
  return std::log(far / near) * seen / kSteps;
}

}  // namespace uav_landing
