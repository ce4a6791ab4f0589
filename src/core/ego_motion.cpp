#include "uav_landing/ego_motion.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>

namespace uav_landing {
namespace {

using Vector9d = Eigen::Matrix<double, 9, 1>;
using Matrix9d = Eigen::Matrix<double, 9, 9>;

constexpr int kRansacIterations = 80;
// Distance, in pixels, by which a match may miss a motion in the consensus step.
constexpr double kTolerance = 2.0;
constexpr double kTukey = 4.5;

Eigen::Matrix3d cross(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

Eigen::Matrix3d exponential(const Eigen::Vector3d& w) {
  const double angle = w.norm();
  if (angle < 1e-12) return Eigen::Matrix3d::Identity() + cross(w);
  return Eigen::AngleAxisd(angle, w / angle).toRotationMatrix();
}

// The unknowns: rotation now -> then (perturbed on the left), translation, ground normal.
struct State {
  Eigen::Matrix3d Q;
  Eigen::Vector3d t, n;

  State apply(const Vector9d& step) const {
    return {exponential(step.head<3>()) * Q, t + step.segment<3>(3), n + step.tail<3>()};
  }
};

// Residual of one match with its Jacobian by (rotation, t, n).
struct Linearised {
  bool usable = false;
  Eigen::Vector2d residual;
  Eigen::Matrix<double, 2, 9> jacobian;
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
    result.jacobian.leftCols<3>() = -projection * cross(y);
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

double consensus(const Problem& problem, const State& state) {
  double votes = 0;
  for (size_t i = 0; i < problem.size(); ++i) {
    const double ratio = problem.squaredError(state, i) / (kTolerance * kTolerance);
    if (ratio < 1) votes += 1 - ratio;
  }
  return votes;
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
  double votes = consensus(problem, start);
  std::mt19937 random(20100602u);
  for (int iteration = 0; iteration < kRansacIterations; ++iteration) {
    const std::array<size_t, 3> chosen = {random() % problem.size(), random() % problem.size(),
                                          random() % problem.size()};
    if (chosen[0] == chosen[1] || chosen[1] == chosen[2] || chosen[0] == chosen[2]) continue;
    State candidate = best;
    if (!solveTriple(problem, chosen, candidate)) continue;
    const double candidate_votes = consensus(problem, candidate);
    if (candidate_votes > votes) {
      votes = candidate_votes;
      best = candidate;
    }
  }
  return best;
}

// Robust size of the whitened residuals, at least 1.
double residualScale(const Problem& problem, const State& state) {
  std::vector<double> ratios;
  for (size_t i = 0; i < problem.size(); ++i) {
    const Linearised row = problem.linearise(state, i);
    if (!row.usable || row.residual.norm() > 2 * kTolerance) continue;
    ratios.push_back(row.residual.dot(row.covariance.inverse() * row.residual));
  }
  if (ratios.empty()) return 1;
  const auto middle = ratios.begin() + ratios.size() / 2;
  std::nth_element(ratios.begin(), middle, ratios.end());
  // The median of chi-square with two degrees of freedom is 2 ln 2.
  return std::max(1.0, std::sqrt(*middle / (2 * std::log(2.0))));
}

struct Normal {
  Matrix9d information;
  Vector9d right;
  int count = 0;
};

Normal accumulate(const Problem& problem, const State& state, double scale, std::vector<char>& inliers) {
  Normal sums{Matrix9d::Zero(), Vector9d::Zero(), 0};
  for (size_t i = 0; i < problem.size(); ++i) {
    inliers[i] = 0;
    const Linearised row = problem.linearise(state, i);
    if (!row.usable) continue;
    const Eigen::Matrix2d information = row.covariance.inverse() / (scale * scale);
    const double ratio = row.residual.dot(information * row.residual) / (kTukey * kTukey);
    if (ratio >= 1) continue;
    const double weight = (1 - ratio) * (1 - ratio);
    sums.information += weight * row.jacobian.transpose() * information * row.jacobian;
    sums.right += weight * row.jacobian.transpose() * information * row.residual;
    inliers[i] = 1;
    ++sums.count;
  }
  return sums;
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
                                        int min_matches) {
  constexpr int kIterations = 8;
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
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    Normal sums = accumulate(problem, state, residualScale(problem, state), result.inliers);
    result.inlier_count = sums.count;
    if (sums.count < min_matches) {
      return tl::make_unexpected(Failure{
          Reason::kMotionInconsistent, std::to_string(sums.count) + " of " + std::to_string(matches.size()) +
                                           " matches agree, at least " + std::to_string(min_matches) +
                                           " needed"});
    }
    sums.information.bottomRightCorner<3, 3>() += prior;
    sums.right.tail<3>() += prior * (normal - state.n);
    information = sums.information;
    const Vector9d step = information.ldlt().solve(sums.right);
    state = state.apply(step);
    if (step.norm() < 1e-9) break;
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
