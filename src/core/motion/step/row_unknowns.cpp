#include "motion/step/row_unknowns.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace uav_landing {
namespace {

constexpr double kApart = 1e-3;  // s, difference of readout times for the derivatives

/// The same matches with a readout time that is longer by kApart, linearised at the same state.
const MotionRows& laterRows(const StereoRig& rig, const std::vector<TemporalMatch>& matches,
                            const MotionState& state, MotionMemory& memory) {
  memory.shifted = matches;
  for (TemporalMatch& match : memory.shifted) match.then += kApart * match.by_readout;
  MotionRows& later = memory.drawn;
  later.assign(rig, memory.shifted);
  later.linearise(state);
  return later;
}

SumsByTime sumsByReadout(const MotionRows& rows, const MotionRows& later, const Vector9d& step,
                         double factor) {
  SumsByTime sums = rows.sumsByTime(later, kApart, step);
  sums.with_motion /= factor;
  sums.information /= factor;
  sums.right /= factor;
  return sums;
}

std::vector<RowNode> rowNodes(const RowTimes& times, const std::vector<TemporalMatch>& matches,
                              const FittedRows& fitted, const MotionRows* later) {
  std::vector<double> shares;
  shares.reserve(matches.size());
  for (const TemporalMatch& match : matches)
    shares.push_back(times.at(match.now.x(), match.now.y()) / times.readoutTime());
  std::vector<RowNode> nodes = fitted.rows.rowNodes(shares, fitted.step, later, kApart);
  for (RowNode& node : nodes) {
    node.rotation /= fitted.factor;
    node.with_next /= fitted.factor;
    node.with_motion /= fitted.factor;
    node.with_time /= fitted.factor;
    node.score /= fitted.factor;
    node.squares /= fitted.factor;
  }
  return nodes;
}

// Root of the covariance of the nodes' rotations, when the whole readout has a turn of this covariance.
Eigen::MatrixXd rootOfTurn(const std::vector<RowNode>& nodes, const Eigen::Matrix3d& covariance) {
  // A covariance of a lower rank has no exact root of this kind.
  const double little = 1e-6 * covariance.trace();
  const Eigen::Matrix3d root = (covariance + little * Eigen::Matrix3d::Identity()).llt().matrixL();
  Eigen::MatrixXd all(3 * nodes.size(), 3);
  for (size_t i = 0; i < nodes.size(); ++i) all.middleRows<3>(3 * i) = nodes[i].share * root;
  return all;
}

// Rotations of the nodes that an error of the delay makes, for 1 s. Q: from now to then.
Eigen::VectorXd turnsByDelay(const std::vector<RowNode>& nodes, const DelayDoubt& delay,
                             const Eigen::Matrix3d& Q) {
  const auto byDelay = [](const GyroTurn& gyro, double seconds) -> Eigen::Vector3d {
    return gyro.rows->rateAt(seconds + gyro.late) - gyro.rows->rateAt(gyro.late);
  };
  Eigen::VectorXd turns(3 * nodes.size());
  for (size_t i = 0; i < nodes.size(); ++i) {
    const double seconds = nodes[i].share * delay.readout;
    turns.segment<3>(3 * i) = byDelay(delay.then, seconds) - Q * byDelay(delay.now, seconds);
  }
  return turns;
}

DelayEffect effectOf(const RowSums& sums, const Eigen::VectorXd& turns) {
  const Vector9d with_motion = sums.with_motion.transpose() * turns;
  return {
      turns.dot(sums.rotation * turns) - with_motion.dot(sums.motion.information.ldlt().solve(with_motion)),
      turns.dot(sums.score)};
}

}  // namespace

RowUnknowns findRowUnknowns(const StereoRig& rig, const std::vector<TemporalMatch>& matches,
                            const FittedRows& fitted, const RowDoubt& doubt, MotionMemory& memory) {
  RowUnknowns found;
  found.information = found.without_shake = fitted.motion.information;
  found.has_time = std::any_of(matches.begin(), matches.end(),
                               [](const TemporalMatch& match) { return !match.by_readout.isZero(0); });
  const MotionRows* later = found.has_time ? &laterRows(rig, matches, fitted.linearised, memory) : nullptr;
  if (later != nullptr) found.by_time = sumsByReadout(fitted.rows, *later, fitted.step, fitted.factor);
  if (doubt.shake.rows == nullptr || doubt.shake.memory == nullptr) return found;
  const std::vector<RowNode> nodes = rowNodes(*doubt.shake.rows, matches, fitted, later);
  if (nodes.empty()) return found;
  RowSums sums(nodes, fitted.motion, found.by_time);
  if (!doubt.turn.isZero(0)) found.step = sums.takeOut(rootOfTurn(nodes, doubt.turn));
  if (doubt.delay.variance > 0) {
    const Eigen::VectorXd turns = turnsByDelay(nodes, doubt.delay, fitted.linearised.Q);
    found.delay = effectOf(sums, turns);
    found.step += sums.takeOut(std::sqrt(doubt.delay.variance) * turns);
  }
  found.without_shake = sums.motion.information;
  found.shake = findRowShake(doubt.shake, memory.shapes, sums);
  found.step += found.shake.step;
  found.information = sums.motion.information;
  found.by_time = sums.by_time;
  return found;
}

}  // namespace uav_landing
