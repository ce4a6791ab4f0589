#include "stereo/surface/surface_profile.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/bias_variance.h"
#include "kernels/lanes/order_statistic.h"
#include "stereo/surface/profile_samples.h"

namespace uav_landing {
namespace {

// Stretches of the ground that is seen; each is longer than the nearer one by the same factor. One more lies
// between the camera and the first ground that is seen.
constexpr int kStretches = 6;
constexpr int kKinks = 2 * (kStretches + 1);
using Kinks = Eigen::Matrix<double, kKinks, 1>;
using KinkMatrix = Eigen::Matrix<double, kKinks, kKinks>;

// A bend counts only when it shows by about five sigma, because objects far ahead look like a sag, but less
// clearly. The covariance contains a bend that is merely possible.
constexpr double kBelieved = 1e-6;
// Fits of the most bent surface, before the fit of the likely one.
constexpr int kSteps = 2;
// Number of waves over the rows that errors of the lens model may have, besides those that look like a plane.
// These errors differ from row to row.
constexpr int kWaves = 5;
using Waves = Eigen::Matrix<double, kWaves, 1>;
// Distance over which the curvature of a surface stays about the same, m.
constexpr double kCorrelation = 100;
// Pixels; for a rig that claims to have no errors.
constexpr double kLeastBias = 1e-4;

/// Ground with a random curvature, as changes of slope at kinks. Each stretch has two kinks, placed so that
/// they have the effect of its curvature (Gauss' quadrature of degree 3).
struct Kinked {
  Kinks at;         // distance from below the camera, m
  KinkMatrix root;  // of the covariance of their changes for a curvature with a variance of 1 1/m^2
  double farthest;

  Kinked(double nearest, double end) : farthest(end) {
    const double factor = std::pow(end / nearest, 1.0 / kStretches);
    double from = 0, to = nearest;
    Kinks lengths;
    for (int i = 0; i <= kStretches; ++i) {
      const double half = 0.5 * (to - from), middle = from + half;
      at[2 * i] = middle - half / std::sqrt(3.0);
      at[2 * i + 1] = middle + half / std::sqrt(3.0);
      lengths[2 * i] = lengths[2 * i + 1] = half;
      from = to;
      to *= factor;
    }
    KinkMatrix covariance;
    for (int i = 0; i < kKinks; ++i)
      for (int j = 0; j < kKinks; ++j)
        covariance(i, j) = lengths[i] * lengths[j] * std::exp(-std::abs(at[i] - at[j]) / kCorrelation);
    root = covariance.llt().matrixL();
  }
};

/// The bend along axes that the samples tell independently of each other. A curvature with a variance of 1
/// 1/m^2 is equally likely in all directions.
struct Bend {
  Kinks mean = Kinks::Zero();
  KinkMatrix covariance = KinkMatrix::Zero();
};

/// A hypothesis besides the plane: a surface with a certain variance of its curvature.
struct Alternative {
  double log = 0;         // of its likelihood ratio
  Kinks mean, variances;  // of the bend
};
struct Alternatives {
  std::array<Alternative, kBendShares.size()> each;
  KinkMatrix to_kinks;  // from the axes to changes of slope at the kinks
};

/// prior: probability of each alternative.
Bend mixture(const Alternatives& alternatives, double prior) {
  double largest = 0;
  for (const Alternative& one : alternatives.each) largest = std::max(largest, one.log);
  std::array<double, kBendShares.size()> weights;
  double sum = (1 - prior * kBendShares.size()) * std::exp(-largest);
  for (size_t i = 0; i < weights.size(); ++i)
    sum += weights[i] = prior * std::exp(alternatives.each[i].log - largest);
  Bend result;
  for (size_t i = 0; i < weights.size(); ++i) {
    const Alternative& one = alternatives.each[i];
    result.mean += weights[i] / sum * one.mean;
    result.covariance += weights[i] / sum * one.mean * one.mean.transpose();
    result.covariance.diagonal() += weights[i] / sum * one.variances;
  }
  result.covariance -= result.mean * result.mean.transpose();
  return result;
}

class ProfileFit {
 public:
  ProfileFit(const StereoRig& rig, const std::vector<DisparitySample>& samples, const PlaneFit& flat,
             double bias_stddev)
      : rig_(rig), samples_(rig, samples), plane_(flat) {
    findDistances();
    wave_information_.setZero();
    for (int i = 0; i < kWaves; ++i)
      wave_information_(i, i) = std::pow((i + 2) / std::max(bias_stddev, kLeastBias), 2);
  }

  bool possible() const { return kinks_.has_value(); }

  /// noise: factor on the variances of the samples, because their errors are not independent.
  void accumulate(double noise) {
    const ProfileSums sums = samples_.sums(plane_, noise);
    to_plane_ = sums.information;
    Eigen::Matrix<double, 3, kKinks> mixed = Eigen::Matrix<double, 3, kKinks>::Zero();
    KinkMatrix to_kinks = KinkMatrix::Zero();
    Waves right_waves = Waves::Zero();
    Eigen::Matrix<double, kWaves, 3> waves_plane = Eigen::Matrix<double, kWaves, 3>::Zero();
    Eigen::Matrix<double, kWaves, kKinks> waves_kinks = Eigen::Matrix<double, kWaves, kKinks>::Zero();
    Eigen::Matrix<double, kWaves, kWaves> to_waves = wave_information_;
    Kinks right_kinks = Kinks::Zero();
    for (const ProfileBin& bin : sums.bins) {
      if (bin.information == 0) continue;
      const Kinks b = byKinks(bin.expected / bin.information, bin.reach / bin.information);
      const Waves c = waves(bin.v / bin.information);
      mixed += bin.a * b.transpose();
      to_kinks += b * (bin.information * b).transpose();
      right_kinks += b * bin.y;
      to_waves += bin.information * c * c.transpose();
      waves_plane += c * bin.a.transpose();
      waves_kinks += bin.information * c * b.transpose();
      right_waves += c * bin.y;
    }
    plane_by_kinks_ = -to_plane_.ldlt().solve(mixed);
    // First without what the waves explain, then without what the plane explains.
    const Eigen::LDLT<Eigen::Matrix<double, kWaves, kWaves>> by_waves(to_waves);
    const Eigen::Matrix<double, kWaves, kKinks> waves_by_kinks = by_waves.solve(waves_kinks);
    const Waves waves_by_right = by_waves.solve(right_waves);
    const Eigen::Matrix3d plane_left = to_plane_ - waves_plane.transpose() * by_waves.solve(waves_plane);
    const Eigen::Matrix<double, 3, kKinks> mixed_left = mixed - waves_plane.transpose() * waves_by_kinks;
    const Eigen::Vector3d right_plane = sums.right - waves_plane.transpose() * waves_by_right;
    right_kinks -= waves_kinks.transpose() * waves_by_right;
    const Eigen::LDLT<Eigen::Matrix3d> by_plane(plane_left);
    KinkMatrix information = to_kinks.selfadjointView<Eigen::Lower>();
    information -= waves_kinks.transpose() * waves_by_kinks;
    information -= mixed_left.transpose() * by_plane.solve(mixed_left);
    const Kinks right = right_kinks - mixed_left.transpose() * by_plane.solve(right_plane);
    // In coordinates with independent priors, each with the stddev of the curvature.
    information_ = kinks_->root.transpose() * information * kinks_->root;
    right_ = kinks_->root.transpose() * right;
  }

  /// Changes of slope at the kinks. variance: of the curvature, 1/m^2.
  Kinks meanBend(double variance) const {
    KinkMatrix information = information_;
    information.diagonal().array() += 1 / variance;
    return kinks_->root * information.llt().solve(right_);
  }

  /// per_metre: variance of the curvature, 1/m^2; each alternative has a share of it.
  Alternatives alternatives(double per_metre) const {
    const Eigen::SelfAdjointEigenSolver<KinkMatrix> axes(information_);
    const Kinks information = axes.eigenvalues().cwiseMax(0.0);
    const Kinks right = axes.eigenvectors().transpose() * right_;
    Alternatives all;
    all.to_kinks = kinks_->root * axes.eigenvectors();
    for (size_t i = 0; i < all.each.size(); ++i) {
      const double variance = kBendShares[i] * kBendShares[i] * per_metre;
      all.each[i].log = evidence(variance, information, right);
      all.each[i].variances = (1 / variance + information.array()).inverse();
      all.each[i].mean = all.each[i].variances.cwiseProduct(right);
    }
    return all;
  }

  /// Subtracts the bend from the disparities and fits the plane to the rest.
  bool flatten(const Kinks& bend, const PlaneLimits& limits, double bias_stddev) {
    for (size_t i = 0; i < samples_.size(); ++i)
      samples_.takeOff(i, byKinks(samples_.expected(i), samples_.reach(i)).dot(bend));
    const std::optional<PlaneVector> start = PlaneVector::of(plane_.plane.g + plane_by_kinks_ * bend);
    if (!start) return false;
    Expected<PlaneFit> fit = refinePlane(rig_, {samples_.flattened(), bias_stddev}, *start, limits, memory_);
    if (fit) plane_ = std::move(*fit);
    return fit.has_value();
  }

  /// Accepts the bend: places and stddevs of the samples then follow from the flattened surface.
  void settle() {
    samples_.findPlaces(plane_.plane);
    samples_.calmDown(plane_);
  }

  /// Factor by which the covariance of the plane exceeds that of independent errors.
  double noise(double bias_stddev) const {
    Eigen::Matrix3d random = plane_.plane.covariance;
    random(2, 2) -= biasVariance(rig_, bias_stddev);
    return std::max(1.0, (random * to_plane_).trace() / 3);
  }

  SurfaceProfile profile(const Bend& bend, const KinkMatrix& to_kinks) const {
    SurfaceProfile result;
    result.below = plane_.plane;
    const Eigen::Matrix<double, 3, kKinks> plane_by_bend = plane_by_kinks_ * to_kinks;
    result.below.covariance += plane_by_bend * bend.covariance * plane_by_bend.transpose();
    const Kinks curvature = to_kinks.colwise().sum() / kinks_->farthest;
    result.curvature = curvature.dot(bend.mean);
    result.curvature_variance = curvature.dot(bend.covariance * curvature);
    return result;
  }

 private:
  /// Log of the likelihood ratio of a surface with that variance against a flat one.
  static double evidence(double variance, const Kinks& information, const Kinks& right) {
    const Eigen::Array<double, kKinks, 1> gain = 1 + variance * information.array();
    return 0.5 * (variance * right.array().square() / gain - gain.log()).sum();
  }

  /// Distances of the kinks, by the plane through all samples.
  void findDistances() {
    samples_.findPlaces(plane_.plane);
    std::vector<double> seen;
    seen.reserve(samples_.size());
    for (size_t i = 0; i < samples_.size(); ++i)
      if (plane_.agrees[i]) seen.push_back(samples_.reach(i) / samples_.expected(i));
    if (seen.size() < static_cast<size_t>(2 * kKinks)) return;
    const auto ranked = [&](size_t rank) { return orderStatistic(seen.data(), seen.size(), rank); };
    const double nearest = ranked(seen.size() / 50), farthest = ranked(seen.size() - 1 - seen.size() / 50);
    if (nearest > 0 && farthest > 1.5 * nearest) kinks_.emplace(nearest, farthest);
  }

  /// Chebyshev's polynomials of degree 2 and more over the rows from the horizon to the bottom.
  Waves waves(double v) const {
    Waves values;
    const double top = samples_.top(), x = 2 * (v - top) / (rig_.size.height - top) - 1;
    double before = 1, now = x;
    for (int i = 0; i < kWaves; ++i) {
      const double next = 2 * x * now - before;
      before = now;
      values[i] = now = next;
    }
    return values;
  }

  /// Effect on a disparity of changes of slope at the kinks. Ground that is higher by z has the inverse depth
  /// 1/Z = g.r + z |g| / Z. Behind a kink, z is the distance from it.
  Kinks byKinks(double expected, double reach) const {
    return plane_.plane.g.norm() * (reach - expected * kinks_->at.array()).max(0.0);
  }

  const StereoRig& rig_;
  ProfileSamples samples_;
  PlaneColumns memory_;
  PlaneFit plane_;
  std::optional<Kinked> kinks_;

  Eigen::Matrix3d to_plane_;
  Eigen::Matrix<double, 3, kKinks> plane_by_kinks_;
  Eigen::Matrix<double, kWaves, kWaves> wave_information_;
  KinkMatrix information_;  // for the changes of slope, in coordinates of root
  Kinks right_;
};

}  // namespace

std::optional<SurfaceProfile> fitSurfaceProfile(const StereoRig& rig, const Disparities& disparities,
                                                const PlaneFit& flat, const PlaneLimits& limits,
                                                double slope_change) {
  const auto& [samples, bias_stddev] = disparities;
  ProfileFit fit(rig, samples, flat, bias_stddev);
  if (!fit.possible()) return std::nullopt;
  const double per_metre = std::pow(slope_change / 100, 2);
  const double most = std::pow(kBendShares.back(), 2) * per_metre;
  // First as bent as possible, which gives the distances and the noise; then as bent as is likely.
  for (int step = 0; step < kSteps; ++step) {
    fit.accumulate(1);
    if (!fit.flatten(fit.meanBend(most), limits, bias_stddev)) return std::nullopt;
    fit.settle();
  }
  fit.accumulate(fit.noise(bias_stddev));
  const Alternatives alternatives = fit.alternatives(per_metre);
  Bend bend = mixture(alternatives, kBelieved);
  const Bend possible = mixture(alternatives, kBendChance);
  const Kinks missed = possible.mean - bend.mean;
  bend.covariance = possible.covariance + missed * missed.transpose();
  if (!fit.flatten(alternatives.to_kinks * bend.mean, limits, bias_stddev)) return std::nullopt;
  return fit.profile(bend, alternatives.to_kinks);
}

}  // namespace uav_landing
