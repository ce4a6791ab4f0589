#include "stereo/plane/plane_fit.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <random>

#include "stereo/plane/plane_consensus.h"
#include "stereo/surface/surface_variance.h"
#include "support/consistency.h"
#include "support/ground_renderer.h"

namespace uav_landing {
namespace {

using test::kDegree;

constexpr int kWindow = 11;  // pixels, of the matches of corners

PlaneLimits makeLimits() {
  PlaneLimits limits;
  limits.max_roll = limits.max_pitch = 30 * kDegree;
  limits.min_points = 20;
  limits.tolerance = 0.6;
  return limits;
}

const StereoRig& rig() {
  static const StereoRig rig = test::makeRig(640, 480, 1.0);
  return rig;
}

PlaneVector plane(double height, double pitch_deg, double roll_deg) {
  test::Pose pose;
  pose.pitch = pitch_deg * kDegree;
  pose.roll = roll_deg * kDegree;
  return PlaneVector(pose.down() / height);
}

/// Disparities of random ground pixels, each by cutting its ray with the plane g.X = 1.
class Sampler {
 public:
  explicit Sampler(unsigned seed) : random_(seed) {}

  std::vector<DisparitySample> ground(const PlaneVector& g, int count, double stddev) {
    std::vector<DisparitySample> samples;
    while (static_cast<int>(samples.size()) < count) {
      const double u = uniform_(random_) * (rig().size.width - 1);
      const double v = uniform_(random_) * (rig().size.height - 1);
      const double depth = rig().fb() / g.disparity(rig(), u, v);
      if (!(depth > 0 && depth < rig().fb())) continue;  // from one pixel of disparity on
      samples.push_back({u, v, std::max(stddev, 1e-3), {rig().fb() / depth + stddev * normal_(random_)}});
    }
    return samples;
  }

  /// Lifts a share of the samples to between 1.05 and 2 times their disparity, as what stands above the
  /// ground.
  void lift(std::vector<DisparitySample>& samples, double share) {
    for (DisparitySample& sample : samples)
      if (uniform_(random_) < share) sample.disparity *= 1.05 + 0.95 * uniform_(random_);
  }

  double normal() { return normal_(random_); }

 private:
  std::mt19937 random_;
  std::uniform_real_distribution<double> uniform_;
  std::normal_distribution<double> normal_;
};

TEST(IsPlausibleGround, KnowsItsLimits) {
  const PlaneLimits limits = makeLimits();
  for (const double pitch : {-29.0, 0.0, 29.0})
    for (const double roll : {-29.0, 0.0, 29.0})
      EXPECT_TRUE(isPlausibleGround(plane(5, pitch, roll), limits));
  for (const double pitch : {-31.0, 31.0}) EXPECT_FALSE(isPlausibleGround(plane(5, pitch, 0), limits));
  for (const double roll : {-31.0, 31.0}) EXPECT_FALSE(isPlausibleGround(plane(5, 0, roll), limits));
  EXPECT_FALSE(isPlausibleGround(PlaneVector(-plane(5, 0, 0).vector()), limits)) << "a ceiling";
}

TEST(PlaneFit, IsExactOnExactData) {
  Sampler sampler(1);
  for (const double height : {0.5, 3.0, 30.0})
    for (const double pitch : {-15.0, -4.0, 3.0})
      for (const double roll : {-10.0, 0.0, 10.0}) {
        const PlaneVector g = plane(height, pitch, roll);
        const std::vector<DisparitySample> samples = sampler.ground(g, 200, 0);
        const std::optional<Consensus> consensus = findPlane(rig(), samples, makeLimits(), {200});
        ASSERT_TRUE(consensus) << height << " " << pitch << " " << roll;
        EXPECT_GT(consensus->support, 190);
        const Expected<PlaneFit> fit = refinePlane(rig(), {samples}, consensus->g, makeLimits());
        ASSERT_TRUE(fit) << fit.error().message();
        EXPECT_TRUE(fit->plane.g.isApprox(g.vector(), 1e-9)) << height << " " << pitch << " " << roll;
        EXPECT_EQ(fit->count, 200);
      }
}

TEST(PlaneFit, IsNotPulledByFortyPercentAboveTheGround) {
  const PlaneVector g = plane(6, -6, 4);
  for (unsigned seed = 1; seed <= 10; ++seed) {
    Sampler sampler(seed);
    std::vector<DisparitySample> samples = sampler.ground(g, 300, 0.1);
    sampler.lift(samples, 0.4);
    const std::optional<Consensus> consensus = findPlane(rig(), samples, makeLimits(), {200});
    ASSERT_TRUE(consensus);
    const Expected<PlaneFit> fit = refinePlane(rig(), {samples}, consensus->g, makeLimits());
    ASSERT_TRUE(fit);
    EXPECT_NEAR(fit->plane.height(), 6, 4 * std::sqrt(fit->plane.heightVariance())) << seed;
    EXPECT_NEAR(fit->plane.height(), 6, 0.005 * 6) << seed;
    EXPECT_NEAR(pitchOf(fit->plane.normal()), -6 * kDegree, 0.1 * kDegree) << seed;
    EXPECT_NEAR(rollOf(fit->plane.normal()), 4 * kDegree, 0.2 * kDegree) << seed;
    for (size_t i = 0; i < samples.size(); ++i) {
      const double above = samples[i].disparity - g.disparity(rig(), samples[i].u, samples[i].v);
      EXPECT_FALSE(above > 2 && fit->agrees[i]) << above;
      EXPECT_FALSE(std::abs(above) < 0.2 && !fit->agrees[i]) << above;
    }
  }
}

TEST(FindPlane, PrefersTheGroundToALargerPlaneAboveIt) {
  // 45 % on the ground, 55 % on the roof of something 1.5 m tall: nothing lies below the ground.
  const PlaneVector g = plane(6, -6, 0), roof = plane(4.5, -6, 0);
  Sampler sampler(3);
  std::vector<DisparitySample> samples = sampler.ground(g, 135, 0.1);
  const std::vector<DisparitySample> above = sampler.ground(roof, 165, 0.1);
  samples.insert(samples.end(), above.begin(), above.end());
  const std::optional<Consensus> consensus = findPlane(rig(), samples, makeLimits(), {300});
  ASSERT_TRUE(consensus);
  EXPECT_NEAR(consensus->g.height(), 6, 0.1);
}

TEST(FindPlane, MayEndEarlyOnlyWhereNoBetterPlaneIsLeft) {
  // As many on the ground as on the roof, or fewer: the first plane drawn does not decide.
  const PlaneVector g = plane(6, -6, 0), roof = plane(4.5, -6, 0);
  for (unsigned seed = 1; seed <= 20; ++seed)
    for (const int on_ground : {300, 135, 150}) {
      Sampler sampler(seed);
      std::vector<DisparitySample> samples = sampler.ground(roof, 300 - on_ground, 0.1);
      const std::vector<DisparitySample> below = sampler.ground(g, on_ground, 0.1);
      samples.insert(samples.end(), below.begin(), below.end());
      const std::optional<Consensus> consensus = findPlane(rig(), samples, makeLimits(), {300, true});
      ASSERT_TRUE(consensus);
      EXPECT_NEAR(consensus->g.height(), 6, 0.1) << seed << " " << on_ground;
    }
}

TEST(FindPlane, ResolvesSeveralCandidatesPerPixel) {
  const PlaneVector g = plane(4, -5, -3);
  Sampler sampler(5);
  std::vector<DisparitySample> samples = sampler.ground(g, 200, 0.1);
  for (size_t i = 0; i < samples.size(); ++i) {
    // The true one anywhere among four, the others one period and more off, as zebra bars are.
    const double true_disparity = samples[i].disparity;
    std::vector<double> all = {true_disparity + 9, true_disparity + 18, true_disparity - 9};
    all.insert(all.begin() + i % 4, true_disparity);
    samples[i].disparity = all.front();
    samples[i].others.assign(all.begin() + 1, all.end());
  }
  // Three planes fit equally well. All of them are found below the camera; rows tell them apart only by where
  // disparity is zero, so the range of slopes must not decide either.
  const std::optional<Consensus> consensus = findPlane(rig(), samples, makeLimits(), {500});
  ASSERT_TRUE(consensus);
  EXPECT_GT(consensus->support, 150);
  // With 60 pixels of plain texture beside the zebra there is only one.
  const std::vector<DisparitySample> plain = sampler.ground(g, 60, 0.1);
  samples.insert(samples.end(), plain.begin(), plain.end());
  const std::optional<Consensus> decided = findPlane(rig(), samples, makeLimits(), {500});
  ASSERT_TRUE(decided);
  EXPECT_NEAR(decided->g.height(), 4, 0.1);
}

TEST(FindPlane, KeepsToTheRangeOfSlopes) {
  // Two planes; the upper one, which would lose, is the only one in the range.
  const PlaneVector low = plane(4, -5, 0), high = plane(2, -5, 0);
  Sampler sampler(6);
  std::vector<DisparitySample> samples = sampler.ground(low, 100, 0.05);
  const std::vector<DisparitySample> above = sampler.ground(high, 100, 0.05);
  samples.insert(samples.end(), above.begin(), above.end());
  const double slope = rig().fb() * high.vector().y() / rig().fy;
  const Eigen::Vector2d around(0.8 * slope, 1.2 * slope);
  EXPECT_NEAR(findPlane(rig(), samples, makeLimits(), {200})->g.height(), 4, 0.1);
  EXPECT_NEAR(findPlane(rig(), samples, makeLimits(), {200, false, around})->g.height(), 2, 0.1);
}

TEST(FindPlane, FindsNothingAmongFewOrImplausibleSamples) {
  Sampler sampler(7);
  EXPECT_FALSE(findPlane(rig(), sampler.ground(plane(4, 0, 0), 2, 0), makeLimits(), {100}));
  EXPECT_FALSE(findPlane(rig(), {}, makeLimits(), {100}));
  PlaneLimits tight = makeLimits();
  tight.max_pitch = 5 * kDegree;
  const std::vector<DisparitySample> steep = sampler.ground(plane(4, -20, 0), 200, 0.02);
  const std::optional<Consensus> consensus = findPlane(rig(), steep, tight, {200});
  EXPECT_LT(consensus->support, 60);
}

TEST(FindPlane, IsDeterministic) {
  Sampler sampler(8);
  std::vector<DisparitySample> samples = sampler.ground(plane(4, -5, 2), 200, 0.2);
  sampler.lift(samples, 0.4);
  EXPECT_EQ(findPlane(rig(), samples, makeLimits(), {100})->g.vector(),
            findPlane(rig(), samples, makeLimits(), {100})->g.vector());
}

/// Mean of the normalised squared errors over many draws, and of each component's alone.
struct Nees {
  double all = 0;
  Eigen::Vector3d each = Eigen::Vector3d::Zero();
};

Nees simulate(const PlaneVector& g, int runs, double actual, double claimed, double common) {
  Sampler sampler(11);
  Nees nees;
  for (int run = 0; run < runs; ++run) {
    std::vector<DisparitySample> samples = sampler.ground(g, 150, actual);
    const double shift = common * sampler.normal();
    for (DisparitySample& sample : samples) {
      sample.stddev = claimed;
      sample.disparity += shift;
    }
    const Expected<PlaneFit> fit = refinePlane(rig(), {samples, common}, g, makeLimits());
    EXPECT_TRUE(fit);
    if (!fit) continue;
    const Eigen::Vector3d error = fit->plane.g - g.vector();
    nees.all += error.dot(fit->plane.covariance.ldlt().solve(error)) / runs;
    nees.each += error.cwiseAbs2().cwiseQuotient(fit->plane.covariance.diagonal()) / runs;
  }
  return nees;
}

// Robust weights and factors that never go below one make the claim a little larger than the scatter.
constexpr double kLeastShare = 0.65;

TEST(RefinePlane, ClaimsTheScatterOfIndependentErrors) {
  constexpr int kRuns = 400;
  for (const PlaneVector& g : {plane(6, -6, 4), plane(0.7, -12, 0), plane(25, -3, -8)}) {
    const Nees nees = simulate(g, kRuns, 0.1, 0.1, 0);
    const double tolerance = test::chiSquareMeanTolerance(kRuns, 3);
    EXPECT_LT(nees.all, 3 + tolerance);
    EXPECT_GT(nees.all, kLeastShare * 3 - tolerance);
  }
}

TEST(RefinePlane, FindsOutThatMatchesClaimTooLittle) {
  constexpr int kRuns = 400;
  const Nees nees = simulate(plane(6, -6, 4), kRuns, 0.15, 0.05, 0);
  EXPECT_LT(nees.all, 3 + test::chiSquareMeanTolerance(kRuns, 3));
}

TEST(RefinePlane, WidensByAnErrorCommonToAllDisparities) {
  constexpr int kRuns = 400;
  const PlaneVector g = plane(6, -6, 0);
  const Nees nees = simulate(g, kRuns, 0.1, 0.1, 0.1);
  const double tolerance = test::chiSquareMeanTolerance(kRuns, 1);
  // The bias is along the optical axis of g: d = f b g.r with r_z = 1.
  EXPECT_LT(nees.each.z(), 1 + tolerance);
  EXPECT_GT(nees.each.z(), kLeastShare - tolerance);
}

TEST(RefinePlane, WidensPitchByWhatACommonErrorTurnsTheHorizonAndNothingElse) {
  // A common error e of disparity moves the horizon by e / (slope of disparity) rows, here at roll 0:
  // d pitch = e h / (f b), about; height changes by less, roll not at all.
  const double height = 6, e = 0.05;
  const PlaneVector g = plane(height, 0, 0);
  const std::vector<DisparitySample> samples = Sampler(12).ground(g, 200, 0.1);
  const Expected<PlaneFit> without = refinePlane(rig(), {samples}, g, makeLimits());
  const Expected<PlaneFit> with = refinePlane(rig(), {samples, e}, g, makeLimits());
  ASSERT_TRUE(without && with);
  EXPECT_EQ(with->plane.g, without->plane.g);
  const auto added = [&](auto variance) { return variance(with->plane) - variance(without->plane); };
  const double pitch =
      added([](const GroundPlane& plane) { return pitchVariance(plane.normal(), plane.normalCovariance()); });
  const double roll =
      added([](const GroundPlane& plane) { return rollVariance(plane.normal(), plane.normalCovariance()); });
  const double in_height = added([](const GroundPlane& plane) { return plane.heightVariance(); });
  const double expected = e * height / rig().fb();
  EXPECT_NEAR(std::sqrt(pitch) / expected, 1, 0.02);
  EXPECT_NEAR(roll, 0, 1e-4 * pitch);
  EXPECT_LT(std::sqrt(in_height) / height, 0.1 * expected);
}

TEST(RefinePlane, TellsUnevenGroundFromErrorsOfTheMatches) {
  const double height = 2, bumps = 0.02, match_stddev = 0.1;
  const PlaneVector g = plane(height, -10, 0);
  Sampler sampler(14);
  std::vector<DisparitySample> flat = sampler.ground(g, 400, match_stddev), uneven = flat, noisy = flat;
  for (size_t i = 0; i < flat.size(); ++i) {
    // A point higher by e is seen at the disparity of a plane nearer by e: d h / (h - e). Waves of this root
    // mean square, some hundred pixels long.
    const double wave = 2 * bumps * std::sin(flat[i].u / 30) * std::sin(flat[i].v / 25);
    const double expected = g.disparity(rig(), flat[i].u, flat[i].v);
    uneven[i].disparity += expected * (height / (height - wave) - 1);
    // Matches that scatter three times as much as they claim are no bumps.
    noisy[i].disparity += 2 * (flat[i].disparity - expected);
  }
  PlaneLimits limits = makeLimits();
  limits.tolerance = 2;
  const Expected<PlaneFit> of_flat = refinePlane(rig(), {flat}, g, limits);
  const Expected<PlaneFit> of_uneven = refinePlane(rig(), {uneven}, g, limits);
  const Expected<PlaneFit> of_noisy = refinePlane(rig(), {noisy}, g, limits);
  ASSERT_TRUE(of_flat && of_uneven && of_noisy);
  EXPECT_NEAR(surfaceVariance(rig(), flat, *of_flat, kWindow), 0, std::pow(0.25 * bumps, 2));
  EXPECT_NEAR(surfaceVariance(rig(), noisy, *of_noisy, kWindow), 0, std::pow(0.4 * bumps, 2));
  EXPECT_NEAR(std::sqrt(surfaceVariance(rig(), uneven, *of_uneven, kWindow)), bumps, 0.4 * bumps);
}

TEST(RefinePlane, TakesWhatOverlappingWindowsShareForNoBumps) {
  // Matches come in clusters of six, as on strong texture. The error of each is the mean of the noise in its
  // window, so neighbours have most of it in common. 0.25 of some 90 pixels are 6 mm of 2 m.
  const double height = 2, match_stddev = 0.25;
  const PlaneVector g = plane(height, -10, 0);
  double shared = 0, independent = 0;
  constexpr int kScenes = 20;
  for (int scene = 0; scene < kScenes; ++scene) {
    cv::RNG random(100 + scene);
    cv::Mat noise(rig().size, CV_64F);
    random.fill(noise, cv::RNG::NORMAL, 0, match_stddev * kWindow);
    cv::blur(noise, noise, cv::Size(kWindow, kWindow));
    std::vector<DisparitySample> samples;
    while (samples.size() < 480) {
      const int u = random.uniform(20, 620), v = random.uniform(250, 460);
      for (int i = 0; i < 6; ++i) {
        const int x = u + random.uniform(-6, 7), y = v + random.uniform(-6, 7);
        const double disparity = g.disparity(rig(), x, y) + noise.at<double>(y, x);
        samples.push_back({static_cast<double>(x), static_cast<double>(y), match_stddev, {disparity}});
      }
    }
    const Expected<PlaneFit> fit = refinePlane(rig(), {samples}, g, makeLimits());
    ASSERT_TRUE(fit);
    shared += surfaceVariance(rig(), samples, *fit, kWindow) / kScenes;
    independent += surfaceVariance(rig(), samples, *fit, 1) / kScenes;
  }
  const double error = height * match_stddev / (g.disparity(rig(), 320, 400));
  EXPECT_GT(independent, 0.06 * error * error);
  EXPECT_NEAR(shared, 0, 0.03 * error * error);
}

TEST(RefinePlane, TakesTheScatterOfFarMatchesForNoBumps) {
  // From 12 m up the heights of matches near the camera scatter by centimetres, those of far ones, of faint
  // texture besides, by half a metre: their patches must not count like the near ones.
  const PlaneVector g = plane(12, -4, 0);
  double square = 0;
  constexpr int kScenes = 20;
  for (int scene = 0; scene < kScenes; ++scene) {
    Sampler sampler(200 + scene);
    std::vector<DisparitySample> samples = sampler.ground(g, 800, 0);
    for (DisparitySample& sample : samples) {
      sample.stddev = 0.5 * std::pow(10 / sample.disparity, 2);
      sample.disparity += sample.stddev * sampler.normal();
    }
    const Expected<PlaneFit> fit = refinePlane(rig(), {samples}, g, makeLimits());
    ASSERT_TRUE(fit);
    square += std::pow(surfaceVariance(rig(), samples, *fit, 1), 2) / kScenes;
  }
  EXPECT_LT(std::pow(square, 0.25), 0.08);
}

TEST(RefinePlane, SaysWhyThereIsNone) {
  const PlaneVector g = plane(6, -6, 0);
  Sampler sampler(13);
  const Expected<PlaneFit> few = refinePlane(rig(), {sampler.ground(g, 19, 0.1)}, g, makeLimits());
  ASSERT_FALSE(few);
  EXPECT_EQ(few.error().reason, Reason::kNoPlane);
  EXPECT_NE(few.error().detail.find("20"), std::string::npos) << few.error().detail;
  const Expected<PlaneFit> wrong =
      refinePlane(rig(), {sampler.ground(g, 100, 0.1)}, plane(3, -6, 0), makeLimits());
  EXPECT_FALSE(wrong) << "from a start that nothing agrees with";
  const Expected<PlaneFit> steep =
      refinePlane(rig(), {sampler.ground(plane(6, -35, 0), 100, 0.1)}, plane(6, -35, 0), makeLimits());
  ASSERT_FALSE(steep);
  EXPECT_EQ(steep.error().reason, Reason::kNoPlane);
  EXPECT_FALSE(refinePlane(rig(), {{}}, g, makeLimits()));
}

}  // namespace
}  // namespace uav_landing
