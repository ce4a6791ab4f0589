#include "runway/edges/symmetry_search.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "estimation/limits.h"
#include "runway/edges/runway_fit.h"

namespace uav_landing {
namespace {

constexpr size_t kMaxEdges = 30;  // only the longest ones are used
constexpr Sigmas kGate(3);        // between the centres of two pairs
// 1 sigma by which paint is off centre at worst, as a share of the width. It only decides which pairs belong
// together. The fit of these pairs measures their scatter, so it begins with less.
constexpr double kAsymmetry = 0.002;
constexpr double kSharper = 2;            // ratio of standard deviations
constexpr double kWidthTolerance = 0.05;  // share of the known width
constexpr double kRival = 0.5;            // share of the score, and of the longest pair's extent
constexpr double kLeastWidth = 0.3;       // heights; anything narrower is a stripe

}  // namespace

const MirroredPair* outermostPair(const Symmetry& symmetry, double width, double longest) {
  const MirroredPair* best = nullptr;
  for (const MirroredPair* pair : symmetry.pairs) {
    if (pair->extent < std::max(kLongEdge * longest, kLeastEdgeExtent) || pair->width < kLeastWidth) continue;
    if (width > 0) {
      if (std::abs(pair->width - width) > kWidthTolerance * width) continue;
      if (best == nullptr || pair->extent > best->extent) best = pair;
    } else if (best == nullptr || pair->width > best->width) {
      best = pair;
    }
  }
  return best;
}

SymmetrySearch::SymmetrySearch(const GroundAxes& axes, const std::vector<GroundEdge>& edges, double widest)
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

std::vector<Symmetry> SymmetrySearch::symmetries() const {
  std::vector<Symmetry> found;
  found.reserve(pairs_.size());
  Memory memory;
  for (const MirroredPair& pair : pairs_) found.push_back(around(pair, memory));
  std::sort(found.begin(), found.end(),
            [](const Symmetry& l, const Symmetry& r) { return l.score > r.score; });
  return found;
}

RunwayCrossSection SymmetrySearch::measure(const Symmetry& symmetry, const MirroredPair& outermost,
                                           const ChartWidth& chart) const {
  std::vector<MirroredEdges> pairs;
  size_t widest = 0;
  for (const MirroredPair* pair : symmetry.pairs) {
    if (pair == &outermost) widest = pairs.size();
    pairs.push_back({&edges_[pair->left], &edges_[pair->right]});
  }
  RunwayCrossSection section = fitRunway(axes_, pairs, widest);
  section.centre_without = centreSolutions(axes_, pairs, widest, {section.centre, section.variance}, chart);
  return section;
}

bool SymmetrySearch::isRivalled(const Symmetry& symmetry, const std::vector<Symmetry>& all) const {
  std::vector<char> explained(edges_.size(), 0);
  for (const MirroredPair* pair : symmetry.pairs) explained[pair->left] = explained[pair->right] = 1;
  const double long_extent = kRival * longest();
  return std::any_of(all.begin(), all.end(), [&](const Symmetry& other) {
    if (other.score < kRival * symmetry.score ||
        std::abs(other.centre - symmetry.centre) <= other.tolerance + symmetry.tolerance)
      return false;
    const MirroredPair* outermost = outermostPair(other, 0, long_extent);
    return outermost != nullptr && explained[outermost->left] + explained[outermost->right] < 2;
  });
}

double SymmetrySearch::longest() const {
  double longest = 0;
  for (const MirroredPair& pair : pairs_)
    if (pair.width > kLeastWidth) longest = std::max(longest, pair.extent);
  return longest;
}

MirroredPair SymmetrySearch::mirrored(size_t i, size_t j) const {
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

double SymmetrySearch::toleranceOf(const MirroredPair& a, const MirroredPair& b) const {
  const Eigen::Vector3d differ = a.by_rotation - b.by_rotation;
  return kGate.bound(a.variance + b.variance + differ.dot(axes_.covariance * differ));
}

double SymmetrySearch::widthOfLongest() const {
  double longest = 0, width = 0;
  for (const MirroredPair& pair : pairs_) {
    if (pair.width <= kLeastWidth || pair.extent <= longest) continue;
    longest = pair.extent;
    width = pair.width;
  }
  return width;
}

// Whether this pair knows its centre much better than the given centre is known. An uncertain centre has
// room for any pairs, even for those that contradict each other. So pairs gather around the most certain
// one. The limit is how exactly a runway is painted.
bool SymmetrySearch::isSharper(const MirroredPair& pair, const MirroredPair& centre) const {
  return std::max(pair.variance, paint_) * kSharper * kSharper < centre.variance;
}

// Pairs that agree on this centre. Each edge counts in one pair only, the one that fits best.
Symmetry SymmetrySearch::around(const MirroredPair& centre, Memory& memory) const {
  auto& [near, used, apart] = memory;
  near.clear();
  apart.resize(pairs_.size());
  columns_.markApart(&centre - pairs_.data(), kGate.count(), spread_, apart.data());
  // A lambda cannot hold a name of a structured binding itself (C++17).
  const auto next = [&apart = apart](size_t from) {
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

}  // namespace uav_landing
