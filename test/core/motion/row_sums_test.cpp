#include "motion/step/row_sums.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <random>
#include <vector>

namespace uav_landing {
namespace {

constexpr int kNodes = 3, kResiduals = 60;
constexpr Eigen::Index kRotations = 3 * kNodes;

/// A least squares problem with random rows: residual = motion, rotations of the nodes, minus the time.
struct Problem {
  Eigen::MatrixXd by_motion, by_rotation;
  Eigen::VectorXd by_time, residual;
  Eigen::MatrixXd root;  // of the covariance of the rotations
  Matrix9d prior;        // of another problem with a prior
  Vector9d pull;

  explicit Problem(unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    const auto any = [&](Eigen::Index rows, Eigen::Index columns) {
      Eigen::MatrixXd matrix(rows, columns);
      for (Eigen::Index i = 0; i < matrix.size(); ++i) matrix.data()[i] = normal(random);
      return matrix;
    };
    by_motion = any(kResiduals, 9);
    by_rotation = any(kResiduals, kRotations);
    by_time = any(kResiduals, 1);
    residual = any(kResiduals, 1);
    root = 0.3 * any(kRotations, 2);
    const Eigen::MatrixXd some = any(9, 9);
    prior = some * some.transpose();
    pull = any(9, 1);
    // The motion fits best without rotations.
    residual -=
        by_motion * (by_motion.transpose() * by_motion).ldlt().solve(by_motion.transpose() * residual);
  }

  RowSums sums() const {
    std::vector<RowNode> nodes(kNodes);
    nodes[0].squares = residual.squaredNorm();
    nodes[0].count = kResiduals / 2;
    Matrix9d information = by_motion.transpose() * by_motion;
    SumsByTime time;
    time.with_motion = by_motion.transpose() * by_time;
    time.information = by_time.squaredNorm();
    time.right = by_time.dot(residual);
    RowSums sums(nodes, {information, information + prior, pull}, time);
    sums.rotation = by_rotation.transpose() * by_rotation;
    sums.with_motion = by_rotation.transpose() * by_motion;
    sums.score = by_rotation.transpose() * residual;
    sums.with_time = by_rotation.transpose() * by_time;
    return sums;
  }
  /// Inverse covariance of the residuals, with the rotations as noise.
  Eigen::MatrixXd weights() const {
    const Eigen::MatrixXd moved = by_rotation * root;
    return (Eigen::MatrixXd::Identity(kResiduals, kResiduals) + moved * moved.transpose()).inverse();
  }
};

// Unknowns of a known covariance that are taken out are noise of the residuals, and the other way round.
TEST(RowSums, AreThoseOfResidualsWithTheRotationsAsNoise) {
  for (const unsigned seed : {1u, 2u}) {
    const Problem problem(seed);
    RowSums sums = problem.sums();
    const Vector9d step = sums.takeOut(problem.root);
    const Eigen::MatrixXd W = problem.weights();
    const Matrix9d information = problem.by_motion.transpose() * W * problem.by_motion;
    const Vector9d wanted = information.ldlt().solve(problem.by_motion.transpose() * W * problem.residual);
    EXPECT_LT((sums.motion.information - information).norm(), 1e-9 * information.norm());
    EXPECT_LT((step - wanted).norm(), 1e-9);
    EXPECT_GT(step.norm(), 1e-3) << "the rotations must matter";
    const Eigen::VectorXd left = problem.residual - problem.by_motion * step;
    const auto same = [](const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
      return (a - b).norm() <= 1e-9 * b.norm();
    };
    EXPECT_TRUE(same(sums.rotation, problem.by_rotation.transpose() * W * problem.by_rotation));
    EXPECT_TRUE(same(sums.with_motion, problem.by_rotation.transpose() * W * problem.by_motion));
    EXPECT_TRUE(same(sums.score, problem.by_rotation.transpose() * W * left));
    EXPECT_TRUE(same(sums.with_time, problem.by_rotation.transpose() * W * problem.by_time));
    EXPECT_NEAR(sums.by_time.information, problem.by_time.dot(W * problem.by_time), 1e-9);
    EXPECT_NEAR(sums.by_time.right, problem.by_time.dot(W * left), 1e-9);
    EXPECT_TRUE(same(sums.by_time.with_motion, problem.by_motion.transpose() * W * problem.by_time));
    EXPECT_NEAR(sums.squares, left.dot(W * left), 1e-9);
    // With another prior, its information and right side at the motion before.
    const Matrix9d with_prior = information + problem.prior;
    EXPECT_TRUE(same(sums.motion.information_with_any_normal, with_prior));
    const Vector9d right = problem.by_motion.transpose() * W * left + problem.pull - problem.prior * step;
    EXPECT_TRUE(same(sums.motion.right_with_any_normal, right));
  }
}

TEST(RowSums, StayAsTheyAreWithoutARotation) {
  const Problem problem(3);
  RowSums sums = problem.sums();
  const Vector9d step = sums.takeOut(Eigen::MatrixXd::Zero(kRotations, 2));
  EXPECT_LT(step.norm(), 1e-12);
  EXPECT_LT((sums.motion.information - problem.sums().motion.information).norm(), 1e-12);
  EXPECT_NEAR(sums.squares, problem.residual.squaredNorm(), 1e-12);
}

}  // namespace
}  // namespace uav_landing
