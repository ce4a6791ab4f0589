#include "uav_landing/plane_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <string>
#include <utility>

namespace uav_landing {
namespace {

// Share of a full vote that a sample below the plane takes away: ground does not allow it.
constexpr double kBelowPenalty = 0.5;
// The same for a sample above it: it may stand on the ground, but ground that everything floats over is none.
constexpr double kAbovePenalty = 0.1;
// Votes that a roll of ten degrees takes away (with its square): an aircraft that lands is nearly level, and
// planes through walls and slopes are not.
constexpr double kRollPenalty = 1.0;
// Least disparity of the plane at a sample that counts: nearer the horizon everything agrees.
constexpr double kMinDisparity = 1.0;

struct Votes {
  double agreeing = 0;  // MSAC votes of the samples on the plane
  double penalty = 0;   // of those off it
  double net() const { return agreeing - penalty; }
};

Votes votesFor(const StereoRig& rig, const std::vector<DisparitySample>& samples, const Eigen::Vector3d& g,
               double tolerance) {
  Votes votes;
  const double tens = rollOf(g) * 18.0 / M_PI;
  votes.penalty = kRollPenalty * tens * tens;
  for (const DisparitySample& sample : samples) {
    const double expected = rig.fb() * g.dot(rig.ray(sample.u, sample.v));
    if (expected < kMinDisparity) continue;
    double nearest = 1e9, largest = -1e9;
    for (const double disparity : sample.disparities) {
      nearest = std::min(nearest, std::abs(disparity - expected));
      largest = std::max(largest, disparity);
    }
    const double ratio = nearest / tolerance;
    if (ratio < 1) {
      votes.agreeing += 1 - ratio * ratio;
    } else if (sample.u - expected < rig.principalOffset()) {
      // Its place in the right image is outside of it: what it matched instead says nothing against the
      // plane.
      continue;
    } else if (largest < expected - 2 * tolerance) {
      votes.penalty += kBelowPenalty;
    } else {
      votes.penalty += kAbovePenalty;
    }
  }
  return votes;
}

// Uniform integer below n: std distributions differ between standard libraries, this does not.
size_t below(std::mt19937& random, size_t n) { return random() % n; }

// Least squares over what agrees with a new best plane (locally optimised RANSAC: Chum, Matas, Kittler 2003).
void improve(const StereoRig& rig, const std::vector<DisparitySample>& samples, const PlaneLimits& limits,
             Consensus& best) {
  constexpr int kRounds = 2;
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (const DisparitySample& sample : samples) {
      const Eigen::Vector3d row = rig.fb() * rig.ray(sample.u, sample.v);
      for (const double disparity : sample.disparities) {
        const double ratio = (disparity - row.dot(best.g)) / limits.tolerance;
        if (std::abs(ratio) >= 1) continue;
        const double weight = 1 - ratio * ratio;
        information += weight * row * row.transpose();
        right += weight * row * disparity;
      }
    }
    const Eigen::Vector3d g = information.ldlt().solve(right);
    if (!isPlausibleGround(g, limits)) return;
    const Votes votes = votesFor(rig, samples, g, limits.tolerance);
    if (votes.net() <= best.score) return;
    best = {g, votes.agreeing, votes.net(), true};
  }
}

// One of the disparities of one of the samples.
struct Draw {
  Eigen::Vector3d ray;
  double disparity;
  Draw(const StereoRig& rig, const std::vector<DisparitySample>& samples, std::mt19937& random) {
    const DisparitySample& sample = samples[below(random, samples.size())];
    ray = rig.ray(sample.u, sample.v);
    disparity = sample.disparities[below(random, sample.disparities.size())];
  }
};

// Plane through three samples; not plausible (zero) when they are nearly in line.
Eigen::Vector3d throughThree(const StereoRig& rig, const std::vector<DisparitySample>& samples,
                             std::mt19937& random) {
  const Draw a(rig, samples, random), b(rig, samples, random), c(rig, samples, random);
  Eigen::Matrix3d rays;
  rays << a.ray.transpose(), b.ray.transpose(), c.ray.transpose();
  if (std::abs(rays.determinant()) < 1e-4) return Eigen::Vector3d::Zero();
  return rays.partialPivLu().solve(Eigen::Vector3d(a.disparity, b.disparity, c.disparity)) / rig.fb();
}

// Plane through two samples with a drawn roll, small ones more often: where little of the image is ground,
// two that lie on it are found far sooner than three.
Eigen::Vector3d throughTwo(const StereoRig& rig, const std::vector<DisparitySample>& samples, double max_roll,
                           std::mt19937& random) {
  const Draw a(rig, samples, random), b(rig, samples, random);
  const double triangular = (below(random, 1001) + below(random, 1001)) / 1000.0 - 1.0;
  const double slope = std::tan(max_roll * triangular);
  const double ya = a.ray.y() + slope * a.ray.x(), yb = b.ray.y() + slope * b.ray.x();
  if (std::abs(ya - yb) < 0.02) return Eigen::Vector3d::Zero();
  const double gy = (a.disparity - b.disparity) / (ya - yb) / rig.fb();
  return {slope * gy, gy, a.disparity / rig.fb() - gy * ya};
}

double medianOf(std::vector<double>& values) {
  const auto middle = values.begin() + values.size() / 2;
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

struct NormalEquations {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  double weighted_squares = 0, weights = 0;
  int count = 0;
};

// One reweighting step: Tukey weights of the residuals of g over scale times each sample's own stddev.
NormalEquations accumulate(const StereoRig& rig, const std::vector<DisparitySample>& samples,
                           const Eigen::Vector3d& g, double scale, std::vector<char>* agrees) {
  constexpr double kTukey = 4.0;
  NormalEquations sums;
  for (size_t i = 0; i < samples.size(); ++i) {
    const DisparitySample& sample = samples[i];
    const Eigen::Vector3d row = rig.fb() * rig.ray(sample.u, sample.v);
    const double residual = sample.disparities.front() - row.dot(g);
    const double ratio = residual / (kTukey * scale * sample.stddev);
    const bool inside = std::abs(ratio) < 1 && row.dot(g) > 0;
    if (agrees) (*agrees)[i] = inside;
    if (!inside) continue;
    const double tukey = (1 - ratio * ratio) * (1 - ratio * ratio);
    const double weight = tukey / (sample.stddev * sample.stddev);
    sums.information += weight * row * row.transpose();
    sums.right += weight * row * sample.disparities.front();
    sums.weighted_squares += weight * residual * residual;
    sums.weights += tukey;
    ++sums.count;
  }
  return sums;
}

// Robust size of the residuals as a multiple of the claimed stddevs, over samples near the plane. What stands
// on the ground makes residuals positive only, so the negative ones alone tell the size of the ground's own.
double residualScale(const StereoRig& rig, const std::vector<DisparitySample>& samples,
                     const Eigen::Vector3d& g, double tolerance) {
  std::vector<double> ratios;
  for (const DisparitySample& sample : samples) {
    const double residual = sample.disparities.front() - rig.fb() * g.dot(rig.ray(sample.u, sample.v));
    if (residual <= 0 && residual > -2 * tolerance) ratios.push_back(-residual / sample.stddev);
  }
  if (ratios.empty()) return 1.0;
  return std::max(1.0, 1.4826 * medianOf(ratios));
}

// How much larger the covariance is than independent errors would make it. Surfaces are not planes, and their
// undulations, like errors of texture, are common to neighbouring points: scores are summed over patches of
// the image first (cluster-robust covariance: Liang, Zeger 1986). information: normal matrix already divided
// by the squared scale of the residuals.
double clusterInflation(const StereoRig& rig, const std::vector<DisparitySample>& samples,
                        const Eigen::Vector3d& g, const std::vector<char>& agrees, double scale,
                        const Eigen::Matrix3d& information) {
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
    const Eigen::Vector3d row = rig.fb() * rig.ray(sample.u, sample.v);
    const double residual = sample.disparities.front() - row.dot(g);
    const int column = std::min(kColumns - 1, static_cast<int>(kColumns * sample.u / rig.size.width));
    const int line = std::min(kRows - 1, static_cast<int>(kRows * (sample.v - top) / (bottom - top + 1)));
    scores[line * kColumns + column] += row * (residual / (sample.stddev * sample.stddev * scale * scale));
  }
  Eigen::Matrix3d middle = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& score : scores) middle += score * score.transpose();
  return std::max(1.0, (information.inverse() * middle).trace() / 3.0);
}

// Square of the height by which the surface near the camera rises and falls about the plane. Matches scatter,
// too, and not only by what they claim: but an undulation is common to neighbours and the scatter is not. So
// it is what the means of patches differ by, beyond what the scatter within the patches explains (one-way
// analysis of variance). Unbiased: below zero by chance on flat ground.
double surfaceVariance(const StereoRig& rig, const std::vector<DisparitySample>& samples,
                       const Eigen::Vector3d& g, const std::vector<char>& agrees) {
  // Share of the largest disparity; farther away a pixel is too much height to say anything of the surface.
  constexpr double kNear = 0.4;
  constexpr int kColumns = 10;  // patches along a row of the image; square
  constexpr int kFewest = 3;    // points of a patch
  struct Patch {
    int count = 0;
    double sum = 0, squares = 0;
  };
  const Eigen::Vector3d row = rig.fb() * g;
  double largest = 0;
  for (size_t i = 0; i < samples.size(); ++i) {
    if (agrees[i]) largest = std::max(largest, row.dot(rig.ray(samples[i].u, samples[i].v)));
  }
  std::map<std::pair<int, int>, Patch> patches;
  for (size_t i = 0; i < samples.size(); ++i) {
    const double expected = row.dot(rig.ray(samples[i].u, samples[i].v));
    if (!agrees[i] || expected < kNear * largest) continue;
    const double height = (samples[i].disparities.front() - expected) / (g.norm() * expected);
    const double side = static_cast<double>(rig.size.width) / kColumns;
    Patch& patch = patches[{static_cast<int>(samples[i].u / side), static_cast<int>(samples[i].v / side)}];
    ++patch.count;
    patch.sum += height;
    patch.squares += height * height;
  }
  double scatter = 0, means = 0, of_scatter = 0;
  int points = 0, used = 0;
  for (const auto& [place, patch] : patches) {
    if (patch.count < kFewest) continue;
    ++used;
    points += patch.count;
    const double mean = patch.sum / patch.count;
    scatter += patch.squares - patch.count * mean * mean;
    means += mean * mean;
    of_scatter += 1.0 / patch.count;
  }
  if (used == 0) return 0;
  const double within = scatter / (points - used);
  return (means - of_scatter * within) / used;
}

}  // namespace

bool isPlausibleGround(const Eigen::Vector3d& g, const PlaneLimits& limits) {
  if (!g.allFinite() || !(g.y() > 0)) return false;
  const Eigen::Vector3d n = g.normalized();
  return std::abs(pitchOf(n)) <= limits.max_pitch && std::abs(rollOf(n)) <= limits.max_roll;
}

Consensus findPlane(const StereoRig& rig, const std::vector<DisparitySample>& samples,
                    const PlaneLimits& limits, int iterations, const Eigen::Vector2d* slope_range) {
  // Implausible triples cost next to nothing, so that many may be drawn for each that is counted.
  constexpr int kDrawsPerIteration = 20;
  Consensus best;
  if (samples.size() < 3) return best;
  std::mt19937 random(20100601u);
  int counted = 0;
  for (int draw = 0; draw < kDrawsPerIteration * iterations && counted < iterations; ++draw) {
    const Eigen::Vector3d g = draw % 2 == 0 ? throughThree(rig, samples, random)
                                            : throughTwo(rig, samples, limits.max_roll, random);
    if (!isPlausibleGround(g, limits)) continue;
    const double slope = rig.fb() * g.y() / rig.fy;
    if (slope_range && (slope < slope_range->x() || slope > slope_range->y())) continue;
    ++counted;
    const Votes votes = votesFor(rig, samples, g, limits.tolerance);
    if (best.found && votes.net() <= best.score) continue;
    best = {g, votes.agreeing, votes.net(), true};
    improve(rig, samples, limits, best);
  }
  return best;
}

Expected<PlaneFit> refinePlane(const StereoRig& rig, const std::vector<DisparitySample>& samples,
                               const Eigen::Vector3d& start, const PlaneLimits& limits, double bias_stddev) {
  constexpr int kIterations = 6;
  PlaneFit fit;
  fit.agrees.assign(samples.size(), 0);
  Eigen::Vector3d g = start;
  double scale = 1;
  NormalEquations sums;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    scale = residualScale(rig, samples, g, limits.tolerance);
    sums = accumulate(rig, samples, g, scale, &fit.agrees);
    if (sums.count < limits.min_points) {
      return tl::make_unexpected(Failure{
          Reason::kNoPlane, std::to_string(sums.count) + " of " + std::to_string(samples.size()) +
                                " matches agree, at least " + std::to_string(limits.min_points) + " needed"});
    }
    g = sums.information.ldlt().solve(sums.right);
  }
  if (!isPlausibleGround(g, limits)) {
    return tl::make_unexpected(Failure{Reason::kNoPlane, "the plane is outside the limits of pitch or roll"});
  }
  fit.count = sums.count;
  fit.residual_stddev = std::sqrt(std::max(0.0, sums.weighted_squares / sums.information(2, 2))) * rig.fb();
  fit.plane.g = g;
  fit.surface_variance = surfaceVariance(rig, samples, g, fit.agrees);
  const Eigen::Vector3d common = Eigen::Vector3d::UnitZ() * (bias_stddev / rig.fb());
  const Eigen::Matrix3d information = sums.information / (scale * scale);
  const double inflation = clusterInflation(rig, samples, g, fit.agrees, scale, information);
  fit.plane.covariance = inflation * information.inverse() + common * common.transpose();
  return fit;
}

}  // namespace uav_landing
