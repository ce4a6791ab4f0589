#include "motion/step/row_sums.h"

#include <Eigen/Cholesky>

namespace uav_landing {

RowSums::RowSums(const std::vector<RowNode>& nodes, const MotionUnknown& of_motion, const SumsByTime& of_time)
    : motion(of_motion), by_time(of_time) {
  const auto n = static_cast<Eigen::Index>(nodes.size());
  rotation.setZero(3 * n, 3 * n);
  with_motion.resize(3 * n, 9);
  score.resize(3 * n);
  with_time.resize(3 * n);
  for (Eigen::Index i = 0; i < n; ++i) {
    rotation.block<3, 3>(3 * i, 3 * i) = nodes[i].rotation;
    if (i + 1 < n) {
      rotation.block<3, 3>(3 * i, 3 * i + 3) = nodes[i].with_next;
      rotation.block<3, 3>(3 * i + 3, 3 * i) = nodes[i].with_next;
    }
    with_motion.middleRows<3>(3 * i) = nodes[i].with_motion;
    score.segment<3>(3 * i) = nodes[i].score;
    with_time.segment<3>(3 * i) = nodes[i].with_time;
    squares += nodes[i].squares;
    count += nodes[i].count;
  }
}

// With K = L L', (N + K^-1)^-1 is L (1 + L' N L)^-1 L'.
Vector9d RowSums::takeOut(const Eigen::MatrixXd& root, double noise) {
  const Eigen::Index n = root.cols();
  const Eigen::LDLT<Eigen::MatrixXd> inner(Eigen::MatrixXd::Identity(n, n) +
                                           root.transpose() * rotation * root / noise);
  const auto hidden = [&](const Eigen::MatrixXd& right) -> Eigen::MatrixXd {
    return root * inner.solve(root.transpose() * right) / noise;
  };
  const Eigen::MatrixXd of_motion = hidden(with_motion), of_rotation = hidden(rotation);
  const Eigen::VectorXd of_score = hidden(score), of_time = hidden(with_time);
  const Matrix9d taken = with_motion.transpose() * of_motion;
  const Vector9d pull = with_motion.transpose() * of_score;
  motion.information -= taken;
  motion.information_with_any_normal -= taken;
  const Vector9d step = -motion.information.ldlt().solve(pull);
  motion.right_with_any_normal -= pull + motion.information_with_any_normal * step;
  // Residuals grow with the readout time, so its terms have the opposite sign.
  by_time.information -= with_time.dot(of_time);
  by_time.with_motion -= with_motion.transpose() * of_time;
  by_time.right -= with_time.dot(of_score) + by_time.with_motion.dot(step);
  squares += pull.dot(step) - score.dot(of_score);
  with_motion -= rotation * of_motion;
  score -= rotation * of_score + with_motion * step;
  with_time -= rotation * of_time;
  rotation -= rotation * of_rotation;
  return step;
}

}  // namespace uav_landing
