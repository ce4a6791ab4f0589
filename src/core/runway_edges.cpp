#include "uav_landing/runway_edges.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "text.h"

namespace uav_landing {
namespace {

constexpr size_t kMaxEdges = 30;      // longest ones
constexpr double kGate = 3;           // sigma between two pairs' centres
constexpr double kAsymmetry = 0.002;  // of the width: 1 sigma by which a pair of marks is painted off centre
constexpr double kWidthTolerance = 0.05;  // of the width that is known
constexpr double kLong = 0.4;         // of the longest wide pair's extent: long enough for a runway's edge
constexpr double kLeastExtent = 0.3;  // log(far / near) of the runway's edges
constexpr double kLeastMargin = 1.4;  // evidence over that of any other symmetry
constexpr size_t kLeastPairs = 2;     // that make a symmetry

/// An edge and its counterpart on the other side.
struct MirroredPair {
  size_t left, right;  // indices of edges
  double centre, width;
  double variance;              // of the centre, in the image alone and by asymmetry of the paint
  Eigen::Vector3d by_rotation;  // of the centre
  double extent;
};

/// A centre line and the pairs that agree on it.
struct Symmetry {
  double centre = 0, tolerance = 0, score = 0;
  std::vector<const MirroredPair*> pairs;
};

class Search {
 public:
  Search(const GroundAxes& axes, const std::vector<GroundEdge>& edges) : axes_(axes), edges_(edges) {
    if (edges_.size() > kMaxEdges) edges_.resize(kMaxEdges);
    for (size_t i = 0; i < edges_.size(); ++i)
      for (size_t j = 0; j < edges_.size(); ++j)
        if (edges_[i].lateral > edges_[j].lateral && edges_[i].brighter_left != edges_[j].brighter_left)
          pairs_.push_back(mirrored(i, j));
  }

  std::vector<Symmetry> symmetries() const {
    std::vector<Symmetry> found;
    for (const MirroredPair& pair : pairs_) found.push_back(around(pair));
    std::sort(found.begin(), found.end(),
              [](const Symmetry& l, const Symmetry& r) { return l.score > r.score; });
    return found;
  }

  /// Centre by least squares over all pairs, what is common to them by way of the axes taken in.
  RunwayCrossSection measure(const Symmetry& symmetry, const MirroredPair& outermost) const {
    const auto n = static_cast<Eigen::Index>(symmetry.pairs.size());
    Eigen::VectorXd centres(n);
    Eigen::MatrixXd by_rotation(n, 3), covariance = Eigen::MatrixXd::Zero(n, n);
    for (Eigen::Index k = 0; k < n; ++k) {
      centres[k] = symmetry.pairs[k]->centre;
      by_rotation.row(k) = symmetry.pairs[k]->by_rotation.transpose();
      covariance(k, k) = symmetry.pairs[k]->variance;
    }
    covariance += by_rotation * axes_.covariance * by_rotation.transpose();
    const Eigen::VectorXd ones = Eigen::VectorXd::Ones(n);
    const Eigen::LLT<Eigen::MatrixXd> solver(covariance);
    const Eigen::VectorXd weights = solver.solve(ones);
    RunwayCrossSection section;
    section.variance = 1 / weights.sum();
    section.centre = weights.dot(centres) * section.variance;
    const Eigen::VectorXd residuals = centres - section.centre * ones;
    if (n > 1) section.variance *= std::max(1.0, residuals.dot(solver.solve(residuals)) / (n - 1));
    const GroundEdge &l = edges_[outermost.left], &r = edges_[outermost.right];
    const Eigen::Vector3d difference = l.by_rotation - r.by_rotation;
    section.width = outermost.width;
    section.width_variance = l.variance + r.variance + difference.dot(axes_.covariance * difference);
    return section;
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

  double toleranceOf(const MirroredPair& a, const MirroredPair& b) const {
    const Eigen::Vector3d differ = a.by_rotation - b.by_rotation;
    return kGate * std::sqrt(a.variance + b.variance + differ.dot(axes_.covariance * differ));
  }

  /// Every edge counts in one pair only, the one that fits best.
  Symmetry around(const MirroredPair& centre) const {
    std::vector<std::pair<double, const MirroredPair*>> near;
    for (const MirroredPair& pair : pairs_) {
      const double miss = std::abs(pair.centre - centre.centre) / toleranceOf(pair, centre);
      if (miss <= 1) near.emplace_back(miss, &pair);
    }
    std::sort(near.begin(), near.end(), [](const auto& l, const auto& r) { return l.first < r.first; });
    std::vector<char> used(edges_.size(), 0);
    Symmetry symmetry;
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
  std::vector<GroundEdge> edges_;
  std::vector<MirroredPair> pairs_;
};

/// The widest long pair; with a known width, the longest pair of that width.
const MirroredPair* outermostPair(const Symmetry& symmetry, double width) {
  double longest = 0;
  for (const MirroredPair* pair : symmetry.pairs) longest = std::max(longest, pair->extent);
  const MirroredPair* best = nullptr;
  for (const MirroredPair* pair : symmetry.pairs) {
    if (pair->extent < std::max(kLong * longest, kLeastExtent)) continue;
    if (width > 0) {
      if (std::abs(pair->width - width) > kWidthTolerance * width) continue;
      if (best == nullptr || pair->extent > best->extent) best = pair;
    } else if (best == nullptr || pair->width > best->width) {
      best = pair;
    }
  }
  return best;
}

Failure noRunway(const std::string& detail) { return {Reason::kNoRunway, detail}; }

}  // namespace

Expected<RunwayCrossSection> findRunwayEdges(const GroundAxes& axes, const std::vector<GroundEdge>& edges,
                                             double width, const std::optional<ExpectedCentre>& expected) {
  const Search search(axes, edges);
  const std::vector<Symmetry> found = search.symmetries();
  const auto best = std::find_if(found.begin(), found.end(), [&](const Symmetry& s) {
    return (!expected || std::abs(s.centre - expected->centre) <= expected->tolerance) &&
           outermostPair(s, width) != nullptr;
  });
  if (best == found.end())
    return tl::make_unexpected(noRunway(text("none of ", edges.size(), " edges are those of the runway")));
  if (!expected) {
    if (width <= 0 && best->pairs.size() < kLeastPairs)
      return tl::make_unexpected(noRunway("one pair of edges alone does not make a runway"));
    for (const Symmetry& other : found) {
      if (std::abs(other.centre - best->centre) <= other.tolerance + best->tolerance) continue;
      if (other.score * kLeastMargin > best->score)
        return tl::make_unexpected(noRunway("the edges have more than one symmetry"));
      break;
    }
  }
  return search.measure(*best, *outermostPair(*best, width));
}

}  // namespace uav_landing
