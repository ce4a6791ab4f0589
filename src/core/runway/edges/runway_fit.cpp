#include "runway/edges/runway_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace uav_landing {
namespace {

// 1 sigma by which a pair of marks is off centre, as a share of the runway's width.
constexpr double kAsymmetry = 2e-4;
constexpr double kWeakest = 1e-12;  // information on unknowns that nothing measures
// 1 sigma by which blur moves the side of a line towards the dark, pixels. It is at most the blur's own
// sigma.
constexpr double kBlur = 0.7;
constexpr double kSurest = 1e-5;  // rad: no vanishing point gives a more exact direction

/// Least squares fit of all edges. Unknowns are the lateral position of each edge, the common direction, and
/// for each pair the shift of its sides by blur in units of 1 sigma.
///
/// Blur moves both sides of a pair towards the dark: one to the left, the other to the right. On the ground
/// the shift grows with the distance, so the sides turn against each other. If one side is seen better than
/// the other, the pair would seem to be turned.
///
/// Model of a piece: lateral = edge + slope forward, slope = turn +- moved. The vanishing point of the lines
/// is one more measurement of the turn, with the value 0.
class EdgeFit {
 public:
  EdgeFit(const std::vector<MirroredEdges>& pairs, double direction_variance)
      : direction_variance_(std::max(direction_variance, kSurest * kSurest)) {
    for (const MirroredEdges& pair : pairs)
      for (const GroundEdge* edge : {pair.left, pair.right}) edges_.push_back(edge);
    const Eigen::Index n = turn() + 1 + static_cast<Eigen::Index>(pairs.size());
    Eigen::MatrixXd information = Eigen::MatrixXd::Identity(n, n) * kWeakest;
    information(turn(), turn()) += 1 / direction_variance_;
    information.diagonal().tail(n - turn() - 1).setOnes();
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(n);
    Eigen::MatrixXd by_normal = Eigen::MatrixXd::Zero(n, 2);
    eachPiece([&](Eigen::Index e, const EdgePiece& piece) {
      const Eigen::Matrix2d weight = piece.covariance.inverse();
      const Eigen::Vector2d measured(piece.lateral, piece.slope);
      Eigen::Matrix<double, 2, 3> model;
      const double moved = movedByBlur(e);
      model << 1, piece.forward, moved * piece.forward, 0, 1, moved;
      // Derivatives of lateral and slope by rotations of the normal about forward and about left.
      const double x = piece.forward, y = piece.lateral;
      Eigen::Matrix2d by_rotation;
      by_rotation << -1 - y * y, x * y, 0, y;
      const Eigen::Matrix3d block = model.transpose() * weight * model;
      const Eigen::Vector3d right = model.transpose() * weight * measured;
      const Eigen::Matrix<double, 3, 2> turned = model.transpose() * weight * by_rotation;
      const Eigen::Index index[] = {e, turn(), blurOf(e)};
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) information(index[i], index[j]) += block(i, j);
        gradient[index[i]] += right[i];
        by_normal.row(index[i]) += turned.row(i);
      }
    });
    covariance_ = information.inverse();
    solution_ = covariance_ * gradient;
    by_normal_ = covariance_ * by_normal;
    inflate();
  }

  const Eigen::VectorXd& solution() const { return solution_; }
  const Eigen::MatrixXd& covariance() const { return covariance_; }
  const Eigen::MatrixXd& byNormal() const { return by_normal_; }
  Eigen::Index turn() const { return static_cast<Eigen::Index>(edges_.size()); }

 private:
  Eigen::Index blurOf(Eigen::Index edge) const { return turn() + 1 + edge / 2; }
  /// Change of the slope by 1 sigma of blur.
  double movedByBlur(Eigen::Index edge) const {
    const GroundEdge& seen = *edges_[edge];
    return (edge % 2 == 0 ? 1 : -1) * kBlur * seen.pixel * std::hypot(1, seen.lateral);
  }

  template <class Visit>
  void eachPiece(const Visit& visit) const {
    for (size_t e = 0; e < edges_.size(); ++e)
      for (const EdgePiece& piece : edges_[e]->pieces) visit(static_cast<Eigen::Index>(e), piece);
  }

  /// Enlarges the covariance when lines fit worse than they claim.
  void inflate() {
    double chi2 = solution_[turn()] * solution_[turn()] / direction_variance_ +
                  solution_.tail(solution_.size() - turn() - 1).squaredNorm();
    auto measured = static_cast<int>(solution_.size() - turn());
    eachPiece([&](Eigen::Index e, const EdgePiece& piece) {
      const double slope = solution_[turn()] + movedByBlur(e) * solution_[blurOf(e)];
      const Eigen::Vector2d residual(piece.lateral - solution_[e] - slope * piece.forward,
                                     piece.slope - slope);
      chi2 += residual.dot(piece.covariance.inverse() * residual);
      measured += 2;
    });
    const auto freedom = measured - static_cast<int>(solution_.size());
    if (freedom > 0) covariance_ *= std::max(1.0, chi2 / freedom);
  }

  double direction_variance_;
  std::vector<const GroundEdge*> edges_;
  Eigen::VectorXd solution_;
  Eigen::MatrixXd covariance_, by_normal_;
};

/// Variance by which the middles of pairs scatter in addition to their own errors (estimate of DerSimonian
/// and Laird).
double scatter(const Eigen::VectorXd& middles, const Eigen::VectorXd& variances) {
  const Eigen::VectorXd weights = variances.cwiseInverse();
  const double sum = weights.sum(), mean = weights.dot(middles) / sum;
  const double q = weights.dot((middles.array() - mean).square().matrix());
  const double c = sum - weights.squaredNorm() / sum;
  return c > 0 ? std::max(0.0, (q - static_cast<double>(middles.size() - 1)) / c) : 0;
}

}  // namespace

RunwayCrossSection fitRunway(const GroundAxes& axes, const std::vector<MirroredEdges>& pairs,
                             size_t outermost) {
  const EdgeFit fit(pairs, axes.covariance(2, 2));
  const auto n = static_cast<Eigen::Index>(pairs.size());
  // Rows: the middles of the pairs, then the direction.
  Eigen::MatrixXd middles_of = Eigen::MatrixXd::Zero(n + 1, fit.solution().size());
  for (Eigen::Index p = 0; p < n; ++p) middles_of(p, 2 * p) = middles_of(p, 2 * p + 1) = 0.5;
  middles_of(n, fit.turn()) = 1;
  const Eigen::VectorXd middles = middles_of * fit.solution();
  Eigen::MatrixXd covariance = middles_of * fit.covariance() * middles_of.transpose();

  const auto l = 2 * static_cast<Eigen::Index>(outermost), r = l + 1;
  RunwayCrossSection section;
  section.width = fit.solution()[l] - fit.solution()[r];
  const double paint =
      std::pow(kAsymmetry * section.width, 2) + scatter(middles.head(n), covariance.diagonal().head(n));
  // A longer mark represents the runway better. So its edge lines count more than the bars of its threshold.
  const auto extent = [&](size_t p) { return std::min(pairs[p].left->extent, pairs[p].right->extent); };
  for (Eigen::Index p = 0; p < n; ++p) covariance(p, p) += paint * extent(outermost) / extent(p);

  Eigen::MatrixXd model = Eigen::MatrixXd::Zero(n + 1, 2);
  model.topLeftCorner(n, 1).setOnes();
  model(n, 1) = 1;
  const Eigen::MatrixXd weighted = covariance.ldlt().solve(model);
  section.own = Eigen::Matrix2d(model.transpose() * weighted).inverse();
  const Eigen::MatrixXd gain = section.own * weighted.transpose();
  const Eigen::Vector2d solution = gain * middles;
  section.centre = solution[0];
  section.turn = solution[1];
  section.by_normal = gain * middles_of * fit.byNormal();
  const Eigen::Matrix2d normal = axes.covariance.topLeftCorner<2, 2>();
  section.variance =
      section.own(0, 0) + section.by_normal.row(0) * normal * section.by_normal.row(0).transpose();
  const Eigen::RowVector2d width_by_normal = fit.byNormal().row(l) - fit.byNormal().row(r);
  section.width_variance = fit.covariance()(l, l) + fit.covariance()(r, r) - 2 * fit.covariance()(l, r) +
                           width_by_normal * normal * width_by_normal.transpose();
  section.width_by_normal = width_by_normal;
  return section;
}

}  // namespace uav_landing
