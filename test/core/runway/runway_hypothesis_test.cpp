#include "runway/direction/runway_hypothesis.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "support/ground_renderer.h"

namespace uav_landing {
namespace {

using test::kDegree;
using test::Pose;

enum class Brighter { kLeft, kRight };

/// A camera 30 m above the ground, 300 m before a runway of 45 m by 1500 m along x, which it sees at an
/// angle.
struct Scene {
  StereoRig rig = test::makeRig(640, 480, 1.0);
  Pose pose;
  std::vector<LineSegment> lines;
  ApproachAngleParameters parameters;
  RunwayPrior prior;

  Scene() {
    pose.position = {-300, 5, 30};
    pose.yaw = 4 * kDegree;
    pose.pitch = -4 * kDegree;
    pose.roll = 3 * kDegree;
    prior.normal = pose.down();
    prior.normal_covariance = Eigen::Matrix3d::Identity() * std::pow(0.5 * kDegree, 2);
  }
  Eigen::Vector2d pixel(const Eigen::Vector2d& point) const {
    const Eigen::Vector3d seen = pose.seen(Eigen::Vector3d(point.x(), point.y(), 0) - pose.position);
    return {rig.fx * seen.x() / seen.z() + rig.cx, rig.fy * seen.y() / seen.z() + rig.cy};
  }
  /// An edge on the ground.
  void add(const Eigen::Vector2d& from, const Eigen::Vector2d& to, Brighter brighter) {
    const Eigen::Vector2d a = pixel(from), b = pixel(to), along = (b - a).normalized();
    Eigen::Vector2d normal(along.y(), -along.x());
    if ((normal.x() > 0) == (brighter == Brighter::kLeft)) normal = -normal;
    lines.push_back({a, b, {normal.x(), normal.y(), -normal.dot(a)}, 0.05, 0.17 / (b - a).norm()});
  }
  /// A dark strip: its left edge is brighter on the left.
  void addStrip(const Eigen::Vector2d& begin, double width, double length, double heading = 0) {
    const Eigen::Vector2d along(std::cos(heading), std::sin(heading)), left(-along.y(), along.x());
    const Eigen::Vector2d l = begin + 0.5 * width * left, r = begin - 0.5 * width * left;
    add(l, l + length * along, Brighter::kLeft);
    add(r, r + length * along, Brighter::kRight);
  }
  void addRunway() {
    addStrip({0, 0}, 45, 1500);
    for (const double y : {-12, -4, 4, 12}) {  // bars of the threshold
      add({20, y + 1}, {50, y + 1}, Brighter::kRight);
      add({20, y - 1}, {50, y - 1}, Brighter::kLeft);
    }
  }
  /// Roofs and streets in many directions, not on the runway.
  void addTown(int count) {
    std::mt19937 random(3);
    const auto uniform = [&](double from, double to) {
      return from + (to - from) * static_cast<double>(random()) / 4294967296.0;
    };
    for (int i = 0; i < count; ++i) {
      const double heading = uniform(-1.5, 1.5), side = i % 2 == 0 ? 1 : -1;
      const Eigen::Vector2d from(uniform(-150, 900), side * uniform(60, 250));
      const Eigen::Vector2d to =
          from + uniform(10, 60) * Eigen::Vector2d(std::cos(heading), std::sin(heading));
      add(from, to, i % 3 == 0 ? Brighter::kLeft : Brighter::kRight);
    }
  }
  Expected<RunwayChoice> find() const { return findRunwayHypothesis(lines, rig.K(), parameters, prior); }
  /// Of a direction against one on the ground, rad.
  double off(const Eigen::Vector3d& direction, double heading = 0) const {
    return (direction - pose.seen({std::cos(heading), std::sin(heading), 0})).norm();
  }
};

TEST(RunwayHypothesis, IsTheRunwayInTheMidstOfATown) {
  Scene scene;
  scene.addRunway();
  scene.addTown(80);
  const auto found = scene.find();
  ASSERT_TRUE(found) << found.error().message();
  EXPECT_LT(scene.off(found->best.direction), 0.05 * kDegree);
  EXPECT_GT(found->margin, 7) << "another one in 1000 cases";
  // Exact places: 22.5 m to either side of the middle, which is 5 m to the right of the camera.
  EXPECT_NEAR(found->best.left * 30, 17.5, 0.2);
  EXPECT_NEAR(found->best.right * 30, -27.5, 0.2);
  // The runway itself has 10 lines.
  for (size_t i = 0; i < scene.lines.size(); ++i) EXPECT_EQ(found->best.members[i], i < 10 ? 1 : 0) << i;
}

TEST(RunwayHypothesis, ATownAloneIsNoClearRunway) {
  Scene scene;
  scene.addTown(80);
  const auto found = scene.find();
  EXPECT_LT(found ? found->margin : 0, 7);
}

TEST(RunwayHypothesis, TwoEdgesThatAreBrighterOnTheSameSideAreNone) {
  Scene scene;
  scene.add({0, 22}, {1500, 22}, Brighter::kLeft);
  scene.add({0, -22}, {1500, -22}, Brighter::kLeft);
  const auto found = scene.find();
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().reason, Reason::kNoRunway);
}

TEST(RunwayHypothesis, EdgesThatAreNotSideBySideAreNone) {
  Scene scene;
  scene.add({0, 22}, {100, 22}, Brighter::kLeft);
  scene.add({400, -22}, {1500, -22}, Brighter::kRight);
  EXPECT_FALSE(scene.find());
}

TEST(RunwayHypothesis, ReachesAsFarAsBothEdgesAreSeen) {
  Scene scene;
  scene.add({0, 22}, {1200, 22}, Brighter::kLeft);
  scene.add({150, -22}, {1500, -22}, Brighter::kRight);
  const auto found = scene.find();
  ASSERT_TRUE(found) << found.error().message();
  EXPECT_NEAR(found->best.near * 30, 300 + 150, 1);
  EXPECT_NEAR(found->best.far * 30, 300 + 1200, 5);
}

TEST(RunwayHypothesis, MarksThatLieCloseToAnEndBelongToIt) {
  // An end is known to 3 % of its distance.
  const auto belongs = [](double from, double to) {
    Scene scene;
    scene.addStrip({0, 0}, 45, 300);
    scene.add({from, 0}, {to, 0}, Brighter::kLeft);
    return scene.find()->best.members[2] != 0;
  };
  EXPECT_TRUE(belongs(-300 + 600 * 1.02, 700));
  EXPECT_FALSE(belongs(-300 + 600 * 1.04, 700));
  EXPECT_TRUE(belongs(-150, -300 + 300 * 0.98));
  EXPECT_FALSE(belongs(-150, -300 + 300 * 0.96));
}

TEST(RunwayHypothesis, AStripThatIsHardlyLongerThanWideHasLessEvidence) {
  Scene runway, field;
  runway.addStrip({0, 0}, 45, 1500);
  field.addStrip({0, 0}, 200, 300);
  const auto long_one = runway.find(), short_one = field.find();
  ASSERT_TRUE(long_one && short_one);
  EXPECT_GT(long_one->best.evidence, short_one->best.evidence + 3);
}

TEST(RunwayHypothesis, LinesAstrayOnTheSurfaceAreEvidenceAgainstIt) {
  Scene clean, cluttered;
  clean.addStrip({0, 0}, 45, 1500);
  cluttered.addStrip({0, 0}, 45, 1500);
  for (const double x : {20, 60, 120}) cluttered.add({x, -10}, {x + 60, 0}, Brighter::kLeft);
  const auto a = clean.find(), b = cluttered.find();
  ASSERT_TRUE(a && b);
  EXPECT_NEAR(a->best.evidence - b->best.evidence, 3 * 1.2, 1e-6);
}

TEST(RunwayHypothesis, ARowOfStreetsIsLessOfARunwayHoweverManyLinesItHas) {
  Scene scene;
  scene.addRunway();
  for (int i = 0; i < 12; ++i) scene.addStrip({-250, 70 + 30.0 * i}, 10, 1200, 8 * kDegree);
  const auto found = scene.find();
  ASSERT_TRUE(found);
  EXPECT_LT(scene.off(found->best.direction), 0.05 * kDegree);
  EXPECT_GT(found->margin, 4) << "clearly";
}

TEST(RunwayHypothesis, ATaxiwayBesideTheRunwayCostsNothing) {
  Scene alone, airport;
  alone.addStrip({0, 0}, 45, 1500);
  airport.addStrip({0, 0}, 45, 1500);
  airport.addStrip({0, 150}, 20, 1500);
  const auto a = alone.find(), b = airport.find();
  ASSERT_TRUE(a && b);
  EXPECT_GE(b->best.evidence, a->best.evidence - 1e-6);
}

TEST(RunwayHypothesis, LongLinesBetweenMiddleAndSideAreThoseOfAField) {
  Scene runway, field;
  for (Scene* scene : {&runway, &field}) scene->addStrip({0, 0}, 45, 1500);
  runway.addStrip({0, 0}, 1, 1500);   // a centre line
  runway.addStrip({0, 20}, 1, 1500);  // a side stripe
  field.addStrip({0, 11}, 1, 1500);
  field.addStrip({0, -11}, 1, 1500);
  const auto a = runway.find(), b = field.find();
  ASSERT_TRUE(a && b);
  EXPECT_GT(a->best.evidence, b->best.evidence + 4);
}

TEST(RunwayHypothesis, TwoRunwaysAreNotDecidedUnlessThePathOrThePairBeforeSays) {
  const double heading = -10 * kDegree;
  Scene scene;
  scene.addStrip({0, 0}, 45, 1500);
  scene.addStrip({0, -90}, 45, 1500, heading);
  const auto undecided = scene.find();
  ASSERT_TRUE(undecided);
  EXPECT_LT(undecided->margin, 3);
  for (const double there : {0.0, heading}) {
    const Eigen::Vector3d direction = scene.pose.seen({std::cos(there), std::sin(there), -0.05});
    Scene flown = scene, followed = scene;
    flown.prior.path = direction.normalized();
    followed.prior.last = direction.normalized();
    for (const Scene& known : {flown, followed}) {
      const auto found = known.find();
      ASSERT_TRUE(found);
      EXPECT_LT(known.off(found->best.direction, there), 0.05 * kDegree);
      EXPECT_GT(found->lead, 3);
    }
  }
}

TEST(RunwayHypothesis, ThePairBeforeCountsAsFarAsItsDirectionWasTheRunways) {
  const double heading = -10 * kDegree;
  const auto lead = [&](double doubt) {
    Scene scene;
    scene.addStrip({0, 0}, 45, 1500);
    scene.prior.last = scene.pose.seen({std::cos(heading), std::sin(heading), 0}).normalized();
    scene.prior.last_doubt = doubt;
    const auto found = scene.find();
    return found ? found->best.lead - found->best.evidence : 0;
  };
  EXPECT_NEAR(lead(1e-6), -6, 1e-9);
  EXPECT_NEAR(lead(0.05), std::log(0.05), 1e-9);
  EXPECT_NEAR(lead(1), 0, 1e-9);
}

TEST(RunwayHypothesis, AStripThatThePathPassesByCostsEvidence) {
  // The camera is 5 m left of the middle of a strip that is 300 m ahead, and flies along it.
  const auto evidence = [](double y, double path) {
    Scene scene;
    scene.addStrip({0, y}, 45, 1500);
    const double without = scene.find()->best.evidence;
    scene.prior.path = scene.pose.seen({std::cos(path), std::sin(path), -0.05}).normalized();
    return scene.find()->best.evidence - without;
  };
  EXPECT_NEAR(evidence(0, 0), 0, 1e-3);
  EXPECT_NEAR(evidence(20, 0), 0, 1e-3) << "above it";
  // Its edge is 7.5 m and 32.5 m to the left.
  const double sigma = 3 * kDegree;
  EXPECT_NEAR(evidence(35, 0), -0.5 * std::pow(std::atan(7.5 / 300) / sigma, 2), 0.01);
  EXPECT_NEAR(evidence(60, 0), -0.5 * std::pow(std::atan(32.5 / 300) / sigma, 2), 0.05);
  EXPECT_NEAR(evidence(-50, 0), -0.5 * std::pow(std::atan(32.5 / 300) / sigma, 2), 0.05);
  EXPECT_NEAR(evidence(120, 0), -10, 1e-6) << "at most";
  // Flown to from the side: the path leads to its near end, 5 degrees off its direction.
  EXPECT_NEAR(evidence(31, 5 * kDegree), -0.5 * std::pow(5 * kDegree / sigma, 2), 0.05);
}

TEST(RunwayHypothesis, AStripWithoutMarksMayBeARoadThatThePathLeadsAlong) {
  const auto margin = [](bool marked, double path_deg) {
    Scene scene;
    // Edges in pieces, so that their evidence is large.
    for (const double x : {0, 300, 600}) scene.addStrip({x, 0}, 45, 300);
    if (marked) {
      for (const double y : {-20, 0, 20}) scene.addStrip({0, y}, 1, 1500);
    }
    const double path = path_deg * kDegree;
    scene.prior.path = scene.pose.seen({std::cos(path), std::sin(path), -0.05}).normalized();
    return scene.find()->margin;
  };
  const double known = -std::log(kLargestDoubt);
  EXPECT_GT(margin(false, 0), known);
  EXPECT_LT(margin(false, 0), known + 1);
  EXPECT_LT(margin(false, 4), known) << "half a road in a thousand approaches";
  EXPECT_GT(margin(true, 4), known + 3);
}

TEST(RunwayHypothesis, TheMarksOfARoadDoNotOutweighAPathThatLeadsElsewhere) {
  enum class Marks { kLanes, kBars };
  const auto margin = [](Marks marks, double path_deg) {
    Scene scene;
    for (const double x : {0, 300, 600}) scene.addStrip({x, 0}, 18, 300);
    for (const double y : {-8.5, 0.0, 8.5}) scene.addStrip({0, y}, 0.6, 900);
    if (marks == Marks::kLanes) {
      for (const double x : {20, 120, 220})
        for (const double y : {-4.5, 4.5}) scene.add({x, y}, {x + 6, y}, Brighter::kLeft);
    } else {
      for (const double y : {-4.5, -2.5, 2.5, 4.5}) scene.addStrip({20, y}, 1, 30);
    }
    const double path = path_deg * kDegree;
    scene.prior.path = scene.pose.seen({std::cos(path), std::sin(path), -0.05}).normalized();
    return scene.find()->margin;
  };
  const double known = -std::log(kLargestDoubt);
  EXPECT_GT(margin(Marks::kLanes, 6), known);
  EXPECT_LT(margin(Marks::kLanes, 20), known - 4);
  EXPECT_GT(margin(Marks::kBars, 20), known);
}

TEST(RunwayHypothesis, AStripThatBeginsBelowTheAircraftCostsEvidence) {
  const auto evidence = [](double height, double begin, double descent) {
    Scene scene;
    scene.pose.position = {-begin, 0, height};
    scene.addStrip({0, 0}, 45, 3000);
    scene.prior.height = height;
    const double without = scene.find()->best.evidence;
    scene.prior.path = scene.pose.seen({1, 0, -descent}).normalized();
    return scene.find()->best.evidence - without;
  };
  EXPECT_NEAR(evidence(100, 1500, 0.05), 0, 1e-3) << "on an approach";
  EXPECT_NEAR(evidence(30, 150, 0.05), 0, 1e-2) << "crossed at 14 m by a glide of 6 degrees";
  EXPECT_NEAR(evidence(200, 3000, 0), 0, 1e-3) << "in level flight before the glide";
  // At 6 degrees it passes 78.98 m above the near end, 63.98 m more than on an approach.
  EXPECT_NEAR(evidence(100, 200, 0.05), -0.5 * std::pow(63.98 / 20, 2), 0.1);
  // A glide of 1 in 5 passes 60 m above it.
  EXPECT_NEAR(evidence(100, 200, 0.2), -0.5 * std::pow(45.0 / 20, 2), 0.1);
}

TEST(RunwayHypothesis, OneOfManyStripsSideBySideIsWorthWhatItsShapeIs) {
  // However many marks it has.
  const auto evidence = [](int strips) {
    Scene scene;
    for (int i = 0; i < strips; ++i) {
      scene.addStrip({-100, 60.0 * i}, 40, 1200);
      for (const double y : {-19, 0, 19}) scene.addStrip({-100, 60.0 * i + y}, 1, 1200);
    }
    scene.prior.height = 30;  // or all of them would be one
    return scene.find()->best.evidence;
  };
  EXPECT_GT(evidence(1), 20);
  EXPECT_LT(evidence(15), 4);
}

TEST(RunwayHypothesis, EnoughEvidenceOutweighsThePath) {
  Scene scene;
  scene.addRunway();
  scene.prior.path = scene.pose.seen({std::cos(0.4), std::sin(0.4), -0.05}).normalized();
  const auto found = scene.find();
  ASSERT_TRUE(found);
  EXPECT_LT(scene.off(found->best.direction), 0.05 * kDegree);
}

TEST(RunwayHypothesis, OffTheHorizonCostsEvidenceUpToALimit) {
  Scene level, wrong;
  level.addRunway();
  wrong.addRunway();
  // Ground that is known to 0.5 degrees and is wrong by 1: (1 / 0.5)^2 / 2.
  wrong.prior.normal = Eigen::AngleAxisd(1 * kDegree, Eigen::Vector3d::UnitX()) * wrong.pose.down();
  auto a = level.find(), b = wrong.find();
  ASSERT_TRUE(a && b);
  EXPECT_NEAR(a->best.evidence - b->best.evidence, 2, 0.1);
  wrong.prior.normal = Eigen::AngleAxisd(4 * kDegree, Eigen::Vector3d::UnitX()) * wrong.pose.down();
  b = wrong.find();
  ASSERT_TRUE(b);
  EXPECT_LT(wrong.off(b->best.direction), 0.05 * kDegree) << "the lines say where they vanish";
  EXPECT_NEAR(a->best.evidence - b->best.evidence, 10, 0.3);
}

TEST(RunwayHypothesis, ADirectionFarOffTheGroundIsNone) {
  Scene scene;
  scene.addRunway();
  scene.prior.normal = Eigen::AngleAxisd(8 * kDegree, Eigen::Vector3d::UnitX()) * scene.pose.down();
  EXPECT_FALSE(scene.find());
}

TEST(RunwayHypothesis, AnotherSizeThanTheChartsCostsEvidenceUpToALimit) {
  const auto evidence = [](double height, const RunwayParameters& runway) {
    Scene scene;
    scene.addStrip({0, 0}, 45, 1500);
    scene.prior.height = height;
    scene.prior.runway = runway;
    const auto found = scene.find();
    return found ? found->best.evidence : 0;
  };
  RunwayParameters charted, painted, narrow, wide, short_one;
  charted.width = 45;
  painted.width = 48;
  painted.side_stripe_inset = 1.5;
  narrow.width = 43;
  wide.width = 75;
  short_one.length = 300;
  const double unknown = evidence(30, {});
  // One in four of other objects is as wide by chance.
  const double same = unknown + std::log(4.0);
  EXPECT_NEAR(evidence(30, charted), same, 0.01);
  EXPECT_NEAR(evidence(30, painted), same, 0.01) << "between its side stripes";
  // 1 sigma is 6 % of the width.
  EXPECT_NEAR(same - evidence(30, narrow), 0.5 * std::pow(std::log(45.0 / 43) / 0.06, 2), 0.05);
  EXPECT_NEAR(unknown - evidence(30, wide), 10, 1e-6);
  EXPECT_NEAR(unknown - evidence(30, short_one), 10, 1e-6);
  RunwayParameters long_one;
  long_one.length = 1500;
  EXPECT_NEAR(evidence(30, long_one), unknown, 1e-6);
}

TEST(RunwayHypothesis, WidthsThatNoRunwayHasAreNoneWhereTheHeightIsKnown) {
  for (const double width : {0.2, 150.0}) {
    Scene scene;
    scene.addStrip({0, 0}, width, 1500);
    scene.prior.height = 30;
    EXPECT_FALSE(scene.find()) << width;
  }
  for (const double width : {18.0, 60.0}) {
    Scene scene;
    scene.addStrip({0, 0}, width, 1500);
    scene.prior.height = 30;
    EXPECT_TRUE(scene.find()) << width;
  }
}

}  // namespace
}  // namespace uav_landing
