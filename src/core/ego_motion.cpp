#include "uav_landing/ego_motion.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>

#include "rotation.h"

namespace uav_landing {
namespace {

using Vector9d = Eigen::Matrix<double, 9, 1>;
using Matrix9d = Eigen::Matrix<double, 9, 9>;

constexpr int kRansacIterations = 80;
// Distance, in pixels, by which a match may miss a motion in the consensus step.
constexpr double kTolerance = 2.0;
constexpr double kTukey = 4.5;

// The unknowns: rotation now -> then (perturbed on the left), translation, ground normal.
struct State {
  Eigen::Matrix3d Q;
  Eigen::Vector3d t, n;

  State apply(const Vector9d& step) const {
    return {rotationMatrix(step.head<3>()) * Q, t + step.segment<3>(3), n + step.tail<3>()};
  }
};

// Residual of one match with its Jacobian by (rotation, t, n).
struct Linearised {
  bool usable = false;
  Eigen::Vector2d residual;
  Eigen::Matrix<double, 2, 9, Eigen::RowMajor> jacobian;
  Eigen::Matrix2d covariance;
};

class Problem {
 public:
  Problem(const StereoRig& rig, const std::vector<TemporalMatch>& matches) : rig_(rig), matches_(matches) {
    rays_.reserve(matches.size());
    for (const TemporalMatch& match : matches) rays_.push_back(rig.ray(match.now.x(), match.now.y()));
  }

  size_t size() const { return matches_.size(); }

  double squaredError(const State& state, size_t i) const {
    const double w = inverseDepth(state, i);
    const Eigen::Vector3d y = state.Q * (rays_[i] + w * state.t);
    if (!(y.z() > 1e-6)) return 1e9;
    return (matches_[i].then - rig_.project(y)).squaredNorm();
  }

  Linearised linearise(const State& state, size_t i) const {
    Linearised result;
    const TemporalMatch& match = matches_[i];
    const double w = inverseDepth(state, i);
    const Eigen::Vector3d y = state.Q * (rays_[i] + w * state.t);
    if (!(y.z() > 1e-6)) return result;
    Eigen::Matrix<double, 2, 3> projection;
    projection << rig_.fx / y.z(), 0, -rig_.fx * y.x() / (y.z() * y.z()), 0, rig_.fy / y.z(),
        -rig_.fy * y.y() / (y.z() * y.z());
    const Eigen::Vector3d Qt = state.Q * state.t;
    result.residual = match.then - rig_.project(y);
    result.jacobian.leftCols<3>() = -projection * crossMatrix(y);
    result.jacobian.middleCols<3>(3) = projection * state.Q * w;
    result.jacobian.rightCols<3>().setZero();
    result.covariance = match.covariance;
    if (match.on_plane) {
      result.jacobian.rightCols<3>() = projection * Qt * rays_[i].transpose();
    } else {
      const Eigen::Vector2d by_depth = projection * Qt * match.inverse_depth_stddev;
      result.covariance += by_depth * by_depth.transpose();
    }
    result.usable = true;
    return result;
  }

 private:
  double inverseDepth(const State& state, size_t i) const {
    return matches_[i].on_plane ? state.n.dot(rays_[i]) : matches_[i].inverse_depth;
  }

  const StereoRig& rig_;
  const std::vector<TemporalMatch>& matches_;
  std::vector<Eigen::Vector3d> rays_;
};

// How well a motion is supported: votes weighted by closeness, and how many matches it fits well.
struct Support {
  double votes = 0;
  int close = 0;
};

Support support(const Problem& problem, const State& state) {
  constexpr double kClose = 0.0625;  // ratio of a match that misses by a quarter of the tolerance
  Support result;
  for (size_t i = 0; i < problem.size(); ++i) {
    const double ratio = problem.squaredError(state, i) / (kTolerance * kTolerance);
    if (ratio >= 1) continue;
    result.votes += 1 - ratio;
    if (ratio < kClose) ++result.close;
  }
  return result;
}

// Triples to try until one without outliers is among them with a probability of 99.9 %, when this share of
// the matches is right.
double triplesNeeded(double share) {
  constexpr double kMissed = 1e-3;
  const double all_right = std::min(share * share * share, 1 - kMissed);
  return all_right > 0 ? std::log(kMissed) / std::log1p(-all_right) : kRansacIterations;
}

// Rotation and translation that carry three matches exactly, by two Newton steps with the normal held.
bool solveTriple(const Problem& problem, const std::array<size_t, 3>& chosen, State& state) {
  for (int iteration = 0; iteration < 2; ++iteration) {
    Eigen::Matrix<double, 6, 6> A;
    Eigen::Matrix<double, 6, 1> b;
    for (int k = 0; k < 3; ++k) {
      const Linearised row = problem.linearise(state, chosen[k]);
      if (!row.usable) return false;
      A.middleRows<2>(2 * k) = row.jacobian.leftCols<6>();
      b.segment<2>(2 * k) = row.residual;
    }
    const Eigen::Matrix<double, 6, 1> x = A.partialPivLu().solve(b);
    if (!x.allFinite() || x.head<3>().norm() > 0.5) return false;
    Vector9d step = Vector9d::Zero();
    step.head<6>() = x;
    state = state.apply(step);
  }
  return true;
}

State bestByConsensus(const Problem& problem, const State& start) {
  State best = start;
  Support most = support(problem, start);
  std::mt19937 random(20100602u);
  double needed = triplesNeeded(double(most.close) / problem.size());
  for (int iteration = 0; iteration < std::min<double>(needed, kRansacIterations); ++iteration) {
    const std::array<size_t, 3> chosen = {random() % problem.size(), random() % problem.size(),
                                          random() % problem.size()};
    if (chosen[0] == chosen[1] || chosen[1] == chosen[2] || chosen[0] == chosen[2]) continue;
    State candidate = best;
    if (!solveTriple(problem, chosen, candidate)) continue;
    const Support found = support(problem, candidate);
    if (found.votes > most.votes) {
      most = found;
      best = candidate;
      needed = triplesNeeded(double(most.close) / problem.size());
    }
  }
  return best;
}

// Robust size of the whitened residuals, at least 1. ratios: squared whitened residuals, reordered.
double residualScale(std::vector<double>& ratios) {
  if (ratios.empty()) return 1;
  const auto middle = ratios.begin() + ratios.size() / 2;
  std::nth_element(ratios.begin(), middle, ratios.end());
  // The median of chi-square with two degrees of freedom is 2 ln 2.
  return std::max(1.0, std::sqrt(*middle / (2 * std::log(2.0))));
}

// Sums of the normal equations. Only the lower triangle of the information is filled.
struct Normal {
  Matrix9d information = Matrix9d::Zero();
  Vector9d right = Vector9d::Zero();
  int count = 0;

  // Adds weight J' J and weight J' r of one whitened residual.
  void add(const Eigen::Matrix<double, 1, 9>& jacobian, double residual, double weight) {
    for (int j = 0; j < 9; ++j) {
      const double scaled = weight * jacobian[j];
      right[j] += scaled * residual;
      for (int i = j; i < 9; ++i) information(i, j) += scaled * jacobian[i];
    }
  }
};

// The problem linearised at a state, with all rows whitened by their covariances. Keeps its memory.
class WhitenedRows {
 public:
  void assign(const Problem& problem, const State& state) {
    rows_.resize(problem.size());
    ratios_.clear();
    for (size_t i = 0; i < problem.size(); ++i) {
      Linearised& row = rows_[i] = problem.linearise(state, i);
      if (!row.usable) continue;
      const bool near = row.residual.squaredNorm() <= 4 * kTolerance * kTolerance;
      whiten(row);
      if (near) ratios_.push_back(row.residual.squaredNorm());
    }
    scale_ = residualScale(ratios_);
  }

  Normal accumulate(std::vector<char>& inliers) const {
    Normal sums;
    const double unit = 1 / (scale_ * scale_);
    for (size_t i = 0; i < rows_.size(); ++i) {
      const Linearised& row = rows_[i];
      inliers[i] = 0;
      if (!row.usable) continue;
      const double ratio = unit * row.residual.squaredNorm() / (kTukey * kTukey);
      if (ratio >= 1) continue;
      const double weight = unit * (1 - ratio) * (1 - ratio);
      for (int k = 0; k < 2; ++k) sums.add(row.jacobian.row(k), row.residual[k], weight);
      inliers[i] = 1;
      ++sums.count;
    }
    return sums;
  }

 private:
  // Multiplies by the inverse of the covariance's Cholesky factor.
  static void whiten(Linearised& row) {
    const double a = std::sqrt(row.covariance(0, 0)), b = row.covariance(1, 0) / a;
    const double c = std::sqrt(std::max(1e-12, row.covariance(1, 1) - b * b));
    row.residual[0] /= a;
    row.residual[1] = (row.residual[1] - b * row.residual[0]) / c;
    row.jacobian.row(0) /= a;
    row.jacobian.row(1) = (row.jacobian.row(1) - b * row.jacobian.row(0)) / c;
  }

  std::vector<Linearised> rows_;
  std::vector<double> ratios_;
  double scale_ = 1;
};

// Adds a rotation known beforehand to the normal equations: as a perturbation of Q on the left.
void addRotation(const RotationPrior& prior, const State& state, Normal& sums) {
  const Eigen::Matrix3d information = (state.Q * prior.covariance * state.Q.transpose()).inverse();
  sums.information.topLeftCorner<3, 3>() += information;
  sums.right.head<3>() += information * rotationVector(prior.R.transpose() * state.Q.transpose());
}

// The prior's covariance has rank 2; along the normal itself nothing may change, because it sets the scale.
Eigen::Matrix3d priorInformation(const Eigen::Vector3d& normal, const Eigen::Matrix3d& covariance) {
  constexpr double kFixed = 1e-6;
  return (covariance + kFixed * kFixed * (Eigen::Matrix3d::Identity() + normal * normal.transpose()))
      .inverse();
}

}  // namespace

Expected<MotionEstimate> estimateMotion(const StereoRig& rig, const std::vector<TemporalMatch>& matches,
                                        const Eigen::Vector3d& normal,
                                        const Eigen::Matrix3d& normal_covariance, const CameraMotion& start,
                                        int min_matches, const RotationPrior* rotation) {
  constexpr int kIterations = 8;
  constexpr double kConverged = 1e-5;  // rad and shares of the height: a hundredth of a pixel
  if (static_cast<int>(matches.size()) < std::max(4, min_matches)) {
    return tl::make_unexpected(Failure{Reason::kTooFewMatches, std::to_string(matches.size()) +
                                                                   " corners followed, at least " +
                                                                   std::to_string(min_matches) + " needed"});
  }
  const Problem problem(rig, matches);
  State state = bestByConsensus(problem, {start.R.transpose(), start.t, normal});
  const Eigen::Matrix3d prior = priorInformation(normal, normal_covariance);
  MotionEstimate result;
  result.inliers.assign(matches.size(), 0);
  Matrix9d information;
  static thread_local WhitenedRows rows;  // kept, as they are large
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    rows.assign(problem, state);
    Normal sums = rows.accumulate(result.inliers);
    result.inlier_count = sums.count;
    if (sums.count < min_matches) {
      return tl::make_unexpected(Failure{
          Reason::kMotionInconsistent, std::to_string(sums.count) + " of " + std::to_string(matches.size()) +
                                           " matches agree, at least " + std::to_string(min_matches) +
                                           " needed"});
    }
    sums.information.bottomRightCorner<3, 3>() += prior;
    sums.right.tail<3>() += prior * (normal - state.n);
    if (rotation != nullptr) addRotation(*rotation, state, sums);
    information = sums.information.selfadjointView<Eigen::Lower>();
    const Vector9d step = information.ldlt().solve(sums.right);
    state = state.apply(step);
    if (step.norm() < kConverged) break;
  }
  const Matrix9d covariance = information.ldlt().solve(Matrix9d::Identity());
  if (!covariance.allFinite() || !state.t.allFinite() || !(covariance.diagonal().minCoeff() >= 0)) {
    return tl::make_unexpected(
        Failure{Reason::kMotionInconsistent, "the matches do not determine the motion"});
  }
  result.motion = {state.Q.transpose(), state.t};
  result.normal = state.n;
  // Perturbations of Q on the left (frame then) to those of R on the left (frame now): -R w.
  Matrix9d turn = Matrix9d::Identity();
  turn.topLeftCorner<3, 3>() = -state.Q.transpose();
  result.covariance = turn * covariance * turn.transpose();
  return result;
}

}  // namespace uav_landing
