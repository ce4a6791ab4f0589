#include "motion/step/ego_motion.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <string>
#include <utility>

#include "estimation/convergence.h"
#include "estimation/ransac.h"
#include "geometry/rotation.h"
#include "image/input/image_cells.h"
#include "image/windows/window_overlap.h"

namespace uav_landing {
namespace {

// If this share of the telling matches is close to the start, a very different motion would have fewer.
constexpr double kMostlyClose = 0.8;
constexpr int kFewestTelling = 20;
// Least share of their claimed standard deviations that matches are given, however well they agree. An error
// that is the same all over the image shows in no residual.
constexpr double kLeastScale = 0.5;

// Finds the rotation and translation that fit three matches exactly: two Newton steps with the normal fixed.
bool solveTriple(MotionRows& triple, MotionState& state) {
  for (int iteration = 0; iteration < 2; ++iteration) {
    triple.linearise(state);
    const Eigen::Matrix<double, 6, 1> x = triple.solveExactly();
    if (!x.allFinite() || x.head<3>().norm() > 0.5) return false;
    Vector9d step = Vector9d::Zero();
    step.head<6>() = x;
    state = state.apply(step);
  }
  return true;
}

MotionState bestByConsensus(const MotionState& start, MotionMemory& memory) {
  const MotionRows& all = memory.all;
  MotionRows& triple = memory.drawn;
  MotionState best = start;
  MotionSupport most = all.support(start);
  if (most.telling >= kFewestTelling && most.telling_close >= kMostlyClose * most.telling) return start;
  std::mt19937 random(20100602u);
  RansacBudget budget{RansacOptions()};
  budget.found(double(most.close) / all.size());
  while (budget.goesOn()) {
    budget.count();
    const std::array<size_t, 3> chosen = {random() % all.size(), random() % all.size(),
                                          random() % all.size()};
    if (chosen[0] == chosen[1] || chosen[1] == chosen[2] || chosen[0] == chosen[2]) continue;
    MotionState candidate = best;
    triple.assign(all, chosen);
    if (!solveTriple(triple, candidate)) continue;
    const MotionSupport found = all.support(candidate);
    if (found.votes > most.votes) {
      most = found;
      best = candidate;
      budget.found(double(most.close) / all.size());
    }
  }
  return best;
}

// Adds a known rotation to the normal equations, as a perturbation of Q on the left.
void addRotation(const RotationPrior& prior, const MotionState& state, MotionNormal& sums) {
  const Eigen::Matrix3d information = (state.Q * prior.covariance * state.Q.transpose()).inverse();
  sums.information.topLeftCorner<3, 3>() += information;
  sums.right.head<3>() += information * rotationVector(prior.R.transpose() * state.Q.transpose());
}

// The given ground normal as a prior, with the rotation when it is known.
struct GivenPrior {
  Eigen::Vector3d n;
  Eigen::Matrix3d information;
  const RotationPrior* rotation;

  // The normal's contribution to the right side of the normal equations.
  Eigen::Vector3d pull(const MotionState& state) const { return information * (n - state.n); }
  void addTo(const MotionState& state, MotionNormal& sums) const {
    sums.information.bottomRightCorner<3, 3>() += information;
    sums.right.tail<3>() += pull(state);
    if (rotation != nullptr) addRotation(*rotation, state, sums);
  }
};

// The prior's covariance has rank 2. The normal must not change along itself, because its length sets the
// scale.
Eigen::Matrix3d priorInformation(const Eigen::Vector3d& normal, const Eigen::Matrix3d& covariance) {
  constexpr double kFixed = 1e-6;
  return (covariance + kFixed * kFixed * (Eigen::Matrix3d::Identity() + normal * normal.transpose()))
      .inverse();
}

// Ground normal from the matches alone, relative to the one that was found with a prior.
struct OwnNormal {
  Eigen::Matrix3d covariance;  // if matches are independent
  // Derivatives of rotation and translation by the normal, as the matches tie them.
  Eigen::Matrix<double, 6, 3> by_it;
  Eigen::Vector3d step;  // from the normal that was found with the prior
};

// information: from the matches, on rotation, translation and normal. by_prior: right side from the prior, at
// the normal that was found.
std::optional<OwnNormal> freedOfPrior(const Matrix9d& information, const Eigen::Vector3d& normal,
                                      const Eigen::Vector3d& by_prior) {
  constexpr double kLeast = 1.0;  // 1/rad^2: a standard deviation of 1 rad says nothing
  OwnNormal own;
  own.by_it = -information.topLeftCorner<6, 6>().ldlt().solve(information.topRightCorner<6, 3>());
  const Eigen::Matrix3d left =
      information.bottomRightCorner<3, 3>() + information.bottomLeftCorner<3, 6>() * own.by_it;
  const Eigen::Matrix<double, 3, 2> across = tangents(normal);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(across.transpose() * left * across);
  if (!(axes.eigenvalues()[0] >= kLeast)) return std::nullopt;
  const Eigen::Matrix<double, 3, 2> directions = across * axes.eigenvectors();
  own.covariance = directions * axes.eigenvalues().cwiseInverse().asDiagonal() * directions.transpose();
  own.step = -own.covariance * by_prior;
  return own;
}

double overlapFactor(const std::vector<TemporalMatch>& matches) {
  WindowOverlap windows(matches.size());
  for (const TemporalMatch& match : matches) windows.add(match.now.x(), match.now.y(), match.extent);
  return windows.factor();
}

// The motion that fits best, and the state of the last iteration.
struct Fitted {
  MotionState state, linearised;
  Vector9d step;         // from linearised to state
  Matrix9d information;  // prior included
  double factor = 1;     // factor by which variances are larger than the rows claim
  std::vector<char> inliers = {};
  int inlier_count = 0;
};

// Extra covariance, because matches in one part of the image share errors. It uses the residuals at the
// matches' own normal. rows: linearised as in `fitted`.
Eigen::Matrix3d sharedVariance(const StereoRig& rig, const std::vector<TemporalMatch>& matches,
                               const MotionRows& rows, const Fitted& fitted, const OwnNormal& own) {
  Vector9d step;
  step << own.by_it * own.step, own.step;
  step += fitted.step;
  Eigen::Matrix<double, 3, 9> by_scores;
  by_scores << own.covariance * own.by_it.transpose(), own.covariance;
  by_scores /= fitted.factor;
  ClusterCovariance<3> clusters;
  for (size_t i = 0; i < matches.size(); ++i) {
    if (!fitted.inliers[i]) continue;
    clusters.add(imageCell(rig, matches[i].now.x(), matches[i].now.y()), by_scores * rows.score(i, step));
  }
  return clusters.shared();
}

// Information on the motion with the given normal almost ignored. The rig may make that normal wrong in the
// same way in every pair, and such an error would look like a readout time or like shake. information: with
// the prior.
Matrix9d withAnyNormal(Matrix9d information, const Eigen::Vector3d& normal, const Eigen::Matrix3d& prior) {
  constexpr double kAnySlope = 0.02;  // rad
  const Eigen::Matrix3d any =
      kAnySlope * kAnySlope * (Eigen::Matrix3d::Identity() - normal * normal.transpose());
  information.bottomRightCorner<3, 3>() += priorInformation(normal, any) - prior;
  return information;
}

// by_prior: right side from the prior of the normal, at the motion that fits best.
MotionUnknown motionUnknown(const Matrix9d& information, const GivenPrior& given,
                            const Eigen::Vector3d& by_prior) {
  MotionUnknown motion{information, withAnyNormal(information, given.n, given.information), Vector9d::Zero()};
  motion.right_with_any_normal.tail<3>() = -by_prior;
  return motion;
}

// Estimates the time as one more unknown by the Schur complement. Residuals grow with the time, so the
// missing part of the time is the one that removes them. by_prior: right side from the prior.
void tellTime(const SumsByTime& sums, const Matrix9d& without_prior, const Eigen::Vector3d& by_prior,
              ReadoutEffect& effect) {
  const Vector9d by_time = without_prior * sums.with_motion;
  effect.information = sums.information - sums.with_motion.dot(by_time);
  effect.score = -sums.right - by_time.tail<3>().dot(by_prior);
}

// rows: of the matches. They stay linearised as in the result.
Expected<Fitted> fitMotion(const std::vector<TemporalMatch>& matches, const MotionState& start,
                           const GivenPrior& given, int min_matches, MotionRows& rows) {
  constexpr int kIterations = 8;
  Fitted fitted{start, start, {}, {}};
  fitted.inliers.assign(matches.size(), 0);
  const double overlap = overlapFactor(matches);
  Convergence convergence;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    rows.linearise(fitted.state);
    MotionNormal sums = rows.accumulate(fitted.inliers);
    fitted.inlier_count = sums.count;
    if (sums.count < min_matches) {
      return tl::make_unexpected(Failure{
          Reason::kMotionInconsistent, std::to_string(sums.count) + " of " + std::to_string(matches.size()) +
                                           " matches agree, at least " + std::to_string(min_matches) +
                                           " needed"});
    }
    // Matches that agree better than they claim are trusted more (variance factor a posteriori).
    fitted.factor = overlap * std::pow(std::clamp(sums.residual_scale, kLeastScale, 1.0), 2);
    sums.information /= fitted.factor;
    sums.right /= fitted.factor;
    given.addTo(fitted.state, sums);
    fitted.information = sums.information.selfadjointView<Eigen::Lower>();
    fitted.step = fitted.information.ldlt().solve(sums.right);
    fitted.linearised = std::exchange(fitted.state, fitted.state.apply(fitted.step));
    if (convergence.reached(fitted.step, fitted.information)) break;
  }
  return fitted;
}

}  // namespace

Expected<MotionEstimate> estimateMotion(const StereoRig& rig, const std::vector<TemporalMatch>& matches,
                                        const MotionPrior& prior, int min_matches, MotionMemory& memory) {
  if (static_cast<int>(matches.size()) < std::max(4, min_matches)) {
    return tl::make_unexpected(Failure{Reason::kTooFewMatches, std::to_string(matches.size()) +
                                                                   " corners followed, at least " +
                                                                   std::to_string(min_matches) + " needed"});
  }
  MotionRows& rows = memory.all;
  rows.assign(rig, matches);
  const Eigen::Vector3d& normal = prior.normal.vector();
  const GivenPrior given{normal, priorInformation(normal, prior.normal.covariance()), prior.rotation};
  Expected<Fitted> found =
      fitMotion(matches, bestByConsensus({prior.start.R.transpose(), prior.start.t, normal}, memory), given,
                min_matches, rows);
  if (!found) return tl::make_unexpected(found.error());
  MotionState& state = found->state;
  Matrix9d& information = found->information;
  const RowUnknowns beside =
      findRowUnknowns(rig, matches,
                      {rows, found->linearised, found->step,
                       motionUnknown(information, given, given.pull(state)), found->factor},
                      prior.rows, memory);
  information = beside.information;
  if (!beside.step.isZero(0)) state = state.apply(beside.step);
  found->step += beside.step;
  const Matrix9d covariance = information.ldlt().solve(Matrix9d::Identity());
  if (!covariance.allFinite() || !state.t.allFinite() || !(covariance.diagonal().minCoeff() >= 0)) {
    return tl::make_unexpected(
        Failure{Reason::kMotionInconsistent, "the matches do not determine the motion"});
  }
  MotionEstimate result;
  result.motion = {state.Q.transpose(), state.t};
  result.normal = state.n;
  // Converts perturbations of Q on the left (frame then) to those of R on the left (frame now): -R w.
  Matrix9d turn = Matrix9d::Identity();
  turn.topLeftCorner<3, 3>() = -state.Q.transpose();
  result.covariance = turn * covariance * turn.transpose();
  if (beside.shake.found()) {
    const Matrix9d without_shake = beside.without_shake.ldlt().solve(Matrix9d::Identity());
    result.of_shake = turn * (covariance - without_shake) * turn.transpose();
  }
  const Vector9d& with_time = beside.by_time.with_motion;
  if (beside.has_time) {
    Vector9d moved = with_time;
    moved.tail<3>() += given.information * prior.rows.normal_by_readout;
    result.readout.by_time = turn * covariance * moved;
    const Matrix9d any_normal = withAnyNormal(information, normal, given.information);
    tellTime(beside.by_time, any_normal.ldlt().solve(Matrix9d::Identity()), given.pull(state),
             result.readout);
  }
  const Eigen::Matrix<double, 9, 3> by_normal = turn * covariance.rightCols<3>();
  result.of_normal = by_normal * given.information * by_normal.transpose();
  information.bottomRightCorner<3, 3>() -= given.information;
  if (const std::optional<OwnNormal> own = freedOfPrior(information, normal, given.pull(state))) {
    result.own_normal = (state.n + own->step).normalized();
    result.readout.own_normal_by_time =
        own->covariance * (with_time.tail<3>() + own->by_it.transpose() * with_time.head<6>());
    result.own_normal_covariance = own->covariance + sharedVariance(rig, matches, rows, *found, *own);
  }
  result.vibration = beside.shake.vibration;
  result.delay = beside.delay;
  result.inliers = std::move(found->inliers);
  result.inlier_count = found->inlier_count;
  return result;
}

Expected<MotionEstimate> estimateMotion(const StereoRig& rig, const std::vector<TemporalMatch>& matches,
                                        const MotionPrior& prior, int min_matches) {
  MotionMemory memory;
  return estimateMotion(rig, matches, prior, min_matches, memory);
}

}  // namespace uav_landing
