#include "stereo/plane/plane_consensus.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <random>

#include "estimation/ransac.h"
#include "kernels/lanes/lanes.h"
#include "kernels/lanes/multiversion.h"
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

struct Votes {
  double agreeing = 0;  // MSAC votes of the samples on the plane
  double penalty = 0;   // of those off it
  double net() const { return agreeing - penalty; }
};

// The samples by columns, filled up to whole lanes with what has no vote.
struct VoteColumns {
  static constexpr double kNowhere = -1e18;

  std::vector<double> x, y;  // derivatives of the disparity by the plane vector; by its third component: fb
  std::vector<double> u, disparity;  // the first disparity
  double fb, offset;
  bool ambiguous = false;  // samples with several disparities

  VoteColumns(const StereoRig& rig, const std::vector<DisparitySample>& samples)
      : x(wholeDoubleLanes(samples.size()), 0),
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
