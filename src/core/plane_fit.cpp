#include "uav_landing/plane_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>

#include "lanes.h"
#include "multiversion.h"

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

size_t padded(size_t count) { return (count + kDoubleLanes - 1) / kDoubleLanes * kDoubleLanes; }

// The samples by columns, filled up to whole lanes with what has no vote.
struct VoteColumns {
  static constexpr double kNowhere = -1e18;

  std::vector<double> x, y;  // derivatives of the disparity by the plane vector; by its third component: fb
  std::vector<double> u, disparity;  // the first disparity
  double fb, offset;
  bool ambiguous = false;  // samples with several disparities

  VoteColumns(const StereoRig& rig, const std::vector<DisparitySample>& samples)
      : x(padded(samples.size()), 0),
        y(x),
        u(x.size(), kNowhere),
        disparity(u),
        fb(rig.fb()),
        offset(rig.principalOffset()) {
    for (size_t i = 0; i < samples.size(); ++i) {
      const Eigen::Vector3d row = fb * rig.ray(samples[i].u, samples[i].v);
      x[i] = row.x();
      y[i] = row.y();
      u[i] = samples[i].u;
      disparity[i] = samples[i].disparity;
      ambiguous |= !samples[i].others.empty();
    }
  }
};

// A sample whose place in the right image is outside of it says nothing against the plane, whatever it
// matched instead.
UAV_LANDING_MULTIVERSION void addVotes(const VoteColumns& columns, const Eigen::Vector3d& g, double tolerance,
                                       Votes& votes) {
  const double gx = g.x(), gy = g.y(), constant = g.z() * columns.fb;
  const double unit = 1 / (tolerance * tolerance), far = 2 * tolerance;
  const DoubleLanes none{}, below = none + kBelowPenalty, above = none + kAbovePenalty;
  DoubleLanes agreeing{}, penalty{};
  for (size_t i = 0; i < columns.x.size(); i += kDoubleLanes) {
    DoubleLanes x, y, u, disparity;
    load(&columns.x[i], x);
    load(&columns.y[i], y);
    load(&columns.u[i], u);
    load(&columns.disparity[i], disparity);
    const DoubleLanes expected = gx * x + gy * y + constant, residual = disparity - expected;
    const DoubleLanes missing = 1 - residual * residual * unit;
    const auto counts = expected >= kMinDisparity;
    const auto seen = u - expected >= columns.offset;
    const DoubleLanes price = residual < -far ? below : above;
    agreeing += (counts & (missing > 0)) ? missing : none;
    penalty += (counts & seen & (missing <= 0)) ? price : none;
  }
  votes.agreeing += sum(agreeing);
  votes.penalty += sum(penalty);
}

// The same for samples that may have several disparities: the nearest one votes, and only when all are too
// small does it lie below.
void addAmbiguousVotes(const VoteColumns& columns, const std::vector<DisparitySample>& samples,
                       const Eigen::Vector3d& g, double tolerance, Votes& votes) {
  for (size_t i = 0; i < samples.size(); ++i) {
    const double expected = g.x() * columns.x[i] + g.y() * columns.y[i] + g.z() * columns.fb;
    if (expected < kMinDisparity) continue;
    double nearest = std::abs(samples[i].disparity - expected), largest = samples[i].disparity;
    for (const double disparity : samples[i].others) {
      nearest = std::min(nearest, std::abs(disparity - expected));
      largest = std::max(largest, disparity);
    }
    const double ratio = nearest / tolerance;
    if (ratio < 1) {
      votes.agreeing += 1 - ratio * ratio;
    } else if (columns.u[i] - expected >= columns.offset) {
      votes.penalty += largest < expected - 2 * tolerance ? kBelowPenalty : kAbovePenalty;
    }
  }
}

// What a search for the plane has of the samples.
struct Voters {
  const StereoRig& rig;
  const std::vector<DisparitySample>& samples;
  VoteColumns columns{rig, samples};

  Votes votesFor(const Eigen::Vector3d& g, double tolerance) const {
    Votes votes;
    const double tens = rollOf(g) * 18.0 / M_PI;
    votes.penalty = kRollPenalty * tens * tens;
    if (columns.ambiguous) {
      addAmbiguousVotes(columns, samples, g, tolerance, votes);
    } else {
      addVotes(columns, g, tolerance, votes);
    }
    return votes;
  }
};

// Uniform integer below n: std distributions differ between standard libraries, this does not.
size_t below(std::mt19937& random, size_t n) { return random() % n; }

// Least squares over what agrees with a new best plane (locally optimised RANSAC: Chum, Matas, Kittler 2003).
void improve(const Voters& voters, const PlaneLimits& limits, Consensus& best) {
  constexpr int kRounds = 2;
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (size_t i = 0; i < voters.samples.size(); ++i) {
      const Eigen::Vector3d row(voters.columns.x[i], voters.columns.y[i], voters.columns.fb);
      const auto add = [&](double disparity) {
        const double ratio = (disparity - row.dot(best.g)) / limits.tolerance;
        if (std::abs(ratio) >= 1) return;
        const double weight = 1 - ratio * ratio;
        information += weight * row * row.transpose();
        right += weight * row * disparity;
      };
      add(voters.samples[i].disparity);
      for (const double disparity : voters.samples[i].others) add(disparity);
    }
    const Eigen::Vector3d g = information.ldlt().solve(right);
    if (!isPlausibleGround(g, limits)) return;
    const Votes votes = voters.votesFor(g, limits.tolerance);
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
    const size_t choice = below(random, 1 + sample.others.size());
    disparity = choice == 0 ? sample.disparity : sample.others[choice - 1];
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

// Robust size of the residuals as a multiple of the claimed stddevs, at least 1. ratios: reordered.
double scaleOf(std::vector<double>& ratios) {
  constexpr double kPerMedian = 1.4826;
  if (ratios.empty()) return 1;
  const auto small =
      std::count_if(ratios.begin(), ratios.end(), [](double r) { return kPerMedian * r <= 1; });
  if (static_cast<size_t>(small) > ratios.size() / 2) return 1;  // the median is among them
  const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::nth_element(ratios.begin(), middle, ratios.end());
  return std::max(1.0, kPerMedian * *middle);
}

struct NormalEquations {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  double weighted_squares = 0;
  int count = 0;
};

// The least squares problem by columns, filled up to whole lanes with samples of no weight.
class PlaneProblem {
 public:
  PlaneProblem(const StereoRig& rig, const std::vector<DisparitySample>& samples)
      : count_(samples.size()),
        fb_(rig.fb()),
        x_(padded(count_), 0),
        y_(x_),
        disparity_(x_),
        precision_(x_),
        expected_(x_),
        weight_(x_) {
    ratios_.reserve(count_);
    for (size_t i = 0; i < count_; ++i) {
      const Eigen::Vector3d row = fb_ * rig.ray(samples[i].u, samples[i].v);
      x_[i] = row.x();
      y_[i] = row.y();
      disparity_[i] = samples[i].disparity;
      precision_[i] = 1 / samples[i].stddev;
    }
  }

  // The disparities that a plane gives.
  UAV_LANDING_MULTIVERSION void expect(const Eigen::Vector3d& g) {
    const double gx = g.x(), gy = g.y(), constant = g.z() * fb_;
    const double *x = x_.data(), *y = y_.data();
    double* __restrict expected = expected_.data();
    for (size_t i = 0; i < x_.size(); ++i) expected[i] = gx * x[i] + gy * y[i] + constant;
  }

  // Robust size of the residuals as a multiple of the claimed stddevs, over samples near the plane. What
  // stands on the ground makes residuals positive only, so the negative ones alone tell the size of the
  // ground's own.
  double residualScale(double tolerance) {
    ratios_.resize(count_);
    size_t used = 0;
    for (size_t i = 0; i < count_; ++i) {
      const double residual = disparity_[i] - expected_[i];
      ratios_[used] = -residual * precision_[i];
      used += (residual <= 0) & (residual > -2 * tolerance);  // no branch: half of them are, at random
    }
    ratios_.resize(used);
    return scaleOf(ratios_);
  }

  // One reweighting step: Tukey weights of the residuals over scale times each sample's own stddev.
  UAV_LANDING_MULTIVERSION NormalEquations accumulate(double scale) {
    constexpr double kTukey = 4.0;
    const double unit = 1 / (kTukey * kTukey * scale * scale);
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
  size_t count_;
  double fb_;
  std::vector<double> x_, y_;  // derivatives of the disparity by the plane vector; by its third component: fb
  std::vector<double> disparity_, precision_;  // precision: 1 / stddev
  std::vector<double> expected_, weight_, ratios_;
};

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
    const double residual = sample.disparity - row.dot(g);
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
  const double side = static_cast<double>(rig.size.width) / kColumns, unit = 1 / g.norm();
  const int rows = static_cast<int>(rig.size.height / side) + 1;
  std::vector<Patch> patches(static_cast<size_t>(kColumns * rows));
  for (size_t i = 0; i < samples.size(); ++i) {
    const double expected = row.dot(rig.ray(samples[i].u, samples[i].v));
    if (!agrees[i] || expected < kNear * largest) continue;
    const double height = unit * (samples[i].disparity - expected) / expected;
    const int across = std::clamp(static_cast<int>(samples[i].u / side), 0, kColumns - 1);
    const int down = std::clamp(static_cast<int>(samples[i].v / side), 0, rows - 1);
    Patch& patch = patches[static_cast<size_t>(across * rows + down)];
    ++patch.count;
    patch.sum += height;
    patch.squares += height * height;
  }
  double scatter = 0, means = 0, of_scatter = 0;
  int points = 0, used = 0;
  for (const Patch& patch : patches) {
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
  const Voters voters{rig, samples};
  std::mt19937 random(20100601u);
  int counted = 0;
  for (int draw = 0; draw < kDrawsPerIteration * iterations && counted < iterations; ++draw) {
    const Eigen::Vector3d g = draw % 2 == 0 ? throughThree(rig, samples, random)
                                            : throughTwo(rig, samples, limits.max_roll, random);
    if (!isPlausibleGround(g, limits)) continue;
    const double slope = rig.fb() * g.y() / rig.fy;
    if (slope_range && (slope < slope_range->x() || slope > slope_range->y())) continue;
    ++counted;
    const Votes votes = voters.votesFor(g, limits.tolerance);
    if (best.found && votes.net() <= best.score) continue;
    best = {g, votes.agreeing, votes.net(), true};
    improve(voters, limits, best);
  }
  return best;
}

Expected<PlaneFit> refinePlane(const StereoRig& rig, const std::vector<DisparitySample>& samples,
                               const Eigen::Vector3d& start, const PlaneLimits& limits, double bias_stddev) {
  constexpr int kIterations = 6;
  Eigen::Vector3d g = start;
  double scale = 1;
  PlaneProblem problem(rig, samples);
  NormalEquations sums;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    problem.expect(g);
    scale = problem.residualScale(limits.tolerance);
    sums = problem.accumulate(scale);
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
  PlaneFit fit;
  fit.agrees = problem.agreeing();
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
