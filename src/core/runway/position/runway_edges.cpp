#include "runway/position/runway_edges.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/text.h"
#include "estimation/limits.h"
#include "runway/position/centre_columns.h"
#include "runway/position/runway_fit.h"

namespace uav_landing {
namespace {

constexpr size_t kMaxEdges = 30;          // only the longest ones are used
constexpr Sigmas kGate(3);                // between the centres of two pairs
constexpr double kAsymmetry = 0.002;      // 1 sigma by which paint is off centre, as a share of the width
constexpr double kSharper = 2;            // ratio of standard deviations
constexpr double kWidthTolerance = 0.05;  // share of the known width
// Share of the longest pair's extent. Such an edge is long enough to be the runway's.
constexpr double kLong = 0.4;
constexpr double kLeastExtent = 0.3;  // log(far / near) of the runway's edges
constexpr double kLeastMargin = 1.4;  // ratio to the score of any other symmetry
constexpr double kLeastWidth = 0.3;   // heights; anything narrower is a stripe
constexpr double kOtherWidth =
    1.5;                         // ratio between the widths of two pairs that are not the sides of one line
constexpr double kStripe = 0.1;  // share of the runway's width; the centre line is narrower
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

class Search {
 public:
  Search(const GroundAxes& axes, const std::vector<GroundEdge>& edges, double widest)
      : axes_(axes), edges_(edges) {
    if (edges_.size() > kMaxEdges) edges_.resize(kMaxEdges);
    for (size_t i = 0; i < edges_.size(); ++i)
      for (size_t j = 0; j < edges_.size(); ++j)
        if (edges_[i].lateral > edges_[j].lateral && edges_[i].brighter_left != edges_[j].brighter_left &&
            edges_[i].lateral - edges_[j].lateral <= widest)
          pairs_.push_back(mirrored(i, j));
    paint_ = std::pow(kAsymmetry * widthOfLongest(), 2);
    for (const MirroredPair& pair : pairs_) columns_.add(pair.centre, pair.variance, pair.by_rotation);
  }

  std::vector<Symmetry> symmetries() const {
    std::vector<Symmetry> found;
    found.reserve(pairs_.size());
    Memory memory;
    for (const MirroredPair& pair : pairs_) found.push_back(around(pair, memory));
    std::sort(found.begin(), found.end(),
              [](const Symmetry& l, const Symmetry& r) { return l.score > r.score; });
    return found;
  }

  RunwayCrossSection measure(const Symmetry& symmetry, const MirroredPair& outermost) const {
    std::vector<MirroredEdges> pairs;
    size_t widest = 0;
    for (const MirroredPair* pair : symmetry.pairs) {
      if (pair == &outermost) widest = pairs.size();
      pairs.push_back({&edges_[pair->left], &edges_[pair->right]});
    }
    return fitRunway(axes_, pairs, widest);
  }

  /// Extent of the longest pair. Its middle may be anywhere, but stripes of paint do not count.
  double longest() const {
    double longest = 0;
    for (const MirroredPair& pair : pairs_)
      if (pair.width > kLeastWidth) longest = std::max(longest, pair.extent);
    return longest;
  }

  /// Whether both edges of the pair are equally long. A runway's edges are; its centre line is shorter than
  /// they.
  bool isEven(const MirroredPair& pair) const {
    return std::abs(std::log(edges_[pair.left].extent / edges_[pair.right].extent)) < kSameExtent;
  }
  /// Whether the pair is a dark strip that begins within the image, as it does at a threshold.
  bool isStrip(const MirroredPair& pair) const {
    const GroundEdge& l = edges_[pair.left];
    return isEven(pair) && l.begins && l.brighter_left && beginAlike(pair);
  }
  /// Whether most of the edge is seen. A centre line is dashed and fails this.
  static bool isUnbroken(const GroundEdge& edge) {
    return edge.extent >= kUnbroken * std::log(edge.far / edge.near);
  }
  /// Whether one edge of the pair seems to be the centre line of a wider runway. It would lie halfway between
  /// the other edge and a long edge beyond it. With such edges beyond both sides, the pair is the middle of a
  /// symmetric whole.
  bool isHalf(const MirroredPair& pair, const std::vector<GroundEdge>& edges) const {
    const double left = edges_[pair.left].lateral, right = edges_[pair.right].lateral;
    const double extent = std::max(kLong * pair.extent, kLeastExtent);
    return hasEdge(edges, 2 * left - right, pair, extent) != hasEdge(edges, 2 * right - left, pair, extent);
  }
  /// Whether much longer edges lie beyond the pair. The runway's own are the longest but for a river or a
  /// road, and those are not that much longer. So the pair is of marks.
  bool isDwarfed(const MirroredPair& pair, const std::vector<GroundEdge>& edges) const {
    const double left = edges_[pair.left].lateral + kHalfTolerance * pair.width;
    const double right = edges_[pair.right].lateral - kHalfTolerance * pair.width;
    return std::any_of(edges.begin(), edges.end(), [&](const GroundEdge& edge) {
      return (edge.lateral > left || edge.lateral < right) && kLong * edge.extent > pair.extent;
    });
  }
  /// Whether all pairs are short, and end where a longer line goes on, as bars of a threshold do.
  bool areMarks(const Symmetry& symmetry, const std::vector<GroundEdge>& edges) const {
    double extent = 0, end = 0;
    for (const MirroredPair* pair : symmetry.pairs) {
      extent = std::max(extent, pair->extent);
      end = std::max(end, std::min(edges_[pair->left].far, edges_[pair->right].far));
    }
    return extent < kLongestMark && std::any_of(edges.begin(), edges.end(), [&](const GroundEdge& edge) {
             return edge.extent > extent && edge.far > kGoesOn * end;
           });
  }
  /// Whether both edges begin at the same distance, or neither begins within the image.
  bool beginAlike(const MirroredPair& pair) const {
    const GroundEdge &l = edges_[pair.left], &r = edges_[pair.right];
    return l.begins == r.begins && (!l.begins || std::abs(std::log(l.near / r.near)) < kSameBeginning);
  }
  /// Whether the pair is two painted lines with nothing at the same distance beyond either of them. If one
  /// line were the centre line of a wider runway, its other edge line would be seen there.
  bool areOutermost(const Symmetry& symmetry, const MirroredPair& outermost, const Outlook& outlook) const {
    const auto isLong = [&](bool bright) {
      return std::any_of(symmetry.pairs.begin(), symmetry.pairs.end(), [&](const MirroredPair* pair) {
        return pair->extent >= kLeastExtent && edges_[pair->left].brighter_left != bright;
      });
    };
    const double left = edges_[outermost.left].lateral, right = edges_[outermost.right].lateral;
    return isLong(true) && isLong(false) && isBare(2 * left - right, outermost, outlook) &&
           isBare(2 * right - left, outermost, outlook);
  }
  /// Whether the pairs are two unbroken lines that look alike, each with both of its sides. A single dash is
  /// no counterpart of a continuous line.
  bool areTwoLines(const Symmetry& symmetry) const {
    return symmetry.pairs.size() >= 2 &&
           std::all_of(symmetry.pairs.begin(), symmetry.pairs.end(), [this](const MirroredPair* pair) {
             return isEven(*pair) && beginAlike(*pair) && isUnbroken(edges_[pair->left]) &&
                    isUnbroken(edges_[pair->right]);
           });
  }

 private:
  MirroredPair mirrored(size_t i, size_t j) const {
    const GroundEdge &l = edges_[i], &r = edges_[j];
    const double width = l.lateral - r.lateral;
    return {i,
            j,
            0.5 * (l.lateral + r.lateral),
            width,
            0.25 * (l.variance + r.variance) + std::pow(kAsymmetry * width, 2),
            0.5 * (l.by_rotation + r.by_rotation),
            std::min(l.extent, r.extent)};
  }

  static bool hasEdge(const std::vector<GroundEdge>& edges, double lateral, const MirroredPair& pair,
                      double extent) {
    const double tolerance = kHalfTolerance * pair.width + kFarTolerance * (1 + lateral * lateral);
    return std::any_of(edges.begin(), edges.end(), [&](const GroundEdge& edge) {
      return edge.extent >= extent && std::abs(edge.lateral - lateral) < tolerance;
    });
  }

  /// Whether a line like those of the pair would be seen at this place, but none is.
  bool isBare(double lateral, const MirroredPair& pair, const Outlook& outlook) const {
    const GroundEdge &l = edges_[pair.left], &r = edges_[pair.right];
    // The same line looks thinner farther to the side.
    const double nearer = std::min(std::abs(l.lateral), std::abs(r.lateral));
    if (std::hypot(1, lateral) > kThinner * std::hypot(1, nearer)) return false;
    const double near = std::max(l.near, r.near), far = std::min(l.far, r.far);
    return seenExtent(lateral, near, far, outlook.rig) > std::max(kHalf * pair.extent, kLeastExtent) &&
           !hasEdge(outlook.edges, lateral, pair, kLeastDash);
  }

  /// log(far / near) of the part that the left camera sees of a line along the runway between these
  /// distances.
  double seenExtent(double lateral, double near, double far, const StereoRig& rig) const {
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

  double toleranceOf(const MirroredPair& a, const MirroredPair& b) const {
    const Eigen::Vector3d differ = a.by_rotation - b.by_rotation;
    return kGate.bound(a.variance + b.variance + differ.dot(axes_.covariance * differ));
  }

  double widthOfLongest() const {
    double longest = 0, width = 0;
    for (const MirroredPair& pair : pairs_) {
      if (pair.width <= kLeastWidth || pair.extent <= longest) continue;
      longest = pair.extent;
      width = pair.width;
    }
    return width;
  }

  /// Whether this pair knows its centre much better than the given centre is known. An uncertain centre has
  /// room for any pairs, even for those that contradict each other. So pairs gather around the most certain
  /// one. The limit is how exactly a runway is painted.
  bool isSharper(const MirroredPair& pair, const MirroredPair& centre) const {
    return std::max(pair.variance, paint_) * kSharper * kSharper < centre.variance;
  }

  /// Working memory for one centre after another.
  struct Memory {
    // Pairs with their distance from the centre, in tolerances.
    std::vector<std::pair<double, const MirroredPair*>> near;
    std::vector<char> used;    // per edge
    std::vector<uchar> apart;  // per pair: 1 when it is certainly too far away
  };

  /// Pairs that agree on this centre. Each edge counts in one pair only, the one that fits best.
  Symmetry around(const MirroredPair& centre, Memory& memory) const {
    auto& [near, used, apart] = memory;
    near.clear();
    apart.resize(pairs_.size());
    columns_.markApart(&centre - pairs_.data(), kGate.count(), spread_, apart.data());
    const auto next = [&](size_t from) {
      const void* close = std::memchr(apart.data() + from, 0, apart.size() - from);
      return close ? static_cast<size_t>(static_cast<const uchar*>(close) - apart.data()) : apart.size();
    };
    for (size_t i = next(0); i < pairs_.size(); i = next(i + 1)) {
      const MirroredPair& pair = pairs_[i];
      if (isSharper(pair, centre)) continue;
      const double miss = std::abs(pair.centre - centre.centre) / toleranceOf(pair, centre);
      if (miss <= 1) near.emplace_back(miss, &pair);
    }
    std::sort(near.begin(), near.end(), [](const auto& l, const auto& r) { return l.first < r.first; });
    used.assign(edges_.size(), 0);
    Symmetry symmetry;
    symmetry.pairs.reserve(near.size());
    symmetry.centre = centre.centre;
    symmetry.tolerance = toleranceOf(centre, centre);
    for (const auto& [miss, pair] : near) {
      if (used[pair->left] != 0 || used[pair->right] != 0) continue;
      used[pair->left] = used[pair->right] = 1;
      symmetry.pairs.push_back(pair);
      symmetry.score += pair->extent * (1 - miss * miss);
    }
    return symmetry;
  }

  const GroundAxes& axes_;
  const double spread_ = axes_.covariance.trace();
  std::vector<GroundEdge> edges_;
  std::vector<MirroredPair> pairs_;
  CentreColumns columns_;  // of pairs_
  // Variance of a centre from inexact paint, for the width of the longest pair instead of the pair's own.
  double paint_ = 0;
};

/// The widest long pair. With a known width, it is the longest pair of that width.
const MirroredPair* outermostPair(const Symmetry& symmetry, double width, double longest) {
  const MirroredPair* best = nullptr;
  for (const MirroredPair* pair : symmetry.pairs) {
    if (pair->extent < std::max(kLong * longest, kLeastExtent) || pair->width < kLeastWidth) continue;
    if (width > 0) {
      if (std::abs(pair->width - width) > kWidthTolerance * width) continue;
      if (best == nullptr || pair->extent > best->extent) best = pair;
    } else if (best == nullptr || pair->width > best->width) {
      best = pair;
    }
  }
  return best;
}

/// Whether more than two lines share the symmetry.
///
/// Any two lines are symmetric about their middle with both of their sides. A piece of texture may be as
/// well, and so may the sides of one mark. These are more than that:
/// - A narrow bright stripe lies in the middle: the centre line.
/// - There are two marks or more, such as bars of a threshold.
/// - There are more than two long pairs, such as edge lines with the edges of the pavement beyond.
/// - Long pairs have very different widths, so they cannot be the sides of two lines.
bool hasMoreThanTwoLines(const Symmetry& symmetry, const MirroredPair& outermost,
                         const std::vector<GroundEdge>& edges) {
  double narrowest = outermost.width, widest = outermost.width;
  int lines = 0, marks = 0;
  for (const MirroredPair* pair : symmetry.pairs) {
    if (pair->extent < kLeastDash) continue;
    if (pair->width < kStripe * outermost.width && !edges[pair->left].brighter_left) return true;
    if (kOtherWidth * pair->width < outermost.width) ++marks;
    if (pair->extent < kLeastExtent) continue;
    narrowest = std::min(narrowest, pair->width);
    widest = std::max(widest, pair->width);
    ++lines;
  }
  return lines > 2 || marks > 1 || widest > kOtherWidth * narrowest;
}

EdgeRefusal noRunway(const std::string& detail) { return {{Reason::kNoRunway, detail}, std::nullopt}; }

}  // namespace

FoundRunway findRunwayEdges(const GroundAxes& axes, const std::vector<GroundEdge>& edges,
                            const RunwayWidth& width, const std::optional<ExpectedCentre>& expected,
                            const Outlook* outlook) {
  const Search search(axes, edges, width.widest);
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
  if (width.known <= 0 && search.isHalf(outermost, seen)) {
    EdgeRefusal half = noRunway("the runway reaches as far again beyond its seeming edges");
    half.half = {outermost.centre, outermost.variance, outermost.width};
    return tl::make_unexpected(half);
  }
  if (!expected) {
    if (width.known <= 0 && search.isDwarfed(outermost, seen))
      return tl::make_unexpected(noRunway("far longer edges lie beyond those that look like the runway's"));
    if (width.known <= 0 && search.areMarks(*best, seen))
      return tl::make_unexpected(noRunway("a longer line goes on behind what looks like the runway's edges"));
    const bool outermost_lines = outlook != nullptr && search.areOutermost(*best, outermost, *outlook);
    if (width.known <= 0 && !hasMoreThanTwoLines(*best, outermost, edges) && !search.areTwoLines(*best) &&
        !search.isStrip(outermost) && !outermost_lines)
      return tl::make_unexpected(noRunway("one pair of lines alone does not make a runway"));
    for (const Symmetry& other : found) {
      if (other.score * kLeastMargin <= best->score) break;
      if (std::abs(other.centre - best->centre) > other.tolerance + best->tolerance &&
          outermostPair(other, width.known, 0.5 * longest) != nullptr)
        return tl::make_unexpected(noRunway("the edges have more than one symmetry"));
    }
  }
  return search.measure(*best, outermost);
}

}  // namespace uav_landing
