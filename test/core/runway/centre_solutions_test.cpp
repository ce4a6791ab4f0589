#include "runway/edges/centre_solutions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <deque>

namespace uav_landing {
namespace {

constexpr double kForward = 4;  // heights, of the middles of all edges

/// Edges on the ground in pairs, as a level camera sees them 4 heights ahead.
struct Ground {
  GroundAxes axes{Eigen::Vector3d::UnitY(), Eigen::Matrix3d::Identity() * 1e-10, Eigen::Vector3d::UnitZ(),
                  Eigen::Matrix3d::Identity() * 1e-10};
  std::deque<GroundEdge> edges;
  std::vector<MirroredEdges> pairs;
  double turn = 0;  ///< of all edges against the axes, rad to the left

  const GroundEdge* edge(double lateral, bool brighter_left) {
    GroundEdge made;
    made.lateral = lateral;
    made.variance = 1e-8;
    made.by_rotation.setZero();
    made.brighter_left = brighter_left;
    made.near = 2;
    made.far = 8;
    made.extent = std::log(4);
    EdgePiece piece;
    piece.forward = kForward;
    piece.lateral = lateral + turn * kForward;
    piece.slope = turn;
    piece.covariance = Eigen::Vector2d(1e-8, 1e-8).asDiagonal();
    made.pieces = {piece};
    edges.push_back(made);
    return &edges.back();
  }
  /// Both sides of a strip, bright or dark.
  void add(double left, double right, bool bright = true) {
    pairs.push_back({edge(left, !bright), edge(right, bright)});
  }
  CentreSolutions solutions(const ChartWidth& chart = {}) {
    const RunwayCrossSection whole = fitRunway(axes, pairs, 0);
    return centreSolutions(axes, pairs, 0, {whole.centre, whole.variance}, chart);
  }
};

double without(CentreSource source, const CentreSolutions& solutions) { return solutions[source].value; }

TEST(CentreSolutions, WithoutAnEdgeTheStripeInTheMiddleTellsTheCentre) {
  Ground ground;
  ground.add(2.3, -2, false);  // the left edge is 0.3 off
  ground.add(0.03, -0.03);
  const CentreSolutions found = ground.solutions();
  EXPECT_NEAR(without(CentreSource::kLeftEdge, found), 0, 1e-4);
  EXPECT_NEAR(without(CentreSource::kRightEdge, found), 0, 1e-4);
  EXPECT_NEAR(without(CentreSource::kStripe, found), 0.15, 1e-4);
  EXPECT_GT(without(CentreSource::kMarks, found), 0.02) << "of which there are none";
  EXPECT_LT(without(CentreSource::kMarks, found), 0.13);
  EXPECT_NEAR(without(CentreSource::kWholeRunway, found), without(CentreSource::kMarks, found), 1e-12);
}

TEST(CentreSolutions, BarsBesideTheMiddleAreASourceOfTheirOwn) {
  Ground ground;
  ground.add(2, -2, false);
  ground.add(0.03, -0.03);
  ground.add(1.2, -1);  // 0.1 off
  ground.add(1, -0.8);
  const CentreSolutions found = ground.solutions();
  EXPECT_NEAR(without(CentreSource::kMarks, found), 0, 1e-4);
  EXPECT_GT(std::abs(without(CentreSource::kStripe, found)), 1e-3);
}

TEST(CentreSolutions, TwoEdgesAloneHaveNothingThatChecksThem) {
  Ground ground;
  ground.add(2, -2, false);
  const CentreSolutions found = ground.solutions();
  for (const CentreSource source :
       {CentreSource::kLeftEdge, CentreSource::kRightEdge, CentreSource::kWholeRunway})
    EXPECT_TRUE(std::isnan(without(source, found)));
}

TEST(CentreSolutions, BarsDoNotTellAWholeRunwayFromHalfOfOne) {
  Ground ground;
  ground.add(2, -2, false);
  ground.add(1.2, -1.2);
  EXPECT_TRUE(std::isnan(without(CentreSource::kWholeRunway, ground.solutions())));
  EXPECT_FALSE(std::isnan(without(CentreSource::kWholeRunway, ground.solutions({4}))))
      << "of a chart's width";
  EXPECT_TRUE(std::isnan(without(CentreSource::kWholeRunway, ground.solutions({4, true}))))
      << "while other edges look as much like a runway";
}

TEST(CentreSolutions, WithoutAnEdgeTheOtherOneAndTheChartsWidthTellTheCentre) {
  Ground ground;
  ground.add(2.1, -2, false);  // the left edge is 0.1 off
  const CentreSolutions found = ground.solutions({4});
  EXPECT_NEAR(without(CentreSource::kLeftEdge, found), 0, 1e-6);
  EXPECT_NEAR(without(CentreSource::kRightEdge, found), 0.1, 1e-6);
  // Half of the width, which is known to 3 %.
  EXPECT_NEAR(std::sqrt(found[CentreSource::kLeftEdge].variance), 2 * 0.03, 1e-3);
}

TEST(CentreSolutions, WithoutTheVanishingPointTheEdgesTellTheirDirection) {
  Ground ground;
  ground.turn = 0.01;  // although the axes claim to be known to 1e-5
  ground.add(2, -2, false);
  ground.add(0.03, -0.03);
  const CentreSolutions found = ground.solutions();
  EXPECT_NEAR(without(CentreSource::kDirection, found), 0, 2e-3);
  EXPECT_GT(without(CentreSource::kMarks, found), 0.03) << "four heights ahead they are 0.04 to the left";
}

}  // namespace
}  // namespace uav_landing
