#include "motion/step/row_shake.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace uav_landing {
namespace {

constexpr double kLeastStddev = 2e-4, kMostStddev = 1e-2;  // rad: a smaller shake does not matter
constexpr int kFewestNodes = 4;
// Least logarithm of the likelihood ratio at which shake is found. Over flat ground no global shutter came
// near it: the largest was 30, and mostly no pair has any sign.
constexpr double kLeastLikelihood = 40;
// The same for shake to be suspected: as rare by chance as 4 sigma. It only widens claims, so it may be
// wrong.
constexpr double kSuspected = 10;
// Share of the remembered likelihoods that is left at the next pair.
constexpr double kKept = 0.95;

// Root L of the covariance L L' of shake of unit variance around one frequency, for one axis.
Eigen::MatrixXd shapesOf(Eigen::Index nodes, double cycles) {
  constexpr double kLeast = 1e-2;  // shapes of less variance over the nodes are left out
  const Vibration vibration{1, cycles};
  Eigen::MatrixXd covariance(nodes, nodes);
  for (Eigen::Index i = 0; i < nodes; ++i)
    for (Eigen::Index j = 0; j < nodes; ++j)
      covariance(i, j) = vibration.alike(static_cast<double>(i - j) / RowNode::kInReadout);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes(covariance);
  const Eigen::VectorXd& variances = axes.eigenvalues();
  const Eigen::Index kept = (variances.array() > kLeast).count();
  return axes.eigenvectors().rightCols(kept) * variances.tail(kept).cwiseSqrt().asDiagonal();
}

// The same shapes for all three axes.
Eigen::MatrixXd forThreeAxes(const Eigen::MatrixXd& root) {
  Eigen::MatrixXd three = Eigen::MatrixXd::Zero(3 * root.rows(), 3 * root.cols());
  for (Eigen::Index i = 0; i < root.rows(); ++i)
    for (Eigen::Index j = 0; j < root.cols(); ++j)
      three.block<3, 3>(3 * i, 3 * j) = root(i, j) * Eigen::Matrix3d::Identity();
  return three;
}

// Part of the weighted sum of squared residuals that rotations of the nodes explain.
double squaresOfNodes(const RowSums& sums) {
  constexpr double kAnything = 1;  // rad
  const Eigen::Index n = sums.score.size();
  const Eigen::MatrixXd some = sums.rotation + Eigen::MatrixXd::Identity(n, n) / (kAnything * kAnything);
  return sums.score.dot(some.ldlt().solve(sums.score));
}

// Factor by which the matches' variances are larger than they claim, from the residuals that no shake
// explains.
double noiseBeside(const RowSums& sums, double explained) {
  const double count = 2 * sums.count;
  const auto unknowns = static_cast<double>(sums.score.size());
  return count > unknowns ? std::max(1.0, (sums.squares - explained) / (count - unknowns)) : 1;
}

// Whether rotations of the nodes explain more than noise lets them, by their chi-square.
bool showsSign(const RowSums& sums, double explained, double noise) {
  constexpr double kSign = 2;  // sigma
  const auto unknowns = static_cast<double>(sums.score.size());
  return explained / noise > unknowns + kSign * std::sqrt(2 * unknowns);
}

// Works in the axes of the scores' own covariance M. There a score has the variance d + variance d^2, with
// the eigenvalue d and the variance of the shake.
void addLikelihoods(const Eigen::MatrixXd& M, const Eigen::VectorXd& scores, double noise,
                    std::array<double, ShakeMemory::kStddevs>& likelihoods) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes(M);
  const Eigen::VectorXd z = axes.eigenvectors().transpose() * scores;
  const double least = 1e-9 * axes.eigenvalues().tail<1>()[0];
  for (int k = 0; k < ShakeMemory::kStddevs; ++k) {
    const double variance = std::pow(ShakeMemory::stddev(k), 2);
    for (Eigen::Index i = 0; i < z.size(); ++i) {
      const double d = axes.eigenvalues()[i];
      if (!(d > least)) continue;
      const double gain = variance * d / noise;
      likelihoods[k] += 0.5 * (z[i] * z[i] / (d * noise) * gain / (1 + gain) - std::log1p(gain));
    }
  }
}

// Sums for the shake that remain after motion and readout time are fitted as well as possible.
struct Remainder {
  Eigen::MatrixXd rotation;
  Eigen::VectorXd score;
};

Remainder remainderOf(const RowSums& sums, bool any_normal) {
  constexpr double kAnyReadout = 0.02;  // s
  Eigen::Matrix<double, 10, 10> all = Eigen::Matrix<double, 10, 10>::Identity();
  all.topLeftCorner<9, 9>() = any_normal ? sums.motion.information_with_any_normal : sums.motion.information;
  Eigen::MatrixXd with_all = Eigen::MatrixXd::Zero(sums.score.size(), 10);
  with_all.leftCols<9>() = sums.with_motion;
  Eigen::Matrix<double, 10, 1> right = Eigen::Matrix<double, 10, 1>::Zero();
  if (any_normal) right.head<9>() = sums.motion.right_with_any_normal;
  if (sums.by_time.information > 0) {
    // Residuals grow with the readout time, so its terms have the opposite sign.
    all(9, 9) = sums.by_time.information + 1 / (kAnyReadout * kAnyReadout);
    all.topRightCorner<9, 1>() = -sums.by_time.with_motion;
    all.bottomLeftCorner<1, 9>() = -sums.by_time.with_motion.transpose();
    with_all.col(9) = -sums.with_time;
    right[9] = -sums.by_time.right;
  }
  const Eigen::LDLT<Eigen::Matrix<double, 10, 10>> solver(all);
  return {sums.rotation - with_all * solver.solve(with_all.transpose()),
          sums.score - with_all * solver.solve(right)};
}

}  // namespace

double ShakeMemory::stddev(int k) {
  return kLeastStddev * std::pow(kMostStddev / kLeastStddev, k / (kStddevs - 1.0));
}

// What speaks against shake is not remembered, or vibration that begins would have to make up for it first.
void ShakeMemory::add(const Likelihoods& pair) {
  for (size_t i = 0; i < kCycles.size(); ++i)
    for (int k = 0; k < kStddevs; ++k)
      if (std::isfinite(pair[i][k])) sums_[i][k] = kKept * std::max(before_[i][k], 0.0) + pair[i][k];
}

ShakeMemory::Size ShakeMemory::likeliest() const {
  Size best;
  for (size_t i = 0; i < kCycles.size(); ++i)
    for (int k = 0; k < kStddevs; ++k)
      if (sums_[i][k] > best.likelihood) best = {i, stddev(k), sums_[i][k]};
  return best;
}

const ShakeShapes::Roots& ShakeShapes::of(Eigen::Index nodes) {
  if (roots_[0].rows() == nodes) return roots_;
  for (size_t i = 0; i < roots_.size(); ++i) roots_[i] = shapesOf(nodes, ShakeMemory::kCycles[i]);
  return roots_;
}

RowShake findRowShake(const ShakeWatch& watch, ShakeShapes& shapes, RowSums& sums) {
  const Eigen::Index nodes = sums.score.size() / 3;
  if (nodes < kFewestNodes) return {};
  const double explained = squaresOfNodes(sums), noise = noiseBeside(sums, explained);
  ShakeMemory& memory = *watch.memory;
  if (!watch.rolling && !showsSign(sums, explained, noise)) {
    memory.fade();
    return {};
  }
  const Remainder left = remainderOf(sums, !watch.rolling);
  const ShakeShapes::Roots& roots = shapes.of(nodes);
  ShakeMemory::Likelihoods likelihoods = {};
  for (size_t i = 0; i < roots.size(); ++i) {
    const Eigen::MatrixXd root = forThreeAxes(roots[i]);
    addLikelihoods(root.transpose() * left.rotation * root, root.transpose() * left.score, noise,
                   likelihoods[i]);
  }
  memory.add(likelihoods);
  const ShakeMemory::Size size = memory.likeliest();
  const bool found = size.likelihood > kLeastLikelihood;
  if (!found && !(watch.rolling && size.likelihood > kSuspected)) return {};
  // The size is the mean of three axes, but one axis may have all of it.
  const Eigen::MatrixXd root = std::sqrt(3.0) * size.stddev * forThreeAxes(roots[size.cycles]);
  const Vector9d step = sums.takeOut(root, noise);
  return {found ? Vibration{size.stddev, ShakeMemory::kCycles[size.cycles]} : Vibration(), step};
}

}  // namespace uav_landing
