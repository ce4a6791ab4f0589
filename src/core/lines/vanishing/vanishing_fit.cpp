#include "lines/vanishing/vanishing_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "estimation/robust.h"
#include "geometry/rotation.h"

namespace uav_landing {

namespace {

constexpr double kDegree = M_PI / 180;
constexpr double kMaxStddev = 5 * kDegree;  // largest 1 sigma of a direction that is reported
constexpr double kCauchy = 2.385;           // 95 % as good as least squares when the errors are normal
constexpr double kNoRobustness = 1e6;

}  // namespace

double VanishingFit::robustStep(const LineIndices& used) {
  std::vector<double> misses = normalised(used);
  for (double& miss : misses) miss = std::abs(miss);
  const double scale = std::max(1.0, robustStddev(misses));  // lines are not better than they claim
  step(used, kCauchy * scale);
  return scale;
}

void VanishingFit::plainStep(const LineIndices& used) { step(used, kNoRobustness); }

LineIndices VanishingFit::within(const LineIndices& used, double gate) const {
  const std::vector<double> residuals = normalised(used);
  LineIndices kept;
  for (size_t k = 0; k < used.size(); ++k)
    if (std::abs(residuals[k]) <= gate) kept.push_back(used[k]);
  return kept;
}

Expected<VanishingPoint> VanishingFit::describe(const LineIndices& used) const {
  double chi2 = 0;
  for (const double r : normalised(used)) chi2 += r * r;
  const double inflation = std::max(1.0, chi2 / std::max<double>(static_cast<double>(used.size()) - 2, 1));
  const Eigen::Matrix2d covariance = inflation * information_.inverse();
  const double stddev =
      std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(covariance).eigenvalues()[1]);
  if (!(stddev <= kMaxStddev))
    return tl::unexpected(
        Failure{Reason::kNoVanishingPoint, text("uncertain by ", std::round(10 * stddev / kDegree) / 10,
                                                " deg, more than ", kMaxStddev / kDegree)});
  VanishingPoint point;
  point.direction = direction_;
  point.covariance = tangents_ * covariance * tangents_.transpose();
  point.inliers.assign(lines_.all().size(), 0);
  for (const int i : used) point.inliers[static_cast<size_t>(i)] = 1;
  point.inlier_count = static_cast<int>(used.size());
  return point;
}

/// Residuals over their standard deviations.
std::vector<double> VanishingFit::normalised(const LineIndices& used) const {
  const Eigen::Vector3d V = lines_.K() * direction_;
  std::vector<double> residuals;
  residuals.reserve(used.size());
  for (const int i : used)
    residuals.push_back(lines_[i].line.dot(V) / std::sqrt(lines_[i].residualVariance(V)));
  return residuals;
}

void VanishingFit::step(const LineIndices& used, double cauchy_scale) {
  const Eigen::Matrix3d& K = lines_.K();
  const Eigen::Vector3d V = K * direction_;
  tangents_ = tangents(direction_);
  information_.setZero();
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
  for (const int i : used) {
    const double residual = lines_[i].line.dot(V), variance = lines_[i].residualVariance(V);
    const double u2 = residual * residual / variance / (cauchy_scale * cauchy_scale);
    const Eigen::Vector2d J = tangents_.transpose() * (K.transpose() * lines_[i].line);
    const double weight = 1 / (variance * (1 + u2));
    information_ += weight * J * J.transpose();
    gradient += weight * J * residual;
  }
  direction_ = (direction_ - tangents_ * information_.ldlt().solve(gradient)).normalized();
}

}  // namespace uav_landing
