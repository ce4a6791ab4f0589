#include "stereo/plane/plane_consensus.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <random>

#include "estimation/ransac.h"
#include "kernels/lanes/lanes.h"
#include "kernels/samples/plane_votes.h"
#include "uav_landing/geometry/ground_plane.h"

namespace uav_landing {
namespace {

// Share of a full vote that a sample below the plane costs, as nothing lies below the ground.
constexpr double kBelowPenalty = 0.5;
// The same for a sample above the plane. It may stand on the ground, but a plane below everything is not the
// ground.
constexpr double kAbovePenalty = 0.1;
// Votes that a roll of ten degrees costs; the cost grows with its square. An aircraft that lands is nearly
// level, but planes through walls and slopes are not.
constexpr double kRollPenalty = 1.0;
// Smallest disparity of the plane at a sample that counts, in pixels. Nearer the horizon all samples agree.
constexpr double kMinDisparity = 1.0;

// Indices of the samples, those with the most disparities first.
std::vector<size_t> orderOf(const std::vector<DisparitySample>& samples) {
  std::vector<size_t> order(samples.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return samples[a].others.size() > samples[b].others.size(); });
  return order;
}

// The samples as columns for voting. x and y are the derivatives of the disparity by the first two components
// of the plane vector. The derivative by the third is fb.
struct Voters {
  const StereoRig& rig;
  const std::vector<DisparitySample>& samples;
  std::vector<size_t> order = orderOf(samples);  // of the columns
  VoteColumns columns{samples.size()};

  Voters(const StereoRig& stereo_rig, const std::vector<DisparitySample>& all)
      : rig(stereo_rig), samples(all) {
    for (size_t i = 0; i < order.size(); ++i) {
      const DisparitySample& sample = samples[order[i]];
      const Eigen::Vector3d row = rig.fb() * rig.ray(sample.u, sample.v);
      columns.x[i] = row.x();
      columns.y[i] = row.y();
      columns.u[i] = sample.u;
      columns.value[i] = sample.disparity;
      for (size_t k = 0; k < sample.others.size(); ++k) other(k, i) = sample.others[k];
    }
  }

  // When the plane puts a sample outside the right image, its match says nothing against the plane.
  Votes votesFor(const PlaneVector& plane, double tolerance) const {
    const Eigen::Vector3d& g = plane;
    const double tens = rollOf(g) * 18.0 / M_PI;
    const LinearValue disparity{g.x(), g.y(), g.z() * rig.fb()};
    const VoteRules rules{tolerance, kMinDisparity, rig.principalOffset(), kBelowPenalty, kAbovePenalty};
    Votes votes = voteForPlane(columns, disparity, rules);
    votes.penalty += kRollPenalty * tens * tens;
    return votes;
  }

  // Mean number of disparities that a sample may have.
  double choices() const {
    double all = static_cast<double>(samples.size());
    for (const DisparitySample& sample : samples) all += static_cast<double>(sample.others.size());
    return all / static_cast<double>(samples.size());
  }

 private:
  double& other(size_t column, size_t sample) {
    if (column == columns.others.size()) columns.others.emplace_back();
    std::vector<double>& values = columns.others[column];
    if (sample >= values.size()) values.resize(wholeDoubleLanes(sample + 1), VoteColumns::kNowhere);
    return values[sample];
  }
};

// Uniform integer below n. Standard distributions differ between libraries, this does not.
size_t below(std::mt19937& random, size_t n) { return random() % n; }

// Least squares over the samples that agree with a new best plane (locally optimised RANSAC: Chum, Matas,
// Kittler 2003).
void improve(const Voters& voters, const PlaneLimits& limits, Consensus& best) {
  constexpr int kRounds = 2;
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (size_t i = 0; i < voters.order.size(); ++i) {
      const DisparitySample& sample = voters.samples[voters.order[i]];
      const Eigen::Vector3d row(voters.columns.x[i], voters.columns.y[i], voters.rig.fb());
      const auto add = [&](double disparity) {
        const double ratio = (disparity - row.dot(best.g.vector())) / limits.tolerance;
        if (std::abs(ratio) >= 1) return;
        const double weight = 1 - ratio * ratio;
        information += weight * row * row.transpose();
        right += weight * row * disparity;
      };
      add(sample.disparity);
      for (const double disparity : sample.others) add(disparity);
    }
    const std::optional<PlaneVector> g = PlaneVector::of(information.ldlt().solve(right));
    if (!g || !isPlausibleGround(*g, limits)) return;
    const Votes votes = voters.votesFor(*g, limits.tolerance);
    if (votes.net() <= best.score) return;
    best = {*g, votes.agreeing, votes.net()};
  }
}

// One of the disparities of one of the samples, drawn at random.
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

// Plane through three samples, if they are not nearly in line.
std::optional<PlaneVector> throughThree(const StereoRig& rig, const std::vector<DisparitySample>& samples,
                                        std::mt19937& random) {
  const Draw a(rig, samples, random), b(rig, samples, random), c(rig, samples, random);
  const Eigen::Vector3d bc = b.ray.cross(c.ray);
  const double volume = a.ray.dot(bc);
  if (std::abs(volume) < 1e-4) return std::nullopt;
  return PlaneVector::of(
      (a.disparity * bc + b.disparity * c.ray.cross(a.ray) + c.disparity * a.ray.cross(b.ray)) /
      (volume * rig.fb()));
}

// Plane through two samples and a random roll, mostly a small one. When little of the image is ground, two
// samples on it are found much sooner than three.
std::optional<PlaneVector> throughTwo(const StereoRig& rig, const std::vector<DisparitySample>& samples,
                                      double max_roll, std::mt19937& random) {
  const Draw a(rig, samples, random), b(rig, samples, random);
  const double triangular = (below(random, 1001) + below(random, 1001)) / 1000.0 - 1.0;
  const double slope = std::tan(max_roll * triangular);
  const double ya = a.ray.y() + slope * a.ray.x(), yb = b.ray.y() + slope * b.ray.x();
  if (std::abs(ya - yb) < 0.02) return std::nullopt;
  const double gy = (a.disparity - b.disparity) / (ya - yb) / rig.fb();
  return PlaneVector::of({slope * gy, gy, a.disparity / rig.fb() - gy * ya});
}

bool isWithin(const Eigen::Vector2d& range, double value) { return value >= range.x() && value <= range.y(); }

// Draws planes through two samples. A sample may have many disparities, mostly wrong ones, so many draws are
// needed and each has to be cheap.
class PairDraws {
 public:
  PairDraws(const StereoRig& rig, const std::vector<DisparitySample>& samples, double max_roll)
      : fb_(rig.fb()), steepest_(std::tan(max_roll)) {
    for (const DisparitySample& sample : samples) {
      first_.push_back(disparities_.size());
      disparities_.push_back(sample.disparity);
      disparities_.insert(disparities_.end(), sample.others.begin(), sample.others.end());
      rays_.push_back(rig.ray(sample.u, sample.v));
    }
    first_.push_back(disparities_.size());
  }

  // Plane through two samples and a random roll.
  std::optional<PlaneVector> next() {
    const size_t a = below(rays_.size()), b = below(rays_.size());
    const double triangular = static_cast<double>(below(1001) + below(1001)) / 1000.0 - 1.0;
    const double slope = steepest_ * triangular;
    const double ya = rays_[a].y() + slope * rays_[a].x(), yb = rays_[b].y() + slope * rays_[b].x();
    if (std::abs(ya - yb) < 0.02) return std::nullopt;
    const double da = disparityOf(a), db = disparityOf(b);
    const double gy = (da - db) / ((ya - yb) * fb_);
    return PlaneVector::of({slope * gy, gy, da / fb_ - gy * ya});
  }

 private:
  size_t below(size_t n) { return static_cast<size_t>((std::uint64_t{random_()} * n) >> 31U); }
  double disparityOf(size_t sample) {
    return disparities_[first_[sample] + below(first_[sample + 1] - first_[sample])];
  }

  double fb_, steepest_;
  std::vector<size_t> first_;
  std::vector<double> disparities_;
  std::vector<Eigen::Vector3d> rays_;
  std::minstd_rand random_{20100601U};
};

}  // namespace

std::optional<Consensus> findPlane(const StereoRig& rig, const std::vector<DisparitySample>& samples,
                                   const PlaneLimits& limits, const ConsensusOptions& options) {
  constexpr double kBeyondDoubt = 0.8;  // share of the votes that all samples would give
  constexpr double kRightRoll = 0.2;    // share of the random rolls with which two samples on the plane give
                                        // the plane
  if (samples.size() < 3) return std::nullopt;
  const Voters voters{rig, samples};
  const auto all = static_cast<double>(samples.size());
  RansacOptions draws;
  draws.most = options.iterations;
  draws.draws_each = options.draws_each;
  if (options.slope_range) {
    draws.sample = 2;
    draws.of_draws = kRightRoll;
  } else {
    draws.of_draws = 0.5;  // every second draw takes three samples
  }
  RansacBudget budget(draws);
  const double right_choice = 1 / voters.choices();
  std::optional<Consensus> best;
  const auto consider = [&](const PlaneVector& g) {
    const Votes votes = voters.votesFor(g, limits.tolerance);
    if (best && votes.net() <= best->score) return;
    best = {g, votes.agreeing, votes.net()};
    improve(voters, limits, *best);
    // Penalties only reduce the score, so a better plane has at least as many votes as this score.
    if (options.until_sure) budget.found(right_choice * best->score / all);
  };
  if (options.expected && isPlausibleGround(*options.expected, limits)) {
    consider(*options.expected);
    if (best->score >= kBeyondDoubt * all) return best;
  }
  if (options.slope_range) {
    PairDraws pairs(rig, samples, limits.max_roll);
    while (budget.goesOn()) {
      const std::optional<PlaneVector> g = pairs.next();
      // The slope is tested first, because it rules out most planes.
      if (!g || !isWithin(*options.slope_range, rig.fb() * g->vector().y() / rig.fy)) continue;
      if (!isPlausibleGround(*g, limits)) continue;
      budget.count();
      consider(*g);
    }
    return best;
  }
  std::mt19937 random(20100601u);
  for (int draw = 0; budget.goesOn(); ++draw) {
    const std::optional<PlaneVector> g = draw % 2 == 0 ? throughThree(rig, samples, random)
                                                       : throughTwo(rig, samples, limits.max_roll, random);
    if (!g || !isPlausibleGround(*g, limits)) continue;
    budget.count();
    consider(*g);
  }
  return best;
}

}  // namespace uav_landing
