#include "stereo/plane/plane_consensus.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <random>

#include "estimation/ransac.h"
#include "kernels/samples/plane_votes.h"
#include "uav_landing/geometry/ground_plane.h"

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

// The samples: x and y are derivatives of the disparity by the plane vector; by its third component it is fb.
// Of several disparities of a sample the first one.
VoteColumns columnsOf(const StereoRig& rig, const std::vector<DisparitySample>& samples) {
  VoteColumns columns(samples.size());
  for (size_t i = 0; i < samples.size(); ++i) {
    const Eigen::Vector3d row = rig.fb() * rig.ray(samples[i].u, samples[i].v);
    columns.x[i] = row.x();
    columns.y[i] = row.y();
    columns.u[i] = samples[i].u;
    columns.value[i] = samples[i].disparity;
  }
  return columns;
}

bool areAmbiguous(const std::vector<DisparitySample>& samples) {
  return std::any_of(samples.begin(), samples.end(),
                     [](const DisparitySample& sample) { return !sample.others.empty(); });
}

// Adds the votes of samples that may have several disparities: the nearest one votes, and only when all are
// too small does it lie below.
void addAmbiguousVotes(const VoteColumns& columns, const std::vector<DisparitySample>& samples,
                       const LinearValue& plane, const VoteRules& rules, Votes& votes) {
  for (size_t i = 0; i < samples.size(); ++i) {
    const double expected = plane.x_slope * columns.x[i] + plane.y_slope * columns.y[i] + plane.constant;
    if (expected < rules.least) continue;
    double nearest = std::abs(samples[i].disparity - expected), largest = samples[i].disparity;
    for (const double disparity : samples[i].others) {
      nearest = std::min(nearest, std::abs(disparity - expected));
      largest = std::max(largest, disparity);
    }
    const double ratio = nearest / rules.tolerance;
    if (ratio < 1) {
      votes.agreeing += 1 - ratio * ratio;
    } else if (columns.u[i] - expected >= rules.offset) {
      votes.penalty += largest < expected - 2 * rules.tolerance ? rules.below : rules.above;
    }
  }
}

// What a search for the plane has of the samples.
struct Voters {
  const StereoRig& rig;
  const std::vector<DisparitySample>& samples;
  VoteColumns columns = columnsOf(rig, samples);
  bool ambiguous = areAmbiguous(samples);  // samples with several disparities

  // A sample whose place in the right image is outside of it says nothing against the plane, whatever it
  // matched instead.
  Votes votesFor(const Eigen::Vector3d& g, double tolerance) const {
    const double tens = rollOf(g) * 18.0 / M_PI;
    const double by_roll = kRollPenalty * tens * tens;
    const LinearValue plane{g.x(), g.y(), g.z() * rig.fb()};
    const VoteRules rules{tolerance, kMinDisparity, rig.principalOffset(), kBelowPenalty, kAbovePenalty};
    Votes votes;
    if (ambiguous) {
      votes.penalty = by_roll;
      addAmbiguousVotes(columns, samples, plane, rules, votes);
    } else {
      votes = voteForPlane(columns, plane, rules);
      votes.penalty += by_roll;
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
      const Eigen::Vector3d row(voters.columns.x[i], voters.columns.y[i], voters.rig.fb());
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

}  // namespace

Consensus findPlane(const StereoRig& rig, const std::vector<DisparitySample>& samples,
                    const PlaneLimits& limits, int iterations, const Eigen::Vector2d* slope_range,
                    bool until_sure, const Eigen::Vector3d* expected) {
  // Implausible triples cost next to nothing, so that many may be drawn for each that is counted.
  constexpr int kDrawsPerIteration = 20;
  constexpr double kBeyondDoubt = 0.8;  // of the votes if all samples were exactly on the plane
  Consensus best;
  if (samples.size() < 3) return best;
  const Voters voters{rig, samples};
  const auto all = static_cast<double>(samples.size());
  RansacOptions options;
  options.most = iterations;
  options.draws_each = kDrawsPerIteration;
  options.of_draws = 0.5;  // every other one is a triple
  RansacBudget budget(options);
  const auto consider = [&](const Eigen::Vector3d& g) {
    const Votes votes = voters.votesFor(g, limits.tolerance);
    if (best.found && votes.net() <= best.score) return;
    best = {g, votes.agreeing, votes.net(), true};
    improve(voters, limits, best);
    // Penalties only take away: a better plane has at least the votes that are left of this one's.
    if (until_sure) budget.found(best.score / all);
  };
  if (expected != nullptr && isPlausibleGround(*expected, limits)) {
    consider(*expected);
    if (best.score >= kBeyondDoubt * all) return best;
  }
  std::mt19937 random(20100601u);
  for (int draw = 0; budget.goesOn(); ++draw) {
    const Eigen::Vector3d g = draw % 2 == 0 ? throughThree(rig, samples, random)
                                            : throughTwo(rig, samples, limits.max_roll, random);
    // The slope first: it takes less time, and most planes that are drawn have another one.
    const double slope = rig.fb() * g.y() / rig.fy;
    if (slope_range && !(slope >= slope_range->x() && slope <= slope_range->y())) continue;
    if (!isPlausibleGround(g, limits)) continue;
    budget.count();
    consider(g);
  }
  return best;
}

}  // namespace uav_landing
