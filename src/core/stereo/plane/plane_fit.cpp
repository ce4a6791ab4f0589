#include "stereo/plane/plane_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "estimation/convergence.h"
#include "estimation/robust.h"
#include "geometry/bias_variance.h"
#include "kernels/lanes/lanes.h"
#include "kernels/lanes/multiversion.h"
#include "kernels/lanes/order_statistic.h"

namespace uav_landing {
namespace {

struct NormalEquations {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  double weighted_squares = 0;
  int count = 0;
};

// The least squares problem by columns, filled up to whole lanes with samples of no weight. Keeps its memory.
class PlaneProblem {
 public:
  void assign(const StereoRig& rig, const std::vector<DisparitySample>& samples) {
    count_ = samples.size();
    fb_ = rig.fb();
    const size_t filled = wholeDoubleLanes(count_);
    for (std::vector<double>* column : {&x_, &y_, &disparity_, &precision_, &expected_, &weight_, &ratios_})
      column->resize(filled);
    for (size_t i = 0; i < count_; ++i) {
      const Eigen::Vector3d row = fb_ * rig.ray(samples[i].u, samples[i].v);
      x_[i] = row.x();
      y_[i] = row.y();
      disparity_[i] = samples[i].disparity;
      precision_[i] = 1 / samples[i].stddev;
    }
    for (size_t i = count_; i < filled; ++i) x_[i] = y_[i] = disparity_[i] = precision_[i] = 0;
  }

  // Derivatives of a sample's disparity by the plane vector.
  Eigen::Vector3d row(size_t i) const { return {x_[i], y_[i], fb_}; }

  // The disparities that a plane gives.
  UAV_LANDING_MULTIVERSION void expect(const Eigen::Vector3d& g) {
    const double gx = g.x(), gy = g.y(), constant = g.z() * fb_;
    const double *x = x_.data(), *y = y_.data();
    double* __restrict expected = expected_.data();
    for (size_t i = 0; i < x_.size(); ++i) expected[i] = gx * x[i] + gy * y[i] + constant;
  }

  // Robust size of the residuals as a multiple of the claimed stddevs, at least 1, over samples near the
  // plane. What stands on the ground makes residuals positive only, so the negative ones alone tell the size
  // of the ground's own.
  double residualScale(double tolerance) {
    const Nearby nearby = measureNearby(tolerance);
    if (nearby.small > nearby.all / 2 || nearby.all == 0) return 1;  // the median is among the small ones
    return std::max(1.0, kPerMedian * orderStatistic(ratios_.data(), ratios_.size(), nearby.all / 2));
  }

  // One reweighting step: Tukey weights of the residuals over scale times each sample's own stddev.
  UAV_LANDING_MULTIVERSION NormalEquations accumulate(double scale) {
    constexpr double kEnd = TukeyEnd::kDisparity;
    const double unit = 1 / (kEnd * kEnd * scale * scale);
    const DoubleLanes none{}, one = none + 1;
    DoubleLanes w{}, wx{}, wy{}, wxx{}, wxy{}, wyy{}, wd{}, wxd{}, wyd{}, squares{}, count{};
    for (size_t i = 0; i < x_.size(); i += kDoubleLanes) {
      DoubleLanes x, y, precision, disparity, expected;
      load(&x_[i], x);
      load(&y_[i], y);
      load(&precision_[i], precision);
      load(&disparity_[i], disparity);
      load(&expected_[i], expected);
      const DoubleLanes residual = disparity - expected, information = precision * precision;
      const DoubleLanes missing = 1 - residual * residual * information * unit;
      const auto inside = (missing > 0) & (expected > 0) & (information > 0);
      const DoubleLanes weight = inside ? missing * missing * information : none;
      const DoubleLanes weight_x = weight * x, weight_y = weight * y;
      store(weight, &weight_[i]);
      count += inside ? one : none;
      w += weight;
      wx += weight_x;
      wy += weight_y;
      wxx += weight_x * x;
      wxy += weight_x * y;
      wyy += weight_y * y;
      wd += weight * disparity;
      wxd += weight_x * disparity;
      wyd += weight_y * disparity;
      squares += weight * residual * residual;
    }
    NormalEquations sums;
    sums.information << sum(wxx), sum(wxy), fb_ * sum(wx),  //
        sum(wxy), sum(wyy), fb_ * sum(wy),                  //
        fb_ * sum(wx), fb_ * sum(wy), fb_ * fb_ * sum(w);
    sums.right << sum(wxd), sum(wyd), fb_ * sum(wd);
    sums.weighted_squares = sum(squares);
    sums.count = static_cast<int>(sum(count));
    return sums;
  }

  // Which samples had a weight.
  std::vector<char> agreeing() const {
    std::vector<char> agrees(count_);
    for (size_t i = 0; i < count_; ++i) agrees[i] = weight_[i] > 0;
    return agrees;
  }

 private:
  // Samples below the plane and near it, and those of them that are not farther off than claimed.
  struct Nearby {
    size_t all, small;
  };

  // Counts them and sets the ratios of their residuals to the claimed stddevs, of other samples to infinity.
  UAV_LANDING_MULTIVERSION Nearby measureNearby(double tolerance) {
    const DoubleLanes none{}, one = none + 1, infinity = none + std::numeric_limits<double>::infinity();
    const double farthest = -2 * tolerance;
    DoubleLanes all{}, small{};
    for (size_t i = 0; i < x_.size(); i += kDoubleLanes) {
      DoubleLanes precision, disparity, expected;
      load(&precision_[i], precision);
      load(&disparity_[i], disparity);
      load(&expected_[i], expected);
      const DoubleLanes residual = disparity - expected;
      const auto near = (residual <= 0) & (residual > farthest) & (precision > 0);
      const DoubleLanes ratio = near ? -residual * precision : infinity;
      store(ratio, &ratios_[i]);
      all += near ? one : none;
      small += kPerMedian * ratio <= 1 ? one : none;
    }
    return {static_cast<size_t>(sum(all)), static_cast<size_t>(sum(small))};
  }

  size_t count_ = 0;
  double fb_ = 0;
  std::vector<double> x_, y_;  // derivatives of the disparity by the plane vector; by its third component: fb
  std::vector<double> disparity_, precision_;  // precision: 1 / stddev
  std::vector<double> expected_, weight_, ratios_;
};

// How much larger the covariance is than independent errors would make it. Surfaces are not planes, and their
// undulations, like errors of texture, are common to neighbouring points: scores are summed over patches of
// the image first (cluster-robust covariance: Liang, Zeger 1986). information: normal matrix already divided
// by the squared scale of the residuals.
double clusterInflation(const StereoRig& rig, const std::vector<DisparitySample>& samples,
                        const PlaneProblem& problem, const Eigen::Vector3d& g,
                        const std::vector<char>& agrees, double scale, const Eigen::Matrix3d& information) {
  constexpr int kColumns = 8, kRows = 8;
  std::array<Eigen::Vector3d, kColumns * kRows> scores;
  scores.fill(Eigen::Vector3d::Zero());
  double top = rig.size.height, bottom = 0;
  for (size_t i = 0; i < samples.size(); ++i) {
    if (!agrees[i]) continue;
    top = std::min(top, samples[i].v);
    bottom = std::max(bottom, samples[i].v);
  }
  for (size_t i = 0; i < samples.size(); ++i) {
    if (!agrees[i]) continue;
    const DisparitySample& sample = samples[i];
    const Eigen::Vector3d row = problem.row(i);
    const double residual = sample.disparity - row.dot(g);
    const int column = std::min(kColumns - 1, static_cast<int>(kColumns * sample.u / rig.size.width));
    const int line = std::min(kRows - 1, static_cast<int>(kRows * (sample.v - top) / (bottom - top + 1)));
    scores[line * kColumns + column] += row * (residual / (sample.stddev * sample.stddev * scale * scale));
  }
  Eigen::Matrix3d middle = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& score : scores) middle += score * score.transpose();
  return std::max(1.0, (information.inverse() * middle).trace() / 3.0);
}

}  // namespace

Expected<PlaneFit> refinePlane(const StereoRig& rig, const std::vector<DisparitySample>& samples,
                               const Eigen::Vector3d& start, const PlaneLimits& limits, double bias_stddev) {
  constexpr int kIterations = 6;
  Eigen::Vector3d g = start;
  double scale = 1;
  static thread_local PlaneProblem kept;  // for its memory
  PlaneProblem& problem = kept;           // where that is takes a call to find
  problem.assign(rig, samples);
  NormalEquations sums;
  Convergence convergence;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    problem.expect(g);
    scale = problem.residualScale(limits.tolerance);
    sums = problem.accumulate(scale);
    if (sums.count < limits.min_points) {
      return tl::make_unexpected(Failure{
          Reason::kNoPlane, std::to_string(sums.count) + " of " + std::to_string(samples.size()) +
                                " matches agree, at least " + std::to_string(limits.min_points) + " needed"});
    }
    const Eigen::Vector3d before = g;
    g = sums.information.ldlt().solve(sums.right);
    if (convergence.reached<3>((g - before) / scale, sums.information)) break;
  }
  if (!isPlausibleGround(g, limits)) {
    return tl::make_unexpected(Failure{Reason::kNoPlane, "the plane is outside the limits of pitch or roll"});
  }
  PlaneFit fit;
  fit.agrees = problem.agreeing();
  fit.count = sums.count;
  fit.residual_stddev = std::sqrt(std::max(0.0, sums.weighted_squares / sums.information(2, 2))) * rig.fb();
  fit.plane.g = g;
  const Eigen::Matrix3d information = sums.information / (scale * scale);
  const double inflation = clusterInflation(rig, samples, problem, g, fit.agrees, scale, information);
  fit.plane.covariance = inflation * information.inverse();
  fit.plane.covariance(2, 2) += biasVariance(rig, bias_stddev);
  return fit;
}

}  // namespace uav_landing
