#include "runway/edges/runway_edges.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace uav_landing {
namespace {

/// A level camera that knows its attitude to 1 sigma of so much, rad, and the runway's direction.
GroundAxes level(double stddev, double direction_stddev) {
  const Eigen::Matrix3d unit = Eigen::Matrix3d::Identity();
  return GroundAxes(Eigen::Vector3d::UnitY(), unit * stddev * stddev, Eigen::Vector3d::UnitZ(),
                    unit * direction_stddev * direction_stddev);
}

GroundAxes level(double stddev) { return level(stddev, stddev); }

GroundEdge edge(double lateral, bool brighter_left, double extent = 1.5) {
  GroundEdge made;
  made.lateral = lateral;
  made.variance = 1e-6;
  made.by_rotation = GroundAxes::meetByRotation({4, lateral}).row(1).transpose();
  made.brighter_left = brighter_left;
  made.near = 2;
  made.far = 2 * std::exp(extent);
  made.extent = extent;
  EdgePiece piece;
  piece.forward = 4;
  piece.lateral = lateral;
  piece.covariance = Eigen::Vector2d(1e-6, 1e-8).asDiagonal();
  made.pieces = {piece};
  return made;
}

/// Both edges of a bright stripe along the runway.
void addStripe(std::vector<GroundEdge>& edges, double middle, double width, double extent = 1.5) {
  edges.push_back(edge(middle + width / 2, false, extent));
  edges.push_back(edge(middle - width / 2, true, extent));
}

std::vector<GroundEdge> runway(double centre) {
  std::vector<GroundEdge> edges;
  for (const int side : {-1, 1}) addStripe(edges, centre + side * 1.1, 0.05);
  addStripe(edges, centre, 0.04, 0.6);
  return edges;
}

TEST(RunwayEdges, TheCentreIsThatOfTheSymmetry) {
  for (const double centre : {0.0, -0.8, 1.7}) {
    const auto found = findRunwayEdges(level(1e-4), runway(centre), 0, std::nullopt);
    ASSERT_TRUE(found) << found.error().message();
    EXPECT_NEAR(found->centre, centre, 1e-9);
    EXPECT_NEAR(found->width, 2.25, 1e-9);
    EXPECT_LT(found->variance, 1e-4);
  }
}

TEST(RunwayEdges, EdgesOfOtherThingsDoNotMoveIt) {
  std::vector<GroundEdge> edges = runway(0.3);
  edges.push_back(edge(4.1, true, 1.2));
  edges.push_back(edge(-2.9, true, 0.9));
  edges.push_back(edge(0.77, false, 0.4));
  const auto found = findRunwayEdges(level(1e-4), edges, 0, std::nullopt);
  ASSERT_TRUE(found) << found.error().message();
  EXPECT_NEAR(found->centre, 0.3, 1e-6);
}

// The shores of an island, 157 m apart, with a runway of 45 m between them, from 40 m up.
TEST(RunwayEdges, ShoresBesideTheRunwayAreTooFarApart) {
  std::vector<GroundEdge> edges;
  for (const int side : {-1, 1}) addStripe(edges, side * 45.0 / 80, 0.02);
  addStripe(edges, 0, 0.02, 0.6);
  edges.push_back(edge(157.0 / 80, true, 2));
  edges.push_back(edge(-157.0 / 80, false, 2));
  const auto shores = findRunwayEdges(level(1e-4), edges, 0, std::nullopt);
  ASSERT_TRUE(shores) << shores.error().message();
  EXPECT_NEAR(shores->width, 157.0 / 40, 0.01);
  const auto found = findRunwayEdges(level(1e-4), edges, {0, 90.0 / 40}, std::nullopt);
  ASSERT_TRUE(found) << found.error().message();
  EXPECT_NEAR(found->width, 45.0 / 40 + 0.02, 0.01);
}

TEST(RunwayEdges, OneStripeAloneIsNoRunway) {
  std::vector<GroundEdge> edges;
  addStripe(edges, 0.4, 0.05);
  EXPECT_EQ(findRunwayEdges(level(1e-4), edges, 0, std::nullopt).error().reason, Reason::kNoRunway);
}

TEST(RunwayEdges, OnePairOfTheKnownWidthIsTheRunway) {
  const std::vector<GroundEdge> edges{edge(1.5, false), edge(-0.5, true)};
  const auto found = findRunwayEdges(level(1e-4), edges, 2.0, std::nullopt);
  ASSERT_TRUE(found) << found.error().message();
  EXPECT_NEAR(found->centre, 0.5, 1e-9);
  EXPECT_FALSE(findRunwayEdges(level(1e-4), edges, 3.0, std::nullopt)) << "of another width";
}

TEST(RunwayEdges, AnEdgeLineAndTheCentreLineAreNoRunway) {
  std::vector<GroundEdge> edges;
  addStripe(edges, 1.1, 0.05, 2.0);
  addStripe(edges, 0, 0.05, 0.8);
  EXPECT_EQ(findRunwayEdges(level(1e-4), edges, 0, std::nullopt).error().reason, Reason::kNoRunway);
}

/// A runway from 1 to -3 whose centre line at -1 looks as long as its edge line at 1. Of the far edge line
/// only one side is seen, so that it has no counterpart.
std::vector<GroundEdge> halfOfARunway(double far = -2.85) {
  std::vector<GroundEdge> edges;
  addStripe(edges, 1, 0.05, 2.0);
  addStripe(edges, -1, 0.05, 1.8);
  edges.push_back(edge(far, false, 1.2));
  return edges;
}

TEST(RunwayEdges, NorAreTheyWhenTheOtherEdgeIsSeenAsFarBeyond) {
  EXPECT_EQ(findRunwayEdges(level(1e-4), halfOfARunway(), 0, std::nullopt).error().reason, Reason::kNoRunway);
  std::vector<GroundEdge> mirrored;
  for (const GroundEdge& e : halfOfARunway())
    mirrored.push_back(edge(-e.lateral, !e.brighter_left, e.extent));
  EXPECT_EQ(findRunwayEdges(level(1e-4), mirrored, 0, std::nullopt).error().reason, Reason::kNoRunway);
  // Where it was believed before, too.
  EXPECT_FALSE(findRunwayEdges(level(1e-4), halfOfARunway(), 0, ExpectedCentre{0, 0.1}));
}

TEST(RunwayEdges, AnEdgeOfAWiderRunwayThatOneViewSeesIsEvidenceAgainstAPair) {
  const StereoRig rig;
  const std::vector<GroundEdge> edges = runway(0);  // 2.2 wide
  const auto found = [&](const std::vector<GroundEdge>& seen, double width = 0) {
    const Outlook outlook{rig, seen};
    return findRunwayEdges(level(1e-4), edges, width, std::nullopt, &outlook);
  };
  std::vector<GroundEdge> seen = edges;
  EXPECT_TRUE(found(seen));
  seen.push_back(edge(3.3, true, 1.5));
  EXPECT_EQ(found(seen).error().detail, "the runway reaches as far again beyond its seeming edges");
  EXPECT_TRUE(found(seen, 2.25)) << "a known width";
  seen.push_back(edge(-3.3, false, 1.5));
  EXPECT_TRUE(found(seen)) << "the middle of something symmetric";
}

/// Three bars of a threshold to the left of its middle, which are symmetric about their own.
std::vector<GroundEdge> bars() {
  std::vector<GroundEdge> edges;
  for (const double middle : {0.1, 0.4, 0.7}) addStripe(edges, middle, middle == 0.4 ? 0.08 : 0.1, 0.6);
  return edges;
}

TEST(RunwayEdges, BarsAreNoRunwayWhereFarLongerEdgesLieBeyondThem) {
  const StereoRig rig;
  const auto found = [&](double lateral, double extent, double width = 0) {
    std::vector<GroundEdge> seen = bars();
    seen.push_back(edge(lateral, true, extent));
    const Outlook outlook{rig, seen};
    return findRunwayEdges(level(1e-4), bars(), width, std::nullopt, &outlook);
  };
  ASSERT_TRUE(found(2, 0.6)) << found(2, 0.6).error().message();
  EXPECT_EQ(found(2, 1.6).error().detail, "far longer edges lie beyond those that look like the runway's");
  EXPECT_FALSE(found(-1.1, 1.6)) << "on the other side";
  EXPECT_TRUE(found(2, 1.6, 0.7)) << "a known width";
}

TEST(RunwayEdges, BarsAreNoRunwayWhereALongerLineGoesOnBehindThem) {
  const StereoRig rig;
  std::vector<GroundEdge> seen = bars();
  GroundEdge line = edge(0.4, true, 0.7);
  const auto found = [&](double far) {
    seen = bars();
    line.far = far * bars()[0].far;
    seen.push_back(line);
    const Outlook outlook{rig, seen};
    return findRunwayEdges(level(1e-4), bars(), 0, std::nullopt, &outlook);
  };
  EXPECT_TRUE(found(1.9));
  EXPECT_EQ(found(2.1).error().detail, "a longer line goes on behind what looks like the runway's edges");
  line.extent = 0.5;
  EXPECT_TRUE(found(2.1)) << "one that is shorter itself";
}

TEST(RunwayEdges, TwoLinesOfTheKnownWidthAreTheRunwayWhateverIsBeyond) {
  const auto found = findRunwayEdges(level(1e-4), halfOfARunway(), 2.05, std::nullopt);
  ASSERT_TRUE(found) << found.error().message();
  EXPECT_NEAR(found->centre, 0, 1e-6);
}

TEST(RunwayEdges, OtherLinesBeyondDoNotHideTheRunway) {
  for (const double beyond : {-1.5, -2.4, -4.5}) {
    const auto found = findRunwayEdges(level(1e-4), halfOfARunway(beyond), 0, std::nullopt);
    ASSERT_TRUE(found) << beyond << ": " << found.error().message();
    EXPECT_NEAR(found->centre, 0, 1e-6);
  }
  std::vector<GroundEdge> edges = halfOfARunway();
  edges.push_back(edge(2.85, false, 1.2));  // as far beyond the other side, and both of one polarity
  const auto found = findRunwayEdges(level(1e-4), edges, 0, std::nullopt);
  ASSERT_TRUE(found) << found.error().message();
  EXPECT_NEAR(found->centre, 0, 1e-6);
}

/// An edge line and the centre line of a wider runway, which looks as long as that does but is dashed.
std::vector<GroundEdge> twoLines(double half = 1) {
  std::vector<GroundEdge> edges;
  addStripe(edges, half, 0.05, 2.0);
  addStripe(edges, -half, 0.05, 1.5);
  for (GroundEdge& e : edges)
    if (e.lateral < 0) e.far *= 2;
  return edges;
}

TEST(RunwayEdges, TwoLinesAlikeAreARunwayUnlessOneOfThemIsDashed) {
  const auto found = [](double dashed) {
    std::vector<GroundEdge> edges;
    for (const int side : {-1, 1}) addStripe(edges, side, 0.05);
    for (GroundEdge& e : edges)
      if (e.lateral * dashed > 0) e.far *= 2;  // as long in all, over a longer way
    return static_cast<bool>(findRunwayEdges(level(1e-4), edges, 0, std::nullopt));
  };
  EXPECT_TRUE(found(0));
  EXPECT_FALSE(found(1)) << "the left one";
  EXPECT_FALSE(found(-1)) << "the right one";
}

TEST(RunwayEdges, TextureOrOneMarkBetweenTwoLinesDoesNotMakeThemARunway) {
  std::vector<GroundEdge> edges = twoLines();
  EXPECT_FALSE(findRunwayEdges(level(1e-4), edges, 0, std::nullopt));
  addStripe(edges, 0, 5, 0.02);
  EXPECT_FALSE(findRunwayEdges(level(1e-4), edges, 0, std::nullopt)) << "short pieces of grass";
  addStripe(edges, 0, 0.5, 0.25);
  EXPECT_FALSE(findRunwayEdges(level(1e-4), edges, 0, std::nullopt)) << "an aiming point";
}

TEST(RunwayEdges, ACentreLineOrBarsBetweenTwoLinesDo) {
  std::vector<GroundEdge> dashes = twoLines();
  addStripe(dashes, 0, 0.04, 0.15);
  const auto middle = findRunwayEdges(level(1e-4), dashes, 0, std::nullopt);
  ASSERT_TRUE(middle) << middle.error().message();
  EXPECT_NEAR(middle->centre, 0, 1e-6);
  std::vector<GroundEdge> bars = twoLines();
  for (const double side : {-0.6, -0.3, 0.3, 0.6}) addStripe(bars, side, 0.12, 0.15);
  const auto threshold = findRunwayEdges(level(1e-4), bars, 0, std::nullopt);
  ASSERT_TRUE(threshold) << threshold.error().message();
  EXPECT_NEAR(threshold->centre, 0, 1e-6);
}

TEST(RunwayEdges, EdgesOfThePavementBeyondTwoLinesMakeThemARunway) {
  std::vector<GroundEdge> edges = twoLines();
  edges.push_back(edge(1.2, true, 0.9));
  edges.push_back(edge(-1.2, false, 0.9));
  EXPECT_TRUE(findRunwayEdges(level(1e-4), edges, 0, std::nullopt));
}

TEST(RunwayEdges, TwoLinesWithRoomBeyondAreARunwayAndWithoutNot) {
  // 90 degrees from side to side: what lies 1.2 to the side is in the picture from 1.2 ahead on.
  StereoRig rig;
  rig.size = {640, 480};
  rig.fx = rig.fy = 320;
  rig.cx = 320;
  rig.cy = 0;
  const std::vector<GroundEdge> edges = twoLines(0.4);
  const auto found = [&](const std::vector<GroundEdge>& all) {
    const Outlook outlook{rig, all};
    return static_cast<bool>(findRunwayEdges(level(1e-4), edges, 0, std::nullopt, &outlook));
  };
  EXPECT_TRUE(found(edges)) << "the edge line 1.2 to the side of a wider runway would be seen";
  std::vector<GroundEdge> more = edges;
  more.push_back(edge(-1.15, true, 0.2));
  EXPECT_FALSE(found(more)) << "something is there";
  rig.fx = rig.fy = 2000;
  EXPECT_FALSE(found(edges)) << "one does not see as far to the side";
}

TEST(RunwayEdges, ADarkStripThatBeginsInThePictureIsOne) {
  std::vector<GroundEdge> edges{edge(1.5, true), edge(-0.5, false)};
  EXPECT_FALSE(findRunwayEdges(level(1e-4), edges, 0, std::nullopt)) << "it may begin anywhere";
  for (GroundEdge& e : edges) e.begins = true;
  const auto found = findRunwayEdges(level(1e-4), edges, 0, std::nullopt);
  ASSERT_TRUE(found) << found.error().message();
  EXPECT_NEAR(found->centre, 0.5, 1e-9);
}

TEST(RunwayEdges, LinesThatTurnAwayTogetherTurnTheRunway) {
  // The direction is 0.01 rad off: what lies 4 heights ahead is 0.04 farther left, and all lines lean so.
  std::vector<GroundEdge> edges = runway(0.3);
  for (GroundEdge& e : edges) {
    e.pieces[0].lateral += 0.04;
    e.pieces[0].slope = 0.01;
    e.lateral += 0.04;
  }
  const auto found = findRunwayEdges(level(1e-4, 0.1), edges, 0, std::nullopt);
  ASSERT_TRUE(found) << found.error().message();
  EXPECT_NEAR(found->centre, 0.3, 1e-6);
  EXPECT_NEAR(found->turn, 0.01, 1e-6);
  // Where the centre line passes the camera follows from its direction: the two err together.
  EXPECT_LT(found->own(0, 1), 0);
}

TEST(RunwayEdges, TheVanishingPointTellsTheDirectionToo) {
  // Lines that tell the direction as well as it does, and a lean of 1 mrad: half of it is believed.
  std::vector<GroundEdge> edges;
  for (const double side : {1.0, -1.0}) {
    edges.push_back(edge(side, side < 0));
    EdgePiece& piece = edges.back().pieces[0];
    piece.slope = 1e-3;
    piece.covariance = Eigen::Vector2d(1e-6, 2 * 1e-6).asDiagonal();
  }
  const auto found = findRunwayEdges(level(1e-4, 1e-3), edges, 2, std::nullopt);
  ASSERT_TRUE(found) << found.error().message();
  EXPECT_NEAR(found->turn, 0.5e-3, 1e-5);
}

TEST(RunwayEdges, BlurOfLinesSeenFromAfarDoesNotTurnTheRunway) {
  // Blur moves the inner sides of two thin lines apart, by half a pixel; the left one is seen better.
  constexpr double kPixel = 1.0 / 550, kCentre = 0.3, kForward = 24;
  std::vector<GroundEdge> edges;
  for (const double side : {1.0, -1.0}) {
    GroundEdge inner = edge(kCentre + side, side > 0);
    EdgePiece& piece = inner.pieces[0];
    piece.slope = side * 0.5 * kPixel;
    piece.forward = kForward;
    piece.lateral = inner.lateral + piece.slope * kForward;
    const double slope_stddev = side > 0 ? 1.5e-4 : 4e-4;
    piece.covariance = Eigen::Vector2d(4e-6, slope_stddev * slope_stddev).asDiagonal();
    inner.lateral = piece.lateral;
    inner.pixel = kPixel;
    edges.push_back(inner);
  }
  const auto found =
      findRunwayEdges(level(1e-4, 3e-4), edges, edges[0].lateral - edges[1].lateral, std::nullopt);
  ASSERT_TRUE(found) << found.error().message();
  EXPECT_NEAR(found->turn, 0, 1e-4);
  EXPECT_NEAR(found->centre, kCentre, 0.004);
}

TEST(RunwayEdges, ACentreThatIsHardlyKnownGathersNothing) {
  // Bars of a threshold about -1.47, one edge of the runway, and texture far to both sides whose middle may
  // be anywhere. As seen from 4 m.
  struct Seen {
    double lateral, extent, near, far, stddev;
    bool brighter_left;
  };
  std::vector<GroundEdge> edges;
  for (const Seen& seen : {Seen{2.1084, 2.46772, 9.85, 116.19, 0.01, false},
                           {1.91799, 2.3483, 8.81, 92.21, 0.01, true},
                           {-1.92791, 1.02701, 9.12, 25.47, 0.01, false},
                           {1.20607, 0.962085, 3.29, 25.48, 0.01, false},
                           {-1.01108, 0.735296, 9.66, 20.34, 0.01, true},
                           {-3.71548, 0.637902, 10.31, 19.50, 0.02, false},
                           {0.771243, 0.608691, 5.86, 22.04, 0.01, true},
                           {-4.14134, 0.572267, 12.43, 22.04, 0.02, true},
                           {-3.25217, 0.504929, 12.25, 20.30, 0.01, true},
                           {-2.81504, 0.497599, 11.87, 19.52, 0.01, false},
                           {14.5196, 0.239656, 30.21, 38.39, 0.57, true},
                           {-14.159, 0.0736607, 59.35, 63.88, 0.57, false}}) {
    GroundEdge made = edge(seen.lateral, seen.brighter_left, seen.extent);
    made.near = seen.near;
    made.far = seen.far;
    made.variance = seen.stddev * seen.stddev;
    edges.push_back(made);
  }
  const auto found = findRunwayEdges(level(1e-3), edges, 0, std::nullopt);
  EXPECT_TRUE(!found || std::abs(found->centre + 1.47) < 0.05) << found->centre;
}

TEST(RunwayEdges, TwoRunwaysSideBySideAreNotDecided) {
  std::vector<GroundEdge> edges = runway(-2);
  for (const GroundEdge& other : runway(2)) edges.push_back(other);
  // The symmetry of both together is that of neither.
  const auto found = findRunwayEdges(level(1e-4), edges, 2.25, std::nullopt);
  EXPECT_EQ(found ? Reason::kNone : found.error().reason, Reason::kNoRunway);
}

TEST(RunwayEdges, TheExpectedOneOfTwoRunwaysIsTaken) {
  std::vector<GroundEdge> edges = runway(-2);
  for (const GroundEdge& other : runway(2)) edges.push_back(other);
  const auto found = findRunwayEdges(level(1e-4), edges, 0, ExpectedCentre{1.98, 0.1});
  ASSERT_TRUE(found) << found.error().message();
  EXPECT_NEAR(found->centre, 2, 1e-6);
}

TEST(RunwayEdges, AnUncertainRollMakesWideEdgesUncertain) {
  const auto sure = findRunwayEdges(level(1e-5), runway(0), 0, std::nullopt);
  const auto unsure = findRunwayEdges(level(1e-2), runway(0), 0, std::nullopt);
  ASSERT_TRUE(sure && unsure);
  // A roll by 0.01 rad moves what is below by 0.01 of the height, and what is to the side by more. The yaw
  // does not matter: the edges themselves tell it.
  EXPECT_GE(std::sqrt(unsure->variance), 0.01);
  EXPECT_LE(std::sqrt(unsure->variance), 0.01 * (1 + 1.15 * 1.15) + 0.002);
  EXPECT_LT(std::sqrt(sure->variance), 0.005);
}

/// Whether the edges are known not to be those of half a runway, or of something else.
bool isWhole(const std::vector<GroundEdge>& edges, double known_width) {
  const auto found = findRunwayEdges(level(1e-4), edges, known_width, std::nullopt);
  if (!found) throw std::runtime_error(found.error().message());
  return std::isfinite(found->centre_without[CentreSource::kWholeRunway].value);
}

TEST(RunwayEdges, APairOfTheChartsWidthIsDoubtedWhileOtherEdgesAreAsSymmetric) {
  std::vector<GroundEdge> edges{edge(1.5, false), edge(-0.5, true)};
  EXPECT_TRUE(isWhole(edges, 2.0));
  // A strip beside it, of another width.
  edges.push_back(edge(3.2, false));
  edges.push_back(edge(-1.6, true));
  EXPECT_FALSE(isWhole(edges, 2.0));
  // A stripe in the middle of the pair tells which one is the runway.
  addStripe(edges, 0.5, 0.04);
  EXPECT_TRUE(isWhole(edges, 2.0));
}

}  // namespace
}  // namespace uav_landing
