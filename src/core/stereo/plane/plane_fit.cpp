#include "stereo/plane/plane_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "estimation/convergence.h"
#include "estimation/robust.h"
#include "geometry/bias_variance.h"
#include "kernels/lanes/order_statistic.h"

namespace uav_landing {
namespace {

struct NormalEquations {
  double scale = 1;  // of the residuals, as a multiple of the claimed stddevs
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  double weighted_squares = 0;
  int count = 0;

  Eigen::Matrix3d scaledInformation() const { return information / (scale * scale); }
};

// The least squares problem, in the memory of the columns. x and y are the derivatives of a disparity by the
// first two components of the plane vector. The derivative by the third is fb.
class PlaneProblem {
 public:
  PlaneProblem(const StereoRig& rig, const std::vector<DisparitySample>& samples, PlaneColumns& columns)
      : columns_(columns), count_(samples.size()), fb_(rig.fb()) {
    columns_.resize(count_);
    for (size_t i = 0; i < count_; ++i) {
      const Eigen::Vector3d row = fb_ * rig.ray(samples[i].u, samples[i].v);
      columns_.x[i] = row.x();
      columns_.y[i] = row.y();
      columns_.value[i] = samples[i].disparity;
      columns_.precision[i] = 1 / samples[i].stddev;
    }
  }

  // Derivatives of a sample's disparity by the plane vector.
  Eigen::Vector3d row(size_t i) const { return {columns_.x[i], columns_.y[i], fb_}; }

  // Computes the disparities that a plane predicts.
  void expect(const Eigen::Vector3d& g) { expectValues({g.x(), g.y(), g.z() * fb_}, columns_); }

  // Robust size of the residuals as a multiple of the claimed stddevs, at least 1, over samples near the
  // plane. Only negative residuals are used, because objects on the ground make residuals positive.
  double residualScale(double tolerance) {
    const NearbyCount nearby = measureBelow(2 * tolerance, kPerMedian, columns_);
    if (nearby.small > nearby.all / 2 || nearby.all == 0) return 1;  // the median is among the small ones
    return std::max(
        1.0, kPerMedian * orderStatistic(columns_.ratio.data(), columns_.ratio.size(), nearby.all / 2));
  }

  // One reweighting step. Tukey's weights depend on the residual over scale times the sample's own stddev.
  NormalEquations accumulate(double scale) {
    constexpr double kEnd = TukeyEnd::kDisparity;
    const PlaneSums s = addUpTukey(1 / (kEnd * kEnd * scale * scale), columns_);
    NormalEquations sums;
    sums.scale = scale;
    sums.information << s.wxx, s.wxy, fb_ * s.wx,  //
        s.wxy, s.wyy, fb_ * s.wy,                  //
        fb_ * s.wx, fb_ * s.wy, fb_ * fb_ * s.w;
    sums.right << s.wxd, s.wyd, fb_ * s.wd;
    sums.weighted_squares = s.squares;
    sums.count = s.count;
    return sums;
  }

  // 1 for samples with a weight above zero.
  std::vector<char> agreeing() const {
    std::vector<char> agrees(count_);
    for (size_t i = 0; i < count_; ++i) agrees[i] = columns_.weight[i] > 0;
    return agrees;
  }

 private:
  PlaneColumns& columns_;
  size_t count_;
  double fb_;
};

// Factor by which the covariance exceeds that of independent errors. Surfaces are not planes: neighbouring
// points share undulations and errors of texture. So the scores are first summed over cells of the image
// (cluster-robust covariance: Liang, Zeger 1986). sums: of the last step to the plane of the fit.
double clusterInflation(const StereoRig& rig, const std::vector<DisparitySample>& samples,
                        const PlaneProblem& problem, const NormalEquations& sums, const PlaneFit& fit) {
  constexpr int kColumns = 8, kRows = 8;
  std::array<Eigen::Vector3d, kColumns * kRows> scores;
  scores.fill(Eigen::Vector3d::Zero());
  const double scale = sums.scale;
  double top = rig.size.height, bottom = 0;
  for (size_t i = 0; i < samples.size(); ++i) {
    if (!fit.agrees[i]) continue;
    top = std::min(top, samples[i].v);
    bottom = std::max(bottom, samples[i].v);
  }
  for (size_t i = 0; i < samples.size(); ++i) {
    if (!fit.agrees[i]) continue;
    const DisparitySample& sample = samples[i];
    const Eigen::Vector3d row = problem.row(i);
    const double residual = sample.disparity - row.dot(fit.plane.g);
    const int column = std::min(kColumns - 1, static_cast<int>(kColumns * sample.u / rig.size.width));
    const int line = std::min(kRows - 1, static_cast<int>(kRows * (sample.v - top) / (bottom - top + 1)));
    scores[line * kColumns + column] += row * (residual / (sample.stddev * sample.stddev * scale * scale));
  }
  Eigen::Matrix3d middle = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& score : scores) middle += score * score.transpose();
  return std::max(1.0, (sums.scaledInformation().inverse() * middle).trace() / 3.0);
}

}  // namespace

Expected<PlaneFit> refinePlane(const StereoRig& rig, const Disparities& disparities, const PlaneVector& start,
                               const PlaneLimits& limits, PlaneColumns& memory) {
  constexpr int kIterations = 6;
  const std::vector<DisparitySample>& samples = disparities.samples;
  Eigen::Vector3d g = start;
  double scale = 1;
  PlaneProblem problem(rig, samples, memory);
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
  const std::optional<PlaneVector> plane = PlaneVector::of(g);
  if (!plane || !isPlausibleGround(*plane, limits)) {
    return tl::make_unexpected(Failure{Reason::kNoPlane, "the plane is outside the limits of pitch or roll"});
  }
  PlaneFit fit;
  fit.agrees = problem.agreeing();
  fit.count = sums.count;
  fit.residual_stddev = std::sqrt(std::max(0.0, sums.weighted_squares / sums.information(2, 2))) * rig.fb();
  fit.plane.g = *plane;
  const double inflation = clusterInflation(rig, samples, problem, sums, fit);
  fit.plane.covariance = inflation * sums.scaledInformation().inverse();
  fit.plane.covariance(2, 2) += biasVariance(rig, disparities.bias_stddev);
  return fit;
}

Expected<PlaneFit> refinePlane(const StereoRig& rig, const Disparities& disparities, const PlaneVector& start,
                               const PlaneLimits& limits) {
  PlaneColumns memory;
  return refinePlane(rig, disparities, start, limits, memory);
}

}  // namespace uav_landing
