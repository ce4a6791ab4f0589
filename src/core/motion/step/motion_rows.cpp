#include "motion/step/motion_rows.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "estimation/robust.h"
#include "geometry/rotation.h"
#include "kernels/lanes/lanes.h"
#include "kernels/samples/seen_rays.h"

namespace uav_landing {
namespace {

constexpr double kTukey = TukeyEnd::kTemporal;

RayView viewOf(const MotionState& state, const Eigen::Vector4d& camera) {
  RayView view;
  const Eigen::Vector3d turned = state.Q * state.t;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) view.Q[i][j] = state.Q(i, j);
    view.t[i] = state.t[i];
    view.n[i] = state.n[i];
    view.Qt[i] = turned[i];
  }
  view.fx = camera[0];
  view.fy = camera[1];
  view.cx = camera[2];
  view.cy = camera[3];
  return view;
}

}  // namespace

MotionState MotionState::apply(const Vector9d& step) const {
  return {rotationMatrix(step.head<3>()) * Q, t + step.segment<3>(3), n + step.tail<3>()};
}

// Memory never shrinks. Only the padding of the columns is set here; the callers write the rest.
void MotionRows::resize(size_t count) {
  count_ = count;
  padded_ = wholeDoubleLanes(count);
  inputs_.resize(std::max(inputs_.size(), kRayColumns * padded_));
  outputs_.resize(std::max(outputs_.size(), kRayOutputs * padded_));
  for (size_t column = 0; column < kRayColumns; ++column)
    for (size_t i = count_; i < padded_; ++i)
      inputs_[column * padded_ + i] = column == kRayXX || column == kRayYY ? 1 : 0;
}

void MotionRows::assign(const StereoRig& rig, const std::vector<TemporalMatch>& matches) {
  camera_ = {rig.fx, rig.fy, rig.cx, rig.cy};
  resize(matches.size());
  for (size_t i = 0; i < count_; ++i) {
    const TemporalMatch& match = matches[i];
    const Eigen::Vector3d ray = rig.ray(match.now.x(), match.now.y());
    const auto set = [&](RayColumn column, double value) { inputs_[column * padded_ + i] = value; };
    set(kRayX, ray.x());
    set(kRayY, ray.y());
    set(kRayU, match.then.x());
    set(kRayV, match.then.y());
    set(kRayXX, match.covariance(0, 0));
    set(kRayXY, match.covariance(1, 0));
    set(kRayYY, match.covariance(1, 1));
    set(kRayOnPlane, match.on_plane ? 1 : 0);
    set(kRayDepth, match.inverse_depth);
    set(kRayDepthStddev, match.on_plane ? 0 : match.inverse_depth_stddev);
    const Eigen::Vector2d seen =
        match.then + match.by_warp[0] * match.warp.col(0) + match.by_warp[1] * match.warp.col(1);
    set(kRaySeenU, seen.x());
    set(kRaySeenV, seen.y());
    for (int k = 0; k < 4; ++k) {
      inputs_[(kRayRight + k) * padded_ + i] = match.by_warp[0](k / 2, k % 2);
      inputs_[(kRayBelow + k) * padded_ + i] = match.by_warp[1](k / 2, k % 2);
    }
  }
}

void MotionRows::assign(const MotionRows& all, const std::array<size_t, 3>& chosen) {
  camera_ = all.camera_;
  resize(chosen.size());
  for (size_t column = 0; column < kRayColumns; ++column)
    for (size_t i = 0; i < count_; ++i)
      inputs_[column * padded_ + i] = all.inputs_[column * all.padded_ + chosen[i]];
}

MotionSupport MotionRows::support(const MotionState& state) const {
  return supportOf(viewOf(state, camera_), inputs_.data(), padded_, count_, kTolerance);
}

void MotionRows::linearise(const MotionState& state) {
  uav_landing::linearise(viewOf(state, camera_), inputs_.data(), padded_, outputs_.data());
  for (size_t i = count_; i < padded_; ++i) outputs_[kRaySquares * padded_ + i] = kRayBehind;
}

// Robust size of the residuals over their standard deviations.
double MotionRows::residualScale() {
  const double *squares = &outputs_[kRaySquares * padded_], *ratios = &outputs_[kRayRatio * padded_];
  ratios_.resize(count_);
  size_t used = 0;
  for (size_t i = 0; i < count_; ++i) {
    ratios_[used] = ratios[i];
    used += squares[i] <= 4 * kTolerance * kTolerance;
  }
  if (used == 0) return 1;
  ratios_.resize(used);
  // The median of chi-square with two degrees of freedom is 2 ln 2.
  return std::sqrt(medianOf(ratios_) / (2 * std::log(2.0)));
}

MotionNormal MotionRows::accumulate(std::vector<char>& inliers) {
  const double residual_scale = residualScale(), scale = std::max(1.0, residual_scale);
  const auto column = [&](int index) { return outputs_.data() + index * padded_; };
  weighRays(column(kRaySquares), column(kRayRatio), padded_, 1 / (scale * scale), kTukey * kTukey,
            column(kRayWeight));
  RayBlocks sums{};
  for (const int row : {0, kRayRow})
    addUpRays(column(row), column(row + kRayPrecision), column(kRayWeight), padded_, sums);
  MotionNormal normal;
  normal.residual_scale = residual_scale;
  for (int i = 0, block = 0; i < 3; ++i) {
    for (int j = 0; j <= i; ++j, ++block)
      for (int k = 0; k < 9; ++k)
        normal.information(3 * i + k / 3, 3 * j + k % 3) = RayBlocks::total(sums.information[block][k]);
    for (int k = 0; k < 3; ++k) normal.right[3 * i + k] = RayBlocks::total(sums.right[i][k]);
  }
  for (size_t i = 0; i < count_; ++i) {
    inliers[i] = column(kRayWeight)[i] > 0;
    normal.count += inliers[i];
  }
  return normal;
}

Vector9d MotionRows::score(size_t match, const Vector9d& step) const {
  Vector9d score = Vector9d::Zero();
  const auto value = [&](int column) { return outputs_[column * padded_ + match]; };
  for (const int row : {0, kRayRow}) {
    Vector9d by;
    for (int k = 0; k < kRayUnknowns; ++k) by[k] = value(row + k);
    score += value(kRayWeight) * value(row + kRayPrecision) * (value(row + kRayResidual) - by.dot(step)) * by;
  }
  return score;
}

SumsByTime MotionRows::sumsByTime(const MotionRows& later, double seconds, const Vector9d& step) const {
  SumsByTime sums;
  for (size_t match = 0; match < count_; ++match) {
    const double weight = outputs_[kRayWeight * padded_ + match];
    if (!(weight > 0)) continue;
    const auto value = [&](int column) { return outputs_[column * padded_ + match]; };
    for (const int row : {0, kRayRow}) {
      const double residual = value(row + kRayResidual);
      const double by_time =
          (later.outputs_[(row + kRayResidual) * later.padded_ + match] - residual) / seconds;
      Vector9d by;
      for (int k = 0; k < kRayUnknowns; ++k) by[k] = value(row + k);
      const double weighted = weight * value(row + kRayPrecision) * by_time;
      sums.with_motion += weighted * by;
      sums.information += weighted * by_time;
      sums.right += weighted * (residual - by.dot(step));
    }
  }
  return sums;
}

std::vector<RowNode> MotionRows::rowNodes(const std::vector<double>& shares, const Vector9d& step,
                                          const MotionRows* later, double seconds) const {
  if (shares.empty()) return {};
  const auto [least, most] = std::minmax_element(shares.begin(), shares.end());
  const int first = static_cast<int>(std::floor(RowNode::kInReadout * *least));
  std::vector<RowNode> list(static_cast<int>(std::floor(RowNode::kInReadout * *most)) - first + 2);
  for (size_t i = 0; i < list.size(); ++i)
    list[i].share = (first + static_cast<double>(i)) / RowNode::kInReadout;
  for (size_t match = 0; match < count_; ++match) {
    const double weight = outputs_[kRayWeight * padded_ + match];
    if (!(weight > 0)) continue;
    const double place = RowNode::kInReadout * shares[match] - first;
    const size_t above = std::min(static_cast<size_t>(place), list.size() - 2);
    const std::array<double, 2> parts = {static_cast<double>(above) + 1 - place,
                                         place - static_cast<double>(above)};
    const std::array<RowNode*, 2> nodes = {&list[above], &list[above + 1]};
    const auto value = [&](int column) { return outputs_[column * padded_ + match]; };
    for (const int row : {0, kRayRow}) {
      Vector9d by;
      for (int k = 0; k < kRayUnknowns; ++k) by[k] = value(row + k);
      const double residual = value(row + kRayResidual), left = residual - by.dot(step);
      const double precision = weight * value(row + kRayPrecision);
      const Eigen::Vector3d turn = by.head<3>();
      const double time =
          later ? (later->outputs_[(row + kRayResidual) * later->padded_ + match] - residual) / seconds : 0;
      for (int i : {0, 1}) {
        nodes[i]->rotation += precision * parts[i] * parts[i] * turn * turn.transpose();
        nodes[i]->with_motion += precision * parts[i] * turn * by.transpose();
        nodes[i]->score += precision * parts[i] * left * turn;
        nodes[i]->with_time += precision * parts[i] * time * turn;
      }
      nodes[0]->with_next += precision * parts[0] * parts[1] * turn * turn.transpose();
      nodes[0]->squares += precision * left * left;
    }
    nodes[0]->count += 1;
  }
  return list;
}

Eigen::Matrix<double, 6, 1> MotionRows::solveExactly() const {
  Eigen::Matrix<double, 6, 6> A;
  Eigen::Matrix<double, 6, 1> b;
  for (int match = 0; match < 3; ++match) {
    const auto value = [&](int column) { return outputs_[column * padded_ + match]; };
    if (value(kRaySquares) >= kRayBehind)
      return Eigen::Matrix<double, 6, 1>::Constant(std::numeric_limits<double>::quiet_NaN());
    for (int row = 0; row < 2; ++row) {
      for (int j = 0; j < 6; ++j) A(2 * match + row, j) = value(row * kRayRow + j);
      b[2 * match + row] = value(row * kRayRow + kRayResidual);
    }
  }
  return A.partialPivLu().solve(b);
}

}  // namespace uav_landing
