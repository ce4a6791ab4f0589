#include "motion/step/row_shake.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace uav_landing {
namespace {

constexpr double kLeastStddev = 2e-4, kMostStddev = 1e-2;  // rad: a smaller shake does not matter
constexpr int kFewestNodes = 4;
// Least logarithm of the likelihood ratio at which shake is found.
constexpr double kLeastLikelihood = 100;
// Share of the remembered likelihoods that is left at the next pair.
constexpr double kKept = 0.95;

/// The nodes as one linear system with three unknowns each.
struct NodeSystem {
  Eigen::MatrixXd rotation, with_motion;
  Eigen::VectorXd score, with_time, shares;

  explicit NodeSystem(const std::vector<RowNode>& nodes) {
    const auto n = static_cast<Eigen::Index>(nodes.size());
    rotation.setZero(3 * n, 3 * n);
    with_motion.resize(3 * n, 9);
    score.resize(3 * n);
    with_time.resize(3 * n);
    shares.resize(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      rotation.block<3, 3>(3 * i, 3 * i) = nodes[i].rotation;
      if (i + 1 < n) {
        rotation.block<3, 3>(3 * i, 3 * i + 3) = nodes[i].with_next;
        rotation.block<3, 3>(3 * i + 3, 3 * i) = nodes[i].with_next;
      }
      with_motion.middleRows<3>(3 * i) = nodes[i].with_motion;
      score.segment<3>(3 * i) = nodes[i].score;
      with_time.segment<3>(3 * i) = nodes[i].with_time;
      shares[i] = nodes[i].share;
    }
  }

  // Root L of the covariance L L' of a shake of unit variance around one frequency.
  Eigen::MatrixXd root(double cycles) const {
    constexpr double kAlike = 0.5;  // cycles, so the frequency is known to a third
    constexpr double kOwn = 1e-3;   // independent part of each node, so that the root exists
    const Eigen::Index n = shares.size();
    Eigen::MatrixXd covariance(n, n);
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j < n; ++j) {
        const double apart = (shares[i] - shares[j]) * cycles;
        covariance(i, j) =
            std::cos(2 * M_PI * apart) * std::exp(-0.5 * std::pow(apart / kAlike, 2)) + (i == j) * kOwn;
      }
    const Eigen::MatrixXd L = covariance.llt().matrixL();
    Eigen::MatrixXd root = Eigen::MatrixXd::Zero(3 * n, 3 * n);
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j <= i; ++j)
        root.block<3, 3>(3 * i, 3 * j) = L(i, j) * Eigen::Matrix3d::Identity();
    return root;
  }
};

// Factor by which the matches' variances are larger than they claim, from the residuals that no shake
// explains.
double noiseBeside(const std::vector<RowNode>& nodes, const NodeSystem& system) {
  constexpr double kAnything = 1;  // rad
  double squares = 0, count = 0;
  for (const RowNode& node : nodes) {
    squares += node.squares;
    count += 2 * node.count;
  }
  const Eigen::Index n = system.score.size();
  const Eigen::MatrixXd some = system.rotation + Eigen::MatrixXd::Identity(n, n) / (kAnything * kAnything);
  const double left = squares - system.score.dot(some.ldlt().solve(system.score));
  return count > n ? std::max(1.0, left / (count - n)) : 1;
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

Remainder remainderOf(const NodeSystem& system, const Matrix9d& information, const TimeUnknown& time) {
  const bool timed = time.information > 0;
  Eigen::Matrix<double, 10, 10> all = Eigen::Matrix<double, 10, 10>::Identity();
  all.topLeftCorner<9, 9>() = information;
  Eigen::MatrixXd with_all = Eigen::MatrixXd::Zero(system.score.size(), 10);
  with_all.leftCols<9>() = system.with_motion;
  Eigen::Matrix<double, 10, 1> right = Eigen::Matrix<double, 10, 1>::Zero();
  if (timed) {
    // Residuals grow with the readout time, so its terms have the opposite sign.
    all(9, 9) = time.information;
    all.topRightCorner<9, 1>() = -time.with_motion;
    all.bottomLeftCorner<1, 9>() = -time.with_motion.transpose();
    with_all.col(9) = -system.with_time;
    right[9] = -time.right;
  }
  const Eigen::LDLT<Eigen::Matrix<double, 10, 10>> solver(all);
  return {system.rotation - with_all * solver.solve(with_all.transpose()),
          system.score - with_all * solver.solve(right)};
}

// Eliminates the shake. With K = L L', (N + K^-1)^-1 is L (1 + L' N L)^-1 L'.
RowShake takenOut(const NodeSystem& system, const Matrix9d& information, double noise,
                  const ShakeMemory::Size& size) {
  // The size is the mean of three axes, but one axis may have all of it.
  const Eigen::MatrixXd root = std::sqrt(3.0) * size.stddev * system.root(size.cycles);
  const Eigen::Index n = root.rows();
  const Eigen::LDLT<Eigen::MatrixXd> inner(Eigen::MatrixXd::Identity(n, n) +
                                           root.transpose() * system.rotation * root / noise);
  const auto hidden = [&](const Eigen::MatrixXd& right) -> Eigen::MatrixXd {
    return root * inner.solve(root.transpose() * right) / noise;
  };
  const Eigen::MatrixXd of_motion = hidden(system.with_motion);
  const Eigen::VectorXd of_score = hidden(system.score), of_time = hidden(system.with_time);
  RowShake shake;
  shake.variance = size.stddev * size.stddev;
  shake.information = information - system.with_motion.transpose() * of_motion;
  shake.step = -shake.information.ldlt().solve(system.with_motion.transpose() * of_score);
  shake.time_with_motion = system.with_motion.transpose() * of_time;
  shake.time_information = system.with_time.dot(of_time);
  shake.time_right = system.with_time.dot(of_score) - shake.time_with_motion.dot(shake.step);
  return shake;
}

}  // namespace

double ShakeMemory::stddev(int k) {
  return kLeastStddev * std::pow(kMostStddev / kLeastStddev, k / (kStddevs - 1.0));
}

void ShakeMemory::add(const Likelihoods& pair) {
  for (size_t i = 0; i < kCycles.size(); ++i)
    for (int k = 0; k < kStddevs; ++k)
      if (std::isfinite(pair[i][k])) sums_[i][k] = kKept * sums_[i][k] + pair[i][k];
}

ShakeMemory::Size ShakeMemory::likeliest() const {
  Size best;
  for (size_t i = 0; i < kCycles.size(); ++i)
    for (int k = 0; k < kStddevs; ++k)
      if (sums_[i][k] > best.likelihood) best = {stddev(k), kCycles[i], sums_[i][k]};
  return best;
}

RowShake findRowShake(const std::vector<RowNode>& nodes, const Matrix9d& information, const TimeUnknown& time,
                      ShakeMemory& memory) {
  if (static_cast<int>(nodes.size()) < kFewestNodes) return {};
  const NodeSystem system(nodes);
  const double noise = noiseBeside(nodes, system);
  const Remainder left = remainderOf(system, information, time);
  ShakeMemory::Likelihoods likelihoods = {};
  for (size_t i = 0; i < ShakeMemory::kCycles.size(); ++i) {
    const Eigen::MatrixXd root = system.root(ShakeMemory::kCycles[i]);
    addLikelihoods(root.transpose() * left.rotation * root, root.transpose() * left.score, noise,
                   likelihoods[i]);
  }
  memory.add(likelihoods);
  const ShakeMemory::Size size = memory.likeliest();
  if (!(size.likelihood > kLeastLikelihood)) return {};
  return takenOut(system, information, noise, size);
}

}  // namespace uav_landing
