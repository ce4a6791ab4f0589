// Messages that no stage would have sent: what they do to the estimate, now and afterwards.
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "approach_messages.h"
#include "message_fields.h"
#include "results/result_check.h"
#include "uav_landing/stages/kalman_height_stage.h"

namespace uav_landing {
namespace {

constexpr int kPairsBefore = 60, kPairsAfter = 20;  // the latter: 1 s

const std::vector<double> kPoisons = {0,
                                      -0.0,
                                      -1,
                                      1e-300,
                                      1e-12,
                                      1e6,
                                      1e155,
                                      -1e300,
                                      std::numeric_limits<double>::max(),
                                      std::numeric_limits<double>::infinity(),
                                      -std::numeric_limits<double>::infinity(),
                                      std::numeric_limits<double>::quiet_NaN()};

class ForeignMessages : public ::testing::Test {
 protected:
  /// A stage that has followed the approach for a while.
  KalmanHeightStage settled() {
    KalmanHeightStage stage(messages_.rig, {});
    for (pair_ = 0; pair_ < kPairsBefore; ++pair_) {
      messages_.make(pair_);
      const LandingResult result = stage.process(toResult(messages_.stereo), toResult(messages_.approach));
      EXPECT_TRUE(pair_ < 10 || result.valid()) << result.failure.message();
    }
    messages_.make(pair_);
    return stage;
  }

  void expectHonest(const LandingResult& result, int pair) const {
    if (result.height_valid) {
      EXPECT_LT(std::abs(result.height - messages_.height(pair)), 4 * std::sqrt(result.height_variance));
      EXPECT_GT(result.height_variance, 0);
    }
    if (result.angle_valid) {
      EXPECT_GT(result.approach_angle_variance, 0);
      EXPECT_LT(std::abs(result.approach_angle), M_PI / 2);
    }
  }

  /// Feeds the messages, then a second of healthy ones; the last must be as if nothing had been.
  void expectRecovery(KalmanHeightStage stage, const StereoDepth& stereo, const ApproachAngle& approach) {
    expectHonest(stage.process(toResult(stereo), toResult(approach)), kPairsBefore);
    ApproachMessages healthy;
    LandingResult result;
    for (int pair = kPairsBefore + 1; pair <= kPairsBefore + kPairsAfter; ++pair) {
      healthy.make(pair);
      result = stage.process(toResult(healthy.stereo), toResult(healthy.approach));
      expectHonest(result, pair);
    }
    EXPECT_TRUE(result.valid()) << result.failure.message();
    const double truth = healthy.height(kPairsBefore + kPairsAfter);
    EXPECT_NEAR(result.height, truth, 0.001 * truth);
    EXPECT_NEAR(std::sqrt(result.height_variance / usual_.height_variance), 1, 0.2);
    EXPECT_LT(result.height_protection_level, 1.4 * usual_.height_protection_level);
    EXPECT_NEAR(result.vertical_speed, -ApproachMessages::kSink, 0.1);
    EXPECT_NEAR(result.approach_angle, ApproachMessages::angle(), 0.001);
    EXPECT_NEAR(result.pitch, ApproachMessages::kPitch, 0.001);
    EXPECT_NEAR(result.roll, ApproachMessages::kRoll, 0.001);
    EXPECT_NEAR(result.yaw, usual_.yaw, 0.001);
    EXPECT_NEAR(result.y, 1, 0.5);
    EXPECT_NEAR(result.x, usual_.x, 3);
    EXPECT_NEAR(result.width_height, truth, 0.02 * truth);
    EXPECT_TRUE(result.rig_rotation.known());
    EXPECT_LT((result.rig_rotation.w - usual_.rig_rotation.w).cwiseAbs().maxCoeff(), 1e-4);
  }

  /// Healthy pairs after a spoiled one, as long as it takes until the ground in view then is below: the
  /// protection level must stay of the size that it would have had.
  void expectProtectionAsUsual(KalmanHeightStage spoiled, KalmanHeightStage usual,
                               int from = kPairsBefore + 1) {
    ApproachMessages healthy;
    for (int pair = from; pair <= kPairsBefore + 3 * kPairsAfter; ++pair) {
      healthy.make(pair);
      const LandingResult result = spoiled.process(toResult(healthy.stereo), toResult(healthy.approach));
      const LandingResult expected = usual.process(toResult(healthy.stereo), toResult(healthy.approach));
      EXPECT_TRUE(result.height_valid) << pair << ": " << result.failure.message();
      EXPECT_LT(result.height_protection_level, 2 * expected.height_protection_level) << pair;
    }
  }

  void rememberTheUsual(KalmanHeightStage stage) {
    ApproachMessages healthy;
    for (int pair = kPairsBefore; pair <= kPairsBefore + kPairsAfter; ++pair) {
      healthy.make(pair);
      usual_ = stage.process(toResult(healthy.stereo), toResult(healthy.approach));
    }
    ASSERT_TRUE(usual_.valid());
  }

  /// Poisons every number of the message by turns, alone and (array by array it is in) with all others.
  template <class Message, class Feed>
  void poisonEveryNumber(const Message& healthy, Feed&& feed) {
    int numbers = 0;
    FieldVisitor counter;
    counter.on_number = [&](double&) { ++numbers; };
    Message copy = healthy;
    counter.visit(copy);
    ASSERT_GT(numbers, 25);
    for (int target = 0; target < numbers; ++target) {
      for (const double poison : kPoisons) {
        Message poisoned = healthy;
        int index = 0;
        FieldVisitor visitor;
        visitor.on_number = [&](double& number) {
          if (index++ == target) number = poison;
        };
        visitor.visit(poisoned);
        SCOPED_TRACE("number " + std::to_string(target) + " of " + std::to_string(numbers) + " is " +
                     std::to_string(poison));
        feed(poisoned);
        if (HasFailure()) return;
      }
    }
  }

  /// All numbers of the message the same.
  template <class Message, class Feed>
  void poisonAllNumbers(const Message& healthy, Feed&& feed) {
    for (const double poison : kPoisons) {
      Message poisoned = healthy;
      FieldVisitor visitor;
      visitor.on_number = [&](double& number) { number = poison; };
      visitor.visit(poisoned);
      SCOPED_TRACE("all numbers are " + std::to_string(poison));
      feed(poisoned);
    }
  }

  ApproachMessages messages_;
  LandingResult usual_;
  int pair_ = 0;
};

TEST_F(ForeignMessages, OneBadNumberOfStereoDepthIsForgottenWithinASecond) {
  const KalmanHeightStage stage = settled();
  rememberTheUsual(stage);
  poisonEveryNumber(messages_.stereo, [&](const StereoDepth& poisoned) {
    expectRecovery(stage, poisoned, messages_.approach);
  });
}

TEST_F(ForeignMessages, OneBadNumberOfApproachAngleIsForgottenWithinASecond) {
  const KalmanHeightStage stage = settled();
  rememberTheUsual(stage);
  poisonEveryNumber(messages_.approach, [&](const ApproachAngle& poisoned) {
    expectRecovery(stage, messages_.stereo, poisoned);
  });
}

TEST_F(ForeignMessages, AMessageFullOfOneNumberIsForgottenWithinASecond) {
  const KalmanHeightStage stage = settled();
  rememberTheUsual(stage);
  poisonAllNumbers(messages_.stereo,
                   [&](const StereoDepth& poisoned) { expectRecovery(stage, poisoned, messages_.approach); });
  poisonAllNumbers(messages_.approach,
                   [&](const ApproachAngle& poisoned) { expectRecovery(stage, messages_.stereo, poisoned); });
}

TEST_F(ForeignMessages, AStepThatTheCameraDidNotTakeIsForgottenWithinASecond) {
  const KalmanHeightStage stage = settled();
  rememberTheUsual(stage);
  ApproachAngle& approach = messages_.approach;
  StereoDepth blind = messages_.stereo;
  blind.reason = "no_plane";
  const auto test = [&](double& number, double error) {
    const double healthy = number;
    number += error;
    SCOPED_TRACE(error);
    expectRecovery(stage, messages_.stereo, approach);
    expectRecovery(stage, blind, approach);
    number = healthy;
  };
  for (int axis = 0; axis < 3; ++axis) {
    SCOPED_TRACE(axis);
    for (const double turn : {-0.2, 0.05, 0.2}) test(approach.step.rotation[axis], turn);
    for (const double way : {-0.1, 0.05, 0.1}) test(approach.step.translation_over_height[axis], way);
  }
  // Of another time than that between the two pairs.
  for (const double factor : {0.5, 20.0}) {
    ApproachAngle other = approach;
    other.step.duration *= factor;
    expectRecovery(stage, messages_.stereo, other);
  }
}

TEST_F(ForeignMessages, AStepThatClaimsToKnowNothingDoesNotLiftTheGroundThatIsRemembered) {
  const KalmanHeightStage stage = settled();
  const ApproachAngle usual_approach = messages_.approach;
  ApproachAngle& approach = messages_.approach;
  for (const double way : {-0.15, -0.05, 0.05, 0.15}) {  // of the height; the whole step has 0.06
    SCOPED_TRACE(way);
    approach = usual_approach;
    approach.step.translation_over_height[1] += way;
    approach.step.covariance[6 * 4 + 4] = 1;
    KalmanHeightStage spoiled = stage, usual = stage;
    spoiled.process(toResult(messages_.stereo), toResult(approach));
    usual.process(toResult(messages_.stereo), toResult(usual_approach));
    expectProtectionAsUsual(spoiled, usual);
  }
}

TEST_F(ForeignMessages, ABendOfOnePairDoesNotBendTheRig) {
  const KalmanHeightStage stage = settled();
  rememberTheUsual(stage);
  for (const int axis : {0, 2}) {
    for (const double angle : {-0.09, 0.004, 0.02}) {
      SCOPED_TRACE(testing::Message() << axis << ": " << angle << " rad");
      StereoDepth bent = messages_.stereo;
      bent.vertical_rotation[axis] += angle;
      expectRecovery(stage, bent, messages_.approach);
    }
  }
}

TEST_F(ForeignMessages, ATiltThatNoStepContradictsDoesNotTiltTheGroundThatIsRemembered) {
  const KalmanHeightStage stage = settled();
  const ApproachAngle healthy_approach = messages_.approach;
  ApproachAngle& approach = messages_.approach;
  approach.step.duration *= 0.8;
  const StereoDepthResult healthy = toResult(messages_.stereo);
  for (const double tilt : {1.0, 1.8}) {
    for (const double height : {1.0, 1.5}) {  // the latter contradicts: the pair is left out
      SCOPED_TRACE(testing::Message() << tilt << " deg, " << height);
      const Eigen::Matrix3d turn =
          Eigen::AngleAxisd(tilt * M_PI / 180, Eigen::Vector3d::UnitX()).toRotationMatrix();
      const Eigen::Vector3d g = turn * healthy.plane.g / height;
      StereoDepth tilted = messages_.stereo;
      for (int i = 0; i < 3; ++i) tilted.plane[i] = g[i];
      KalmanHeightStage spoiled = stage, usual = stage;
      spoiled.process(toResult(tilted), toResult(approach));
      usual.process(healthy, toResult(healthy_approach));
      expectProtectionAsUsual(spoiled, usual);
      // A blind pair after it: no normal that puts things right at once.
      ApproachMessages next;
      next.make(pair_ + 1);
      StereoDepth blind = next.stereo;
      blind.reason = "no_plane";
      for (KalmanHeightStage* both : {&spoiled, &usual})
        both->process(toResult(blind), toResult(next.approach));
      expectProtectionAsUsual(spoiled, usual, kPairsBefore + 2);
    }
  }
}

TEST_F(ForeignMessages, APlaneThatIsNothingButItsCovarianceGivesNoHeight) {
  const KalmanHeightStage stage = settled();
  rememberTheUsual(stage);
  // Of any size: any direction in the ground seems to agree with it.
  StereoDepth& stereo = messages_.stereo;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) stereo.plane_covariance[3 * i + k] = stereo.plane[i] * stereo.plane[k];
  KalmanHeightStage copy = stage;
  ApproachAngleResult no_width = toResult(messages_.approach);
  no_width.runway.failure = {Reason::kNoRunway, ""};
  const LandingResult result = copy.process(toResult(stereo), no_width);
  EXPECT_NE(result.failure.message().find("uncertain: the height of the ground plane has 1 sigma of 1"),
            std::string::npos)
      << result.failure.message();
  expectRecovery(stage, stereo, messages_.approach);
}

TEST_F(ForeignMessages, ThePointsOfAPairThatIsLeftOutAreNotRemembered) {
  const KalmanHeightStage stage = settled();
  for (const double height : {0.9, 1.1, 1.5}) {
    SCOPED_TRACE(height);
    StereoDepth other = messages_.stereo;
    for (double& number : other.plane) number /= height;
    for (double& number : other.disparity) number /= height;
    KalmanHeightStage spoiled = stage, usual = stage;
    EXPECT_TRUE(spoiled.process(toResult(other), toResult(messages_.approach)).rejected);
    usual.process(toResult(messages_.stereo), toResult(messages_.approach));
    expectProtectionAsUsual(spoiled, usual);
  }
}

TEST_F(ForeignMessages, CovariancesOfAnotherScaleAreForgottenWithinASecond) {
  const KalmanHeightStage stage = settled();
  rememberTheUsual(stage);
  ApproachAngle& approach = messages_.approach;
  StereoDepth& stereo = messages_.stereo;
  for (double scale : {-1.0, 1e-300, 1e-12, 1e-6, 1e6, 1e12, 1e300}) {
    const auto test = [&](auto& covariance) {
      const auto healthy = covariance;
      for (double& number : covariance) number *= scale;
      expectRecovery(stage, stereo, approach);
      covariance = healthy;
    };
    SCOPED_TRACE("scale " + std::to_string(scale));
    test(stereo.plane_covariance);
    test(stereo.vertical_rotation_covariance);
    test(stereo.baseline_direction_covariance);
    test(approach.vanishing_covariance);
    test(approach.n_vp_covariance);
    test(approach.n_covariance);
    test(approach.step.covariance);
    test(approach.window.covariance);
    test(approach.window.normal_covariance);
  }
}

TEST_F(ForeignMessages, ArraysOfDifferentLengthsGiveNoHeightAndSayWhy) {
  KalmanHeightStage stage = settled();
  rememberTheUsual(stage);
  const StereoDepth healthy = messages_.stereo;
  for (int array = 0; array < 5; ++array) {
    for (const size_t length : {0, 1, 1000}) {
      StereoDepth stereo = healthy;
      if (array == 4) {
        stereo.on_plane.resize(length);
      } else {
        std::vector<double>* const arrays[] = {&stereo.u, &stereo.v, &stereo.disparity,
                                               &stereo.disparity_stddev};
        arrays[array]->resize(length);
      }
      EXPECT_EQ(toResult(stereo).failure.message(),
                "input_invalid: u, v, disparity, disparity_stddev, on_plane: lengths differ");
      expectRecovery(stage, stereo, messages_.approach);
    }
  }
}

TEST_F(ForeignMessages, MorePointsThanAnyStageGivesAreRefused) {
  const KalmanHeightStage stage = settled();
  rememberTheUsual(stage);
  StereoDepth stereo = messages_.stereo;
  for (std::vector<double>* numbers : {&stereo.u, &stereo.v, &stereo.disparity, &stereo.disparity_stddev})
    numbers->resize(1000000, 1.0);
  stereo.on_plane.resize(1000000, 1);
  EXPECT_EQ(checked(messages_.rig, toResult(stereo)).failure.message(),
            "input_invalid: u: 1000000 points, at most 100000 expected");
  expectRecovery(stage, stereo, messages_.approach);
}

TEST_F(ForeignMessages, TheFieldThatIsWrongIsNamed) {
  messages_.make(60);
  const auto messageOf = [&](const StereoDepth& stereo) {
    return checked(messages_.rig, toResult(stereo)).failure.message();
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  StereoDepth stereo = messages_.stereo;
  stereo.plane[1] = nan;
  EXPECT_NE(messageOf(stereo).find("input_invalid: plane: "), std::string::npos) << messageOf(stereo);
  stereo = messages_.stereo;
  stereo.plane_covariance[4] = -1;
  EXPECT_EQ(messageOf(stereo), "input_invalid: plane_covariance: not a covariance of this plane");
  stereo = messages_.stereo;
  stereo.plane_row_covariance[0] = 1;
  EXPECT_EQ(messageOf(stereo), "input_invalid: plane_row_covariance: not a part of plane_covariance");
  stereo = messages_.stereo;
  stereo.disparity_bias_stddev = 1000;
  EXPECT_EQ(messageOf(stereo),
            "input_invalid: disparity_bias_stddev: 1000 px is not part of plane_covariance");
  stereo = messages_.stereo;
  for (const double wrong : {-0.1, 11.0, nan}) {
    stereo.row_bias_stddev = wrong;
    EXPECT_NE(messageOf(stereo).find("input_invalid: row_bias_stddev: "), std::string::npos) << wrong;
  }
  stereo = messages_.stereo;
  for (const double wrong : {-0.1, 1.1}) {
    stereo.plane_lasting_share = wrong;
    EXPECT_NE(messageOf(stereo).find("input_invalid: plane_lasting_share: "), std::string::npos) << wrong;
  }
  for (const double unknown : {0.0, nan}) {
    stereo.plane_lasting_share = unknown;
    EXPECT_EQ(messageOf(stereo), "") << unknown;
  }
  stereo = messages_.stereo;
  stereo.surface_variance = 900;
  EXPECT_EQ(messageOf(stereo), "input_invalid: surface_variance: 900 m^2 at a height of 17 m");
  stereo = messages_.stereo;
  stereo.plane_below[1] = 9;
  EXPECT_EQ(messageOf(stereo), "input_invalid: plane_below: no tangent of the surface that the plane is of");
  stereo = messages_.stereo;
  stereo.skew = nan;
  EXPECT_EQ(messageOf(stereo), "input_invalid: skew: nan s, at most 0.1 expected");
  stereo.skew = -3;
  EXPECT_EQ(messageOf(stereo), "input_invalid: skew: -3 s, at most 0.1 expected");
}

TEST_F(ForeignMessages, ResultsOfTheOwnStagesComeThroughUnchanged) {
  ApproachMessages healthy;
  healthy.make(0);
  healthy.approach.runway.reason = healthy.approach.sight.reason = "no_runway";
  const StereoDepthResult stereo = checked(healthy.rig, toResult(healthy.stereo));
  const ApproachAngleResult approach = checked(toResult(healthy.approach));
  const auto bytes = [](const auto& message) {
    std::vector<uint8_t> buffer(ros::serialization::serializationLength(message));
    ros::serialization::OStream stream(buffer.data(), static_cast<uint32_t>(buffer.size()));
    ros::serialization::serialize(stream, message);
    return buffer;
  };
  EXPECT_EQ(bytes(toMessage(stereo, healthy.stereo.header, 1.0)), bytes(healthy.stereo));
  EXPECT_EQ(bytes(toMessage(approach, healthy.approach.header, 1.0)), bytes(healthy.approach));
}

TEST_F(ForeignMessages, AMessageThatWasNeverFilledInIsForgottenWithinASecond) {
  const KalmanHeightStage stage = settled();
  rememberTheUsual(stage);
  StereoDepth stereo;
  stereo.header = messages_.stereo.header;
  ApproachAngle approach;
  approach.header = messages_.approach.header;
  expectRecovery(stage, stereo, messages_.approach);
  expectRecovery(stage, messages_.stereo, approach);
  expectRecovery(stage, stereo, approach);
}

}  // namespace
}  // namespace uav_landing
