#include "uav_landing/stereo/surface_profile.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "base/median.h"

namespace uav_landing {
namespace {

// Stretches of the seen ground, each longer than the one before by the same factor. Besides, there is one
// from below the camera to where ground begins to be seen.
constexpr int kStretches = 6;
constexpr int kKinks = 2 * (kStretches + 1);
using Kinks = Eigen::Matrix<double, kKinks, 1>;
using KinkMatrix = Eigen::Matrix<double, kKinks, kKinks>;

// What stands on the ground far ahead looks like a sag, too, but not as clearly: to be believed, a bend must
// show by some five sigma. One that may just as well be there is in the covariance.
constexpr double kBelieved = 1e-6;
// Fits of the most bent surface before that of the likely one.
constexpr int kSteps = 2;
// Errors of the calibration's lens model differ from row to row: as many waves over the rows besides those
// that look like a plane.
constexpr int kWaves = 5;
using Waves = Eigen::Matrix<double, kWaves, 1>;
// Distance over which the curvature of a surface stays about the same, m.
constexpr double kCorrelation = 100;
// Pixels; for a rig that is said to have no errors.
constexpr double kLeastBias = 1e-4;
// Farther away distances are not told, pixels.
constexpr double kLeastDisparity = 0.3;
// Bins of samples at about the same distance.
constexpr int kBins = 40;

/// Ground with a curvature that wanders at random, by kinks: two for each stretch, where their changes of
/// slope are worth as much as its curvature (Gauss' quadrature of degree 3).
struct Kinked {
  Kinks at;               // distance from below the camera, m
  KinkMatrix covariance;  // of the changes of slope where the curvature has a variance of 1 1/m^2
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
    for (int i = 0; i < kKinks; ++i)
      for (int j = 0; j < kKinks; ++j)
        covariance(i, j) = lengths[i] * lengths[j] * std::exp(-std::abs(at[i] - at[j]) / kCorrelation);
  }
};

/// Sums over samples at about the same distance, by their information.
struct Bin {
  double information = 0, expected = 0, reach = 0, v = 0, y = 0;
  Eigen::Vector3d a = Eigen::Vector3d::Zero();  // disparity by plane
};

struct Bend {
  Kinks mean = Kinks::Zero();  // changes of slope at the kinks
  KinkMatrix covariance = KinkMatrix::Zero();
};

class ProfileFit {
 public:
  ProfileFit(const StereoRig& rig, const std::vector<DisparitySample>& samples, const PlaneFit& flat,
             double bias_stddev)
      : rig_(rig), given_(samples), flattened_(samples), plane_(flat) {
    findDistances();
    wave_information_.setZero();
    for (int i = 0; i < kWaves; ++i)
      wave_information_(i, i) = std::pow((i + 2) / std::max(bias_stddev, kLeastBias), 2);
  }

  bool possible() const { return kinks_.has_value(); }

  /// noise: by which the samples' errors count more than as independent ones of their stddevs, as a factor on
  /// variances.
  void accumulate(double noise) {
    to_plane_.setZero();
    Eigen::Matrix<double, 3, kKinks> mixed = Eigen::Matrix<double, 3, kKinks>::Zero();
    KinkMatrix to_kinks = KinkMatrix::Zero();
    Waves right_waves = Waves::Zero();
    Eigen::Matrix<double, kWaves, 3> waves_plane = Eigen::Matrix<double, kWaves, 3>::Zero();
    Eigen::Matrix<double, kWaves, kKinks> waves_kinks = Eigen::Matrix<double, kWaves, kKinks>::Zero();
    Eigen::Matrix<double, kWaves, kWaves> to_waves = wave_information_;
    Eigen::Vector3d right_plane = Eigen::Vector3d::Zero();
    Kinks right_kinks = Kinks::Zero();
    for (const Bin& bin : fillBins(noise, right_plane)) {
      if (bin.information == 0) continue;
      const Kinks b = byKinks(bin.expected / bin.information, bin.reach / bin.information);
      const Waves c = waves(bin.v / bin.information);
      mixed += bin.a * b.transpose();
      to_kinks.selfadjointView<Eigen::Lower>().rankUpdate(b, bin.information);
      right_kinks += b * bin.y;
      to_waves += bin.information * c * c.transpose();
      waves_plane += c * bin.a.transpose();
      waves_kinks += bin.information * c * b.transpose();
      right_waves += c * bin.y;
    }
    plane_by_kinks_ = -to_plane_.ldlt().solve(mixed);
    // Without what the waves explain, and then without what the plane does.
    const Eigen::LDLT<Eigen::Matrix<double, kWaves, kWaves>> by_waves(to_waves);
    const Eigen::Matrix3d plane_left = to_plane_ - waves_plane.transpose() * by_waves.solve(waves_plane);
    const Eigen::Matrix<double, 3, kKinks> mixed_left =
        mixed - waves_plane.transpose() * by_waves.solve(waves_kinks);
    right_plane -= waves_plane.transpose() * by_waves.solve(right_waves);
    right_kinks -= waves_kinks.transpose() * by_waves.solve(right_waves);
    KinkMatrix information = to_kinks.selfadjointView<Eigen::Lower>();
    information -= waves_kinks.transpose() * by_waves.solve(waves_kinks);
    const Eigen::LDLT<Eigen::Matrix3d> by_plane(plane_left);
    information -= mixed_left.transpose() * by_plane.solve(mixed_left);
    const Kinks right = right_kinks - mixed_left.transpose() * by_plane.solve(right_plane);
    // In coordinates of which nothing is known but that they have a stddev of the curvature's, each by
    // itself.
    const KinkMatrix root = kinks_->covariance.llt().matrixL();
    const Eigen::SelfAdjointEigenSolver<KinkMatrix> axes(root.transpose() * information * root);
    values_ = axes.eigenvalues().cwiseMax(0.0);
    axes_ = root * axes.eigenvectors();
    right_ = axes_.transpose() * right;
  }

  /// variance: of the curvature, 1/m^2.
  Bend bend(double variance) const {
    Bend result;
    const Kinks kept = (1 / variance + values_.array()).inverse();
    result.mean = axes_ * kept.cwiseProduct(right_);
    result.covariance = axes_ * kept.asDiagonal() * axes_.transpose();
    return result;
  }

  /// Log of the likelihood ratio of a surface with that variance against a flat one.
  double evidence(double variance) const {
    const Eigen::Array<double, kKinks, 1> gain = 1 + variance * values_.array();
    return 0.5 * (variance * right_.array().square() / gain - gain.log()).sum();
  }

  Bend mixture(double variance, double prior) const {
    std::array<double, kBendShares.size()> logs;
    double largest = 0;
    for (size_t i = 0; i < kBendShares.size(); ++i) {
      logs[i] = evidence(kBendShares[i] * kBendShares[i] * variance);
      largest = std::max(largest, logs[i]);
    }
    double sum = (1 - prior * kBendShares.size()) * std::exp(-largest);
    for (double& value : logs) sum += value = prior * std::exp(value - largest);
    Bend result;
    KinkMatrix squares = KinkMatrix::Zero();
    for (size_t i = 0; i < kBendShares.size(); ++i) {
      const Bend one = bend(kBendShares[i] * kBendShares[i] * variance);
      result.mean += logs[i] / sum * one.mean;
      squares += logs[i] / sum * (one.covariance + one.mean * one.mean.transpose());
    }
    result.covariance = squares - result.mean * result.mean.transpose();
    return result;
  }

  /// Takes the bend off the disparities and fits the plane to what is left.
  bool flatten(const Bend& bend, const PlaneLimits& limits, double bias_stddev) {
    for (size_t i = 0; i < given_.size(); ++i)
      flattened_[i].disparity = given_[i].disparity - byKinks(expected_[i], reaches_[i]).dot(bend.mean);
    const Eigen::Vector3d start = plane_.plane.g + plane_by_kinks_ * bend.mean;
    Expected<PlaneFit> fit = refinePlane(rig_, flattened_, start, limits, bias_stddev);
    if (!fit) return false;
    plane_ = *fit;
    findPlaces();
    return true;
  }

  /// Stddevs of the samples that take a bend for noise are made smaller.
  void calmDown() {
    std::vector<double> ratios;
    ratios.reserve(given_.size());
    for (size_t i = 0; i < given_.size(); ++i)
      if (plane_.agrees[i])
        ratios.push_back(std::abs(flattened_[i].disparity - disparity(i)) / flattened_[i].stddev);
    if (ratios.empty()) return;
    const double factor = std::min(1.0, robustStddev(ratios));
    for (DisparitySample& sample : flattened_) sample.stddev *= factor;
  }

  /// By how much the covariance of the plane is larger than independent errors would make it.
  double noise(double bias_stddev) const {
    Eigen::Matrix3d random = plane_.plane.covariance;
    random(2, 2) -= std::pow(bias_stddev / rig_.fb(), 2);
    return std::max(1.0, (random * to_plane_).trace() / 3);
  }

  SurfaceProfile profile(const Bend& bend) const {
    SurfaceProfile result;
    result.below = plane_.plane;
    result.below.covariance += plane_by_kinks_ * bend.covariance * plane_by_kinks_.transpose();
    result.curvature = bend.mean.sum() / kinks_->farthest;
    result.curvature_variance = bend.covariance.sum() / std::pow(kinks_->farthest, 2);
    return result;
  }

 private:
  /// Of the plane without the bend.
  double disparity(size_t i) const {
    return rig_.fb() * plane_.plane.g.dot(rig_.ray(given_[i].u, given_[i].v));
  }

  /// By the plane through all of them.
  void findDistances() {
    findPlaces();
    std::vector<double> seen;
    seen.reserve(given_.size());
    for (size_t i = 0; i < given_.size(); ++i)
      if (plane_.agrees[i]) seen.push_back(reaches_[i] / expected_[i]);
    top_ = rig_.size.height;
    for (const DisparitySample& sample : given_) top_ = std::min(top_, sample.v);
    if (seen.size() < static_cast<size_t>(2 * kKinks)) return;
    std::sort(seen.begin(), seen.end());
    const double nearest = seen[seen.size() / 50], farthest = seen[seen.size() - 1 - seen.size() / 50];
    if (nearest > 0 && farthest > 1.5 * nearest) kinks_.emplace(nearest, farthest);
  }

  /// The samples that agree, and the sums of the plane alone. What kinks do is linear in the disparity, but
  /// at the kinks, so that the middle of a bin stands for all of it; the bins are narrower far away, where
  /// the kinks are close in disparity.
  std::array<Bin, kBins> fillBins(double noise, Eigen::Vector3d& right_plane) {
    std::array<Bin, kBins> bins;
    const double largest = *std::max_element(expected_.begin(), expected_.end());
    for (size_t i = 0; i < given_.size(); ++i) {
      if (!plane_.agrees[i]) continue;
      const DisparitySample& sample = flattened_[i];
      const double information = 1 / (sample.stddev * sample.stddev * noise);
      const Eigen::Vector3d a = rig_.fb() * rig_.ray(sample.u, sample.v);
      const double y = (given_[i].disparity - disparity(i)) * information;
      to_plane_ += information * a * a.transpose();
      right_plane += a * y;
      const int place = static_cast<int>(kBins * std::sqrt(expected_[i] / largest));
      Bin& bin = bins[std::min(place, kBins - 1)];
      bin.information += information;
      bin.expected += information * expected_[i];
      bin.reach += information * reaches_[i];
      bin.v += information * sample.v;
      bin.y += y;
      bin.a += information * a;
    }
    return bins;
  }

  /// Chebyshev's polynomials of degree 2 and more over the rows from the horizon to the bottom.
  Waves waves(double v) const {
    Waves values;
    const double x = 2 * (v - top_) / (rig_.size.height - top_) - 1;
    double before = 1, now = x;
    for (int i = 0; i < kWaves; ++i) {
      const double next = 2 * x * now - before;
      before = now;
      values[i] = now = next;
    }
    return values;
  }

  /// Where the samples are on the surface.
  void findPlaces() {
    expected_.resize(given_.size());
    reaches_.resize(given_.size());
    const Eigen::Vector3d n = plane_.plane.normal();
    const Eigen::Vector3d forward = (Eigen::Vector3d::UnitZ() - n.z() * n).normalized();
    for (size_t i = 0; i < given_.size(); ++i) {
      const double bent = given_[i].disparity - flattened_[i].disparity;
      expected_[i] = std::max(disparity(i) + bent, kLeastDisparity);
      reaches_[i] = rig_.fb() * forward.dot(rig_.ray(given_[i].u, given_[i].v));
    }
  }

  /// What changes of slope at the kinks do to a disparity. Ground that is higher by z is at the inverse depth
  /// 1/Z = g.r + z |g| / Z; behind a kink, z is the distance from it.
  Kinks byKinks(double expected, double reach) const {
    return plane_.plane.g.norm() * (reach - expected * kinks_->at.array()).max(0.0);
  }

  const StereoRig& rig_;
  const std::vector<DisparitySample>& given_;
  std::vector<DisparitySample> flattened_;
  PlaneFit plane_;
  // Disparity of the surface, and that times the distance along the tangent straight below.
  std::vector<double> expected_, reaches_;
  std::optional<Kinked> kinks_;
  double top_ = 0;  // highest row of the samples

  Eigen::Matrix3d to_plane_;
  Eigen::Matrix<double, 3, kKinks> plane_by_kinks_;
  Eigen::Matrix<double, kWaves, kWaves> wave_information_;
  KinkMatrix axes_;
  Kinks values_, right_;
};

}  // namespace

std::optional<SurfaceProfile> fitSurfaceProfile(const StereoRig& rig,
                                                const std::vector<DisparitySample>& samples,
                                                const PlaneFit& flat, const PlaneLimits& limits,
                                                double bias_stddev, double slope_change) {
  ProfileFit fit(rig, samples, flat, bias_stddev);
  if (!fit.possible()) return std::nullopt;
  const double per_metre = std::pow(slope_change / 100, 2);
  const double most = std::pow(kBendShares.back(), 2) * per_metre;
  // First as bent as may be, for the distances and to see the noise; then as bent as it is.
  for (int step = 0; step < kSteps; ++step) {
    fit.accumulate(1);
    if (!fit.flatten(fit.bend(most), limits, bias_stddev)) return std::nullopt;
    fit.calmDown();
  }
  fit.accumulate(fit.noise(bias_stddev));
  Bend bend = fit.mixture(per_metre, kBelieved);
  const Bend possible = fit.mixture(per_metre, kBendChance);
  const Kinks missed = possible.mean - bend.mean;
  bend.covariance = possible.covariance + missed * missed.transpose();
  if (!fit.flatten(bend, limits, bias_stddev)) return std::nullopt;
  return fit.profile(bend);
}

}  // namespace uav_landing
