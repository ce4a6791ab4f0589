#include "motion/motion_rows.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "estimation/robust.h"
#include "geometry/rotation.h"
#include "kernels/lanes/lanes.h"
#include "kernels/lanes/multiversion.h"
#include "motion/motion_lanes.h"

namespace uav_landing {
namespace {

using motion_lanes::combine;
using motion_lanes::look;
using motion_lanes::Mask;
using motion_lanes::MatchRows;
using motion_lanes::Seen;
using motion_lanes::Terms;

constexpr double kTukey = TukeyEnd::kTemporal;
// Squared error of what lies behind it, pixels^2.
constexpr double kBehind = 1e9;
constexpr size_t kTile = 32;  // matches whose columns stay in the cache

// Votes and good fits of four matches. Where a match does not know, as along a line, any motion has its vote.
UAV_LANDING_MULTIVERSION void vote(const Terms& terms, const double* inputs, size_t padded, size_t count,
                                   MotionSupport& support) {
  constexpr double kClose = 0.0625;  // ratio of a match that misses by a quarter of the tolerance
  constexpr double kSquare = MotionRows::kTolerance * MotionRows::kTolerance;
  const DoubleLanes none{}, one = none + 1, last = none + static_cast<double>(count);
  DoubleLanes votes{}, close{}, telling{}, telling_close{}, index{0, 1, 2, 3};
  for (size_t i = 0; i < padded; i += kDoubleLanes, index += kDoubleLanes) {
    Seen at;
    const double* in = inputs + i;
    DoubleLanes rx, ry, then_u, then_v, xx, xy, yy;
    load(in, rx);
    load(in + kY * padded, ry);
    look(terms, rx, ry, in + kOnPlane * padded, in + kDepth * padded, at);
    load(in + kU * padded, then_u);
    load(in + kV * padded, then_v);
    const DoubleLanes error_u = then_u - at.u, error_v = then_v - at.v;
    load(in + kXX * padded, xx);
    load(in + kXY * padded, xy);
    load(in + kYY * padded, yy);
    const Mask tells = (index < last) & (xx + yy < kSquare);
    xx += kSquare;
    yy += kSquare;
    const DoubleLanes ratio =
        (yy * error_u * error_u - 2 * xy * error_u * error_v + xx * error_v * error_v) / (xx * yy - xy * xy);
    const Mask counts = at.seen & (index < last) & (ratio < 1);
    votes += counts ? 1 - ratio : none;
    const Mask fits = counts & (ratio < kClose);
    close += fits ? one : none;
    telling += tells ? one : none;
    telling_close += (fits & tells) ? one : none;
  }
  support.votes = sum(votes);
  support.close = static_cast<int>(sum(close));
  support.telling = static_cast<int>(sum(telling));
  support.telling_close = static_cast<int>(sum(telling_close));
}

// outputs: columns of both rows, squares, ratio.
UAV_LANDING_MULTIVERSION void lineariseAll(const Terms& s, const double* inputs, size_t padded,
                                           double* outputs) {
  constexpr double kLeastVariance = 1e-12;
  const DoubleLanes none{}, behind = none + kBehind;
  for (size_t i = 0; i < padded; i += kDoubleLanes) {
    const double* in = inputs + i;
    double* out = outputs + i;
    MatchRows rows;
    Mask seen;
    combine(s, in, padded, rows, seen);
    DoubleLanes u, v, xx, xy, yy, depth_stddev;
    load(in + kSeenU * padded, u);
    load(in + kSeenV * padded, v);
    load(in + kXX * padded, xx);
    load(in + kXY * padded, xy);
    load(in + kYY * padded, yy);
    load(in + kDepthStddev * padded, depth_stddev);  // none on the plane
    const DoubleLanes du = rows.depth_u * depth_stddev, dv = rows.depth_v * depth_stddev;
    xx += du * du;
    xy += du * dv;
    yy += dv * dv;
    const DoubleLanes mixed = xy / xx, left = yy - mixed * xy;
    const DoubleLanes precision_u = 1 / xx,
                      precision_v = 1 / (left > kLeastVariance ? left : none + kLeastVariance);
    const DoubleLanes error_u = u - rows.u, error_v = v - rows.v, own_v = error_v - mixed * error_u;
    for (int j = 0; j < 9; ++j) {
      store(rows.first[j], out + j * padded);
      store(rows.second[j] - mixed * rows.first[j], out + (11 + j) * padded);
    }
    store(error_u, out + 9 * padded);
    store(precision_u, out + 10 * padded);
    store(own_v, out + 20 * padded);
    store(precision_v, out + 21 * padded);
    const DoubleLanes squares = error_u * error_u + error_v * error_v;
    store(seen ? squares : behind, out + 22 * padded);
    store(error_u * error_u * precision_u + own_v * own_v * precision_v, out + 23 * padded);
  }
}

// unit: 1 / scale^2. Tukey weights of the matches below count.
UAV_LANDING_MULTIVERSION void weigh(const double* squares, const double* ratios, size_t padded, double unit,
                                    double* weights) {
  const DoubleLanes none{};
  for (size_t i = 0; i < padded; i += kDoubleLanes) {
    DoubleLanes square, ratio;
    load(squares + i, square);
    load(ratios + i, ratio);
    const DoubleLanes left = 1 - unit / (kTukey * kTukey) * ratio;
    store((square < kBehind) & (left > 0) ? unit * left * left : none, weights + i);
  }
}

// Sums of the products of three columns with three others of a row, by its weights.
[[gnu::always_inline]] inline void addBlock(const double* a, const double* b, const double* weights,
                                            size_t padded, size_t size, double (&sums)[9][kDoubleLanes]) {
  DoubleLanes s[9];
  for (int k = 0; k < 9; ++k) load(sums[k], s[k]);
  for (size_t i = 0; i < size; i += kDoubleLanes) {
    DoubleLanes a0, a1, a2, b0, b1, b2, weight;
    load(weights + i, weight);
    load(a + i, a0);
    load(a + padded + i, a1);
    load(a + 2 * padded + i, a2);
    load(b + i, b0);
    load(b + padded + i, b1);
    load(b + 2 * padded + i, b2);
    b0 *= weight;
    b1 *= weight;
    b2 *= weight;
    s[0] += a0 * b0;
    s[1] += a0 * b1;
    s[2] += a0 * b2;
    s[3] += a1 * b0;
    s[4] += a1 * b1;
    s[5] += a1 * b2;
    s[6] += a2 * b0;
    s[7] += a2 * b1;
    s[8] += a2 * b2;
  }
  for (int k = 0; k < 9; ++k) store(s[k], sums[k]);
}

// Sums of the products of three columns with the residual.
[[gnu::always_inline]] inline void addRight(const double* a, const double* residual, const double* weights,
                                            size_t padded, size_t size, double (&sums)[9][kDoubleLanes]) {
  DoubleLanes s[3];
  for (int k = 0; k < 3; ++k) load(sums[k], s[k]);
  for (size_t i = 0; i < size; i += kDoubleLanes) {
    DoubleLanes a0, a1, a2, r, weight;
    load(weights + i, weight);
    load(residual + i, r);
    load(a + i, a0);
    load(a + padded + i, a1);
    load(a + 2 * padded + i, a2);
    r *= weight;
    s[0] += a0 * r;
    s[1] += a1 * r;
    s[2] += a2 * r;
  }
  for (int k = 0; k < 3; ++k) store(s[k], sums[k]);
}

// Blocks of three by three of the normal equations, the lower ones, and the right side by three.
struct BlockSums {
  alignas(32) double information[6][9][kDoubleLanes];
  alignas(32) double right[3][9][kDoubleLanes];
};

// row: the columns of one row of all matches.
UAV_LANDING_MULTIVERSION void addUp(const double* row, const double* precision, const double* match_weights,
                                    size_t padded, BlockSums& sums) {
  alignas(32) double weights[kTile];
  for (size_t begin = 0; begin < padded; begin += kTile) {
    const size_t size = std::min(kTile, padded - begin);
    for (size_t i = 0; i < size; ++i) weights[i] = match_weights[begin + i] * precision[begin + i];
    const double* columns = row + begin;
    int block = 0;
    for (int i = 0; i < 3; ++i) {
      const double* a = columns + 3 * i * padded;
      for (int j = 0; j <= i; ++j)
        addBlock(a, columns + 3 * j * padded, weights, padded, size, sums.information[block++]);
      addRight(a, columns + 9 * padded, weights, padded, size, sums.right[i]);
    }
  }
}

double total(const double (&lanes)[kDoubleLanes]) {
  DoubleLanes values;
  load(lanes, values);
  return sum(values);
}

}  // namespace

MotionState MotionState::apply(const Vector9d& step) const {
  return {rotationMatrix(step.head<3>()) * Q, t + step.segment<3>(3), n + step.tail<3>()};
}

// Larger memory is kept and only what fills the columns up is set: the rest is written by all that follows.
void MotionRows::resize(size_t count) {
  count_ = count;
  padded_ = wholeDoubleLanes(count);
  inputs_.resize(std::max(inputs_.size(), kMotionInputs * padded_));
  outputs_.resize(std::max(outputs_.size(), kOutputs * padded_));
  for (size_t column = 0; column < kMotionInputs; ++column)
    for (size_t i = count_; i < padded_; ++i)
      inputs_[column * padded_ + i] = column == kXX || column == kYY ? 1 : 0;
}

void MotionRows::assign(const StereoRig& rig, const std::vector<TemporalMatch>& matches) {
  fx_ = rig.fx;
  fy_ = rig.fy;
  cx_ = rig.cx;
  cy_ = rig.cy;
  resize(matches.size());
  for (size_t i = 0; i < count_; ++i) {
    const TemporalMatch& match = matches[i];
    const Eigen::Vector3d ray = rig.ray(match.now.x(), match.now.y());
    const auto set = [&](MotionInput column, double value) { inputs_[column * padded_ + i] = value; };
    set(kX, ray.x());
    set(kY, ray.y());
    set(kU, match.then.x());
    set(kV, match.then.y());
    set(kXX, match.covariance(0, 0));
    set(kXY, match.covariance(1, 0));
    set(kYY, match.covariance(1, 1));
    set(kOnPlane, match.on_plane ? 1 : 0);
    set(kDepth, match.inverse_depth);
    set(kDepthStddev, match.on_plane ? 0 : match.inverse_depth_stddev);
    const Eigen::Vector2d seen =
        match.then + match.by_warp[0] * match.warp.col(0) + match.by_warp[1] * match.warp.col(1);
    set(kSeenU, seen.x());
    set(kSeenV, seen.y());
    for (int k = 0; k < 4; ++k) {
      inputs_[(kRight + k) * padded_ + i] = match.by_warp[0](k / 2, k % 2);
      inputs_[(kBelow + k) * padded_ + i] = match.by_warp[1](k / 2, k % 2);
    }
  }
}

void MotionRows::assign(const MotionRows& all, const std::array<size_t, 3>& chosen) {
  fx_ = all.fx_;
  fy_ = all.fy_;
  cx_ = all.cx_;
  cy_ = all.cy_;
  resize(chosen.size());
  for (size_t column = 0; column < kMotionInputs; ++column)
    for (size_t i = 0; i < count_; ++i)
      inputs_[column * padded_ + i] = all.inputs_[column * all.padded_ + chosen[i]];
}

MotionSupport MotionRows::support(const MotionState& state) const {
  MotionSupport result;
  vote(Terms(state, fx_, fy_, cx_, cy_), inputs_.data(), padded_, count_, result);
  return result;
}

void MotionRows::linearise(const MotionState& state) {
  lineariseAll(Terms(state, fx_, fy_, cx_, cy_), inputs_.data(), padded_, outputs_.data());
  for (size_t i = count_; i < padded_; ++i) outputs_[kSquares * padded_ + i] = kBehind;
}

// Robust size of the residuals over their stddevs.
double MotionRows::residualScale() {
  const double *squares = &outputs_[kSquares * padded_], *ratios = &outputs_[kRatio * padded_];
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
  weigh(column(kSquares), column(kRatio), padded_, 1 / (scale * scale), column(kWeight));
  BlockSums sums{};
  for (const int row : {0, kRowColumns})
    addUp(column(row), column(row + kPrecision), column(kWeight), padded_, sums);
  MotionNormal normal;
  normal.residual_scale = residual_scale;
  for (int i = 0, block = 0; i < 3; ++i) {
    for (int j = 0; j <= i; ++j, ++block)
      for (int k = 0; k < 9; ++k)
        normal.information(3 * i + k / 3, 3 * j + k % 3) = total(sums.information[block][k]);
    for (int k = 0; k < 3; ++k) normal.right[3 * i + k] = total(sums.right[i][k]);
  }
  for (size_t i = 0; i < count_; ++i) {
    inliers[i] = column(kWeight)[i] > 0;
    normal.count += inliers[i];
  }
  return normal;
}

Vector9d MotionRows::score(size_t match, const Vector9d& step) const {
  Vector9d score = Vector9d::Zero();
  const auto value = [&](int column) { return outputs_[column * padded_ + match]; };
  for (const int row : {0, kRowColumns}) {
    Vector9d by;
    for (int k = 0; k < kUnknowns; ++k) by[k] = value(row + k);
    score += value(kWeight) * value(row + kPrecision) * (value(row + kResidual) - by.dot(step)) * by;
  }
  return score;
}

Eigen::Matrix<double, 6, 1> MotionRows::solveExactly() const {
  Eigen::Matrix<double, 6, 6> A;
  Eigen::Matrix<double, 6, 1> b;
  for (int match = 0; match < 3; ++match) {
    const auto value = [&](int column) { return outputs_[column * padded_ + match]; };
    if (value(kSquares) >= kBehind)
      return Eigen::Matrix<double, 6, 1>::Constant(std::numeric_limits<double>::quiet_NaN());
    for (int row = 0; row < 2; ++row) {
      for (int j = 0; j < 6; ++j) A(2 * match + row, j) = value(row * kRowColumns + j);
      b[2 * match + row] = value(row * kRowColumns + kResidual);
    }
  }
  return A.partialPivLu().solve(b);
}

}  // namespace uav_landing
