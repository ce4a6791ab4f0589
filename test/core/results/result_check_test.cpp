#include "results/result_check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>

#include "support/rigs.h"

namespace uav_landing {
namespace {

using Motion = ApproachAngleResult::Motion;

/// 2 m in 0.1 s at a height of 10 m, in a turn.
Motion possibleMotion() {
  Motion motion;
  motion.duration = 0.1;
  motion.rotation = {0.01, -0.02, 0.03};
  motion.translation_over_height = {0, 0.02, 0.2};
  motion.covariance = 1e-6 * Matrix6d::Identity();
  motion.angle = 0.1;
  motion.angle_variance = 1e-4;
  motion.row_motion = 0.001;
  motion.row_motion_limit = 0.003;
  return motion;
}

void expectMovementKept(const Motion& kept) {
  const Motion given = possibleMotion();
  EXPECT_EQ(kept.duration, given.duration);
  EXPECT_EQ(kept.rotation, given.rotation);
  EXPECT_EQ(kept.translation_over_height, given.translation_over_height);
  EXPECT_EQ(kept.covariance, given.covariance);
}

void expectNoAngle(const Motion& kept) {
  EXPECT_TRUE(std::isnan(kept.angle));
  EXPECT_TRUE(std::isnan(kept.angle_variance));
  EXPECT_TRUE(std::isnan(kept.row_motion) && std::isnan(kept.row_motion_limit));
}

void expectKept(const Motion& kept) {
  expectMovementKept(kept);
  EXPECT_EQ(kept.angle, possibleMotion().angle);
  EXPECT_EQ(kept.angle_variance, possibleMotion().angle_variance);
  EXPECT_EQ(kept.row_motion, possibleMotion().row_motion);
  EXPECT_EQ(kept.row_motion_limit, possibleMotion().row_motion_limit);
}

void expectUnknown(const Motion& kept) {
  EXPECT_TRUE(std::isnan(kept.duration));
  EXPECT_TRUE(kept.rotation.array().isNaN().all());
  EXPECT_TRUE(kept.translation_over_height.array().isNaN().all());
  EXPECT_TRUE(kept.covariance.array().isNaN().all());
  expectNoAngle(kept);
}

/// Both motions with the same numbers.
ApproachAngleResult checkedWith(const Failure& of_step, const Failure& of_window) {
  ApproachAngleResult result;
  result.step = result.window = possibleMotion();
  result.step.failure = of_step;
  result.window.failure = of_window;
  return checked(result);
}

TEST(ResultCheck, AMotionThatDidNotFailKeepsItsNumbers) {
  const ApproachAngleResult kept = checkedWith({}, {});
  expectKept(kept.step);
  expectKept(kept.window);
}

TEST(ResultCheck, AMotionOfRowsThatIsNoAngleIsLeftOutAlone) {
  for (const auto& [motion, limit] :
       {std::pair(-0.001, 0.003), {4.0, 0.003}, {0.001, 0.0}, {0.001, kUnknown}, {kUnknown, 0.003}}) {
    ApproachAngleResult result;
    result.step = possibleMotion();
    result.step.row_motion = motion;
    result.step.row_motion_limit = limit;
    const Motion kept = checked(result).step;
    EXPECT_TRUE(std::isnan(kept.row_motion) && std::isnan(kept.row_motion_limit));
    EXPECT_EQ(kept.angle, possibleMotion().angle);
  }
}

TEST(ResultCheck, AMotionThatIsExactInOneDirectionIsLeftOut) {
  for (const double variance : {0.0, -1e-146}) {
    ApproachAngleResult result;
    result.step = possibleMotion();
    result.step.covariance.row(0).setZero();
    result.step.covariance.col(0).setZero();
    result.step.covariance(0, 0) = variance;
    EXPECT_FALSE(checked(result).step.rotation.allFinite());
  }
}

TEST(ResultCheck, AMotionThatFailedLosesEachOfItsNumbersButNotItsReason) {
  for (const Reason reason : {Reason::kNotYet, Reason::kInputInvalid, Reason::kTooFewMatches,
                              Reason::kMotionInconsistent, Reason::kTimeJump}) {
    SCOPED_TRACE(toString(reason));
    const Failure failure{reason, "3 of 300"};
    const ApproachAngleResult without_step = checkedWith(failure, {});
    expectUnknown(without_step.step);
    EXPECT_EQ(without_step.step.failure.message(), failure.message());
    expectKept(without_step.window);
    const ApproachAngleResult without_window = checkedWith({}, failure);
    expectUnknown(without_window.window);
    EXPECT_EQ(without_window.window.failure.message(), failure.message());
    expectKept(without_window.step);
  }
}

// The turn of a camera that hovers is measured all the same.
TEST(ResultCheck, AMotionTooSmallForADirectionKeepsItsNumbersButNoAngle) {
  const Failure failure{Reason::kNoMotion, "standing still"};
  const ApproachAngleResult kept = checkedWith(failure, failure);
  for (const Motion& motion : {kept.step, kept.window}) {
    expectMovementKept(motion);
    expectNoAngle(motion);
  }
}

TEST(ResultCheck, ARotationOfTheRigFurtherThanAnyIsLeftOut) {
  StereoRig rig;
  rig.size = {640, 480};
  const auto isKept = [&](double x, double y, double z) {
    StereoDepthResult result;
    result.failure = {Reason::kNotYet, ""};
    result.vertical_rotation = {{x, y, z}, 1e-6 * Eigen::Matrix3d::Identity(), 100};
    return checked(rig, result).vertical_rotation.known();
  };
  EXPECT_TRUE(isKept(0.1, -0.9, -0.1));
  EXPECT_FALSE(isKept(0.3, 0, 0));
  EXPECT_FALSE(isKept(0, 1e300, 0));
  EXPECT_FALSE(isKept(0, 0, -0.3));
}

/// Level ground 10 m below, with everything that a pair can say of it.
StereoDepthResult possiblePair() {
  StereoDepthResult result;
  result.plane = {Eigen::Vector3d(0, 0.1, 0), 1e-8 * Eigen::Matrix3d::Identity()};
  result.row_covariance = 1e-9 * Eigen::Matrix3d::Identity();
  result.below = {Eigen::Vector3d(0, 0.101, 0), 2e-8 * Eigen::Matrix3d::Identity()};
  result.disparity_bias_stddev = 0.02;
  result.row_bias_stddev = 0.03;
  result.lasting_share = 0.5;
  result.surface_variance = 1e-3;
  result.skew = 0.002;
  result.points = {{320, 400, 50, 0.1, true}};
  return result;
}

StereoDepthResult checkedPair(const std::function<void(StereoDepthResult&)>& change) {
  StereoDepthResult result = possiblePair();
  change(result);
  return checked(test::usualRig(), result);
}

TEST(ResultCheck, APossiblePairKeepsItsPlane) {
  const auto expectKept = [](const std::function<void(StereoDepthResult&)>& change) {
    const StereoDepthResult kept = checkedPair(change);
    EXPECT_FALSE(kept.failure) << kept.failure.message();
    EXPECT_EQ(kept.plane.g, possiblePair().plane.g);
    EXPECT_EQ(kept.points.size(), 1u);
  };
  expectKept([](StereoDepthResult&) {});
  // What a pair need not know.
  expectKept([](StereoDepthResult& r) { r.below = {}; });
  expectKept([](StereoDepthResult& r) { r.lasting_share = kUnknown; });
  expectKept([](StereoDepthResult& r) { r.surface_variance = kUnknown; });
  expectKept([](StereoDepthResult& r) { r.row_covariance.setZero(); });
  expectKept([](StereoDepthResult& r) { r.surface_variance = -0.5; });  // an unbiased one scatters around 0
}

struct BadField {
  const char* field;
  std::function<void(StereoDepthResult&)> change;
};

class ImpossiblePair : public testing::TestWithParam<BadField> {};

TEST_P(ImpossiblePair, HasNoPlaneAndAReasonThatNamesTheField) {
  const StereoDepthResult kept = checkedPair(GetParam().change);
  EXPECT_EQ(kept.failure.reason, Reason::kInputInvalid);
  EXPECT_EQ(kept.failure.detail.find(std::string(GetParam().field) + ":"), 0u) << kept.failure.detail;
  EXPECT_FALSE(kept.plane.valid());
}

Eigen::Matrix3d asymmetric() {
  Eigen::Matrix3d matrix = 1e-8 * Eigen::Matrix3d::Identity();
  matrix(0, 1) = 1e-9;
  return matrix;
}

INSTANTIATE_TEST_SUITE_P(
    ByField, ImpossiblePair,
    testing::Values(
        BadField{"plane",
                 [](StereoDepthResult& r) {
                   r.plane.g = {0, -0.1, 0};
                 }},
        BadField{"plane",
                 [](StereoDepthResult& r) {
                   r.plane.g = {0.1, 0.01, 0};
                 }},
        BadField{"plane",
                 [](StereoDepthResult& r) {
                   r.plane.g = {0, 1e4, 0};
                 }},
        BadField{"plane_covariance", [](StereoDepthResult& r) { r.plane.covariance.setZero(); }},
        BadField{"plane_covariance", [](StereoDepthResult& r) { r.plane.covariance = asymmetric(); }},
        BadField{"plane_covariance", [](StereoDepthResult& r) { r.plane.covariance(0, 0) = -1e-8; }},
        BadField{"plane_covariance", [](StereoDepthResult& r) { r.plane.covariance(1, 1) = kUnknown; }},
        BadField{"plane_row_covariance", [](StereoDepthResult& r) { r.row_covariance *= 100; }},
        BadField{"plane_by_rate", [](StereoDepthResult& r) { r.plane_by_rate(1, 1) = 101; }},
        BadField{"plane_by_rate", [](StereoDepthResult& r) { r.plane_by_rate(2, 0) = kUnknown; }},
        BadField{"plane_rate", [](StereoDepthResult& r) { r.plane_rate.y() = 200; }},
        BadField{"plane_rate", [](StereoDepthResult& r) { r.plane_rate.y() = kUnknown; }},
        BadField{"disparity_bias_stddev", [](StereoDepthResult& r) { r.disparity_bias_stddev = 0.1; }},
        BadField{"disparity_bias_stddev", [](StereoDepthResult& r) { r.disparity_bias_stddev = -0.01; }},
        BadField{"row_bias_stddev", [](StereoDepthResult& r) { r.row_bias_stddev = 11; }},
        BadField{"plane_lasting_share", [](StereoDepthResult& r) { r.lasting_share = 1.1; }},
        BadField{"plane_lasting_share", [](StereoDepthResult& r) { r.lasting_share = 0; }},
        BadField{"surface_variance", [](StereoDepthResult& r) { r.surface_variance = 101; }},
        BadField{"surface_variance", [](StereoDepthResult& r) { r.surface_variance = -1.1; }},
        BadField{"plane_below", [](StereoDepthResult& r) { r.below.g *= 3; }},
        BadField{"plane_below", [](StereoDepthResult& r) { r.below.covariance.setZero(); }},
        BadField{"skew", [](StereoDepthResult& r) { r.skew = 0.2; }},
        BadField{"skew", [](StereoDepthResult& r) { r.skew = kUnknown; }}));

TEST(ResultCheck, PointsThatNoImageHasAreLeftOut) {
  const auto isKept = [](double u, double v, double disparity, double stddev) {
    return !checkedPair([&](StereoDepthResult& r) {
              r.points = {{u, v, disparity, stddev, true}};
            }).points.empty();
  };
  EXPECT_TRUE(isKept(0, 0, -3, 0.1));
  EXPECT_TRUE(isKept(639, 479, 600, 0.1));
  EXPECT_FALSE(isKept(-1, 0, 50, 0.1));
  EXPECT_FALSE(isKept(640, 0, 50, 0.1));
  EXPECT_FALSE(isKept(0, 480, 50, 0.1));
  EXPECT_FALSE(isKept(0, 0, 1e9, 0.1));
  EXPECT_FALSE(isKept(0, 0, kUnknown, 0.1));
  EXPECT_FALSE(isKept(0, 0, 50, 0));
}

TEST(ResultCheck, ABaselineFurtherThanAnyIsLeftOut) {
  const auto isKept = [](double down, double variance) {
    return checkedPair([&](StereoDepthResult& r) {
             r.baseline_direction = {{down, 0.1}, variance * Eigen::Matrix2d::Identity()};
           })
        .baseline_direction.known();
  };
  EXPECT_TRUE(isKept(0.1, 1e-4));
  EXPECT_FALSE(isKept(200, 1e-4));
  EXPECT_FALSE(isKept(0.1, 0));
}

TEST(ResultCheck, TurnsBetweenRowsThatCannotBeAreLeftOut) {
  const auto isKept = [](const Eigen::Vector3d& mean, double variance) {
    ApproachAngleResult result;
    result.plane_by_turns = {mean, variance * Eigen::Matrix3d::Identity()};
    const ApproachAngleResult::PlaneByTurns kept = checked(result).plane_by_turns;
    EXPECT_TRUE(kept.mean == mean || (kept.mean.isZero(0) && kept.covariance.isZero(0)));
    return kept.mean == mean && kept.covariance == result.plane_by_turns.covariance;
  };
  EXPECT_TRUE(isKept({1e-3, 0, -1e-3}, 1e-8));
  EXPECT_TRUE(isKept({1e-3, 0, 0}, 0));
  EXPECT_FALSE(isKept({0, 0, 2}, 1e-8));
  EXPECT_FALSE(isKept({0, 0, kUnknown}, 1e-8));
  EXPECT_FALSE(isKept({1e-3, 0, 0}, -1e-8));
  EXPECT_FALSE(isKept({1e-3, 0, 0}, kUnknown));
}

TEST(ResultCheck, ARateOfTurnThatNoAircraftHasIsLeftOut) {
  const auto isKept = [](const Eigen::Vector3d& rate) {
    ApproachAngleResult result;
    result.step.turn_rate = rate;
    return checked(result).step.turn_rate == rate;
  };
  EXPECT_FALSE(isKept({0, 20, 0}));
  EXPECT_FALSE(isKept({0, 0, kUnknown}));
}

TEST(ResultCheck, AReadoutTimeThatNoCameraHasIsLeftOut) {
  const auto isKept = [](double time, double variance) {
    ApproachAngleResult result;
    result.readout = {time, variance};
    return !checked(result).readout.given();
  };
  EXPECT_TRUE(isKept(-0.03, 1e-5));
  EXPECT_FALSE(isKept(2, 1e-5));
  EXPECT_FALSE(isKept(kUnknown, 1e-5));
  EXPECT_TRUE(isKept(0, 0)) << "taken as global";
  EXPECT_FALSE(isKept(0.03, 0));
  EXPECT_FALSE(isKept(0.03, kUnknown));
  EXPECT_FALSE(isKept(0.03, 2));
}

/// A runway of 45 m by 2 km that is seen from 1.5 km before it and 80 m above it.
ApproachAngleResult::Sight possibleSight() {
  ApproachAngleResult::Sight sight;
  sight.position = {-1500, 3, 80};
  sight.covariance = Eigen::Vector3d(100, 1, 4).asDiagonal();
  sight.yaw = 0.02;
  sight.width = 45;
  sight.length = 2000;
  sight.size_over_chart = 1.01;
  sight.disparity = 0.3;
  sight.disparity_variance = 1e-3;
  sight.height_by_chart = 70;
  sight.height_without = {79, 81, 82};
  sight.yaw_variance = sight.width_variance = sight.length_variance = sight.size_over_chart_variance = 1e-4;
  sight.variance_without.setConstant(9);
  return sight;
}

TEST(ResultCheck, AnOutlineLosesWhatIsNoNumberAndKeepsTheRest) {
  const auto known = [](const std::function<void(ApproachAngleResult::Sight&)>& change) {
    ApproachAngleResult result;
    result.sight = possibleSight();
    change(result.sight);
    const ApproachAngleResult::Sight kept = checked(result).sight;
    std::string names;
    const auto add = [&](const char* name, double value, double variance) {
      EXPECT_EQ(std::isfinite(value), std::isfinite(variance)) << name;
      if (std::isfinite(value)) names += name;
    };
    add("yaw ", kept.yaw, kept.yaw_variance);
    add("width ", kept.width, kept.width_variance);
    add("length ", kept.length, kept.length_variance);
    add("disparity ", kept.disparity, kept.disparity_variance);
    if (std::isfinite(kept.height_by_chart)) names += "chart ";
    if (std::isfinite(kept.height_by_bias)) names += "bias ";
    add("size ", kept.size_over_chart, kept.size_over_chart_variance);
    for (int i = 0; i < 3; ++i) add("without ", kept.height_without[i], kept.variance_without[i]);
    add("position", kept.position.sum(), kept.covariance.sum());
    return names;
  };
  using Sight = ApproachAngleResult::Sight;
  EXPECT_EQ(known([](Sight&) {}),
            "yaw width length disparity chart bias size without without without position");
  EXPECT_EQ(known([](Sight& s) { s.yaw_variance = -1; }),
            "width length disparity chart bias size without without without position");
  EXPECT_EQ(known([](Sight& s) { s.width = 1e6; }),
            "yaw length disparity chart bias size without without without position");
  EXPECT_EQ(known([](Sight& s) { s.length_variance = kUnknown; }),
            "yaw width disparity chart bias size without without without position");
  EXPECT_EQ(known([](Sight& s) { s.size_over_chart = kUnknown; }),
            "yaw width length disparity chart bias without without without position");
  EXPECT_EQ(known([](Sight& s) { s.variance_without[1] = -4; }),
            "yaw width length disparity chart bias size without without position");
  EXPECT_EQ(known([](Sight& s) { s.disparity_variance = -1; }),
            "yaw width length chart bias size without without without position");
  EXPECT_EQ(known([](Sight& s) {
              s.height_by_chart = -1;
              s.height_by_bias = kUnknown;
            }),
            "yaw width length disparity size without without without position");
  EXPECT_EQ(known([](Sight& s) { s.position.x() = -1e6; }),
            "yaw width length disparity chart bias size without without without ");
  EXPECT_EQ(known([](Sight& s) { s.covariance(2, 2) = -1; }),
            "yaw width length disparity chart bias size without without without ");
}

/// A runway that is seen from 2 heights to the side, 4 heights wide, 10 heights ahead.
ApproachAngleResult::Runway checkedRunway(const std::function<void(ApproachAngleResult::Runway&)>& change) {
  ApproachAngleResult result;
  ApproachAngleResult::Runway& runway = result.runway;
  runway.failure = runway.threshold_failure = {};
  runway.y = 2;
  runway.width = 4;
  runway.x = -10;
  runway.y_variance = runway.width_variance = runway.x_variance = 0.01;
  runway.x_systematic_variance = 0.004;
  change(runway);
  return checked(result).runway;
}

TEST(ResultCheck, OneOfItsSolutionsMayBeNoneWithoutHarmToTheOthers) {
  using Runway = ApproachAngleResult::Runway;
  for (const CentreSolutions::Solution bad : {CentreSolutions::Solution{2, -1}, {1e9, 1}, {kUnknown, 1}}) {
    const Runway runway = checkedRunway([&](Runway& r) {
      r.y_without.without.fill({2.5, 0.04});
      r.y_without[CentreSource::kMarks] = bad;
    });
    EXPECT_TRUE(std::isnan(runway.y_without[CentreSource::kMarks].value));
    EXPECT_TRUE(std::isnan(runway.y_without[CentreSource::kMarks].variance));
    EXPECT_EQ(runway.y_without[CentreSource::kDirection].value, 2.5);
    EXPECT_FALSE(runway.failure);
  }
}

TEST(ResultCheck, ARunwayLosesWhatIsNoLengthAndKeepsTheRest) {
  using Runway = ApproachAngleResult::Runway;
  const Runway kept = checkedRunway([](Runway&) {});
  EXPECT_FALSE(kept.failure || kept.threshold_failure);
  EXPECT_EQ(kept.x, -10);
  EXPECT_EQ(kept.x_systematic_variance, 0.004);
  const Runway without_y = checkedRunway([](Runway& r) { r.y_variance = -1; });
  EXPECT_EQ(without_y.failure.detail.find("runway.y:"), 0u) << without_y.failure.detail;
  EXPECT_TRUE(std::isnan(without_y.y) && std::isnan(without_y.y_variance));
  EXPECT_EQ(without_y.x, -10);
  for (const double width : {-4.0, 0.0, 1e5}) {
    const Runway without_width = checkedRunway([&](Runway& r) { r.width = width; });
    EXPECT_FALSE(without_width.failure);
    EXPECT_TRUE(std::isnan(without_width.width) && std::isnan(without_width.width_variance)) << width;
  }
  // A part is not larger than the whole.
  const Runway without_x = checkedRunway([](Runway& r) { r.x_systematic_variance = 0.02; });
  EXPECT_EQ(without_x.threshold_failure.detail.find("runway.x:"), 0u) << without_x.threshold_failure.detail;
  EXPECT_TRUE(std::isnan(without_x.x) && std::isnan(without_x.x_variance));
  EXPECT_EQ(without_x.x_systematic_variance, 0);
  EXPECT_FALSE(without_x.failure);
}

TEST(ResultCheck, AnImuKeepsAnAttitudeWithoutARotationAndARotationWithoutAnAttitude) {
  ApproachAngleResult result;
  result.imu.normal = {0, 1, 0};
  result.imu.normal_covariance = 1e-4 * Eigen::Matrix3d::Identity();
  result.imu.rotation = {0, 0.01, 0};
  result.imu.rotation_covariance = 1e-6 * Eigen::Matrix3d::Identity();
  result.imu.duration = 0.05;
  const AttitudePrior whole = checked(result).imu;
  EXPECT_TRUE(whole.hasNormal() && whole.hasRotation());
  ApproachAngleResult turned_too_far = result, not_a_direction = result;
  turned_too_far.imu.rotation *= 1000;
  not_a_direction.imu.normal *= 2;
  const AttitudePrior without_rotation = checked(turned_too_far).imu;
  EXPECT_TRUE(without_rotation.hasNormal());
  EXPECT_FALSE(without_rotation.hasRotation());
  EXPECT_TRUE(std::isnan(without_rotation.duration));
  const AttitudePrior without_normal = checked(not_a_direction).imu;
  EXPECT_FALSE(without_normal.hasNormal());
  EXPECT_TRUE(without_normal.hasRotation());
}

}  // namespace
}  // namespace uav_landing
