#include "pairing.h"

#include <gtest/gtest.h>

#include <boost/make_shared.hpp>

using namespace uav_landing;

namespace {

const std::vector<std::string> kTopics{"/left/image_raw", "/left/camera_info", "/right/image_raw",
                                       "/right/camera_info"};

template <class Message>
boost::shared_ptr<const Message> stamped(double stamp) {
  auto message = boost::make_shared<Message>();
  message->header.stamp = ros::Time(stamp);
  return message;
}

class StereoPairingTest : public testing::Test {
 protected:
  explicit StereoPairingTest(const RectifyParameters& parameters = RectifyParameters())
      : pairing_(parameters, kTopics,
                 [this](const auto& left, const auto& left_info, const auto& right, const auto& right_info) {
                   EXPECT_EQ(left->header.stamp, left_info->header.stamp);
                   EXPECT_EQ(right->header.stamp, right_info->header.stamp);
                   pairs_.emplace_back(left->header.stamp.toSec(), right->header.stamp.toSec());
                 }) {}

  void addLeft(double stamp) {
    pairing_.add<0>(stamped<sensor_msgs::Image>(stamp));
    pairing_.add<1>(stamped<sensor_msgs::CameraInfo>(stamp));
  }
  void addRight(double stamp) {
    pairing_.add<2>(stamped<sensor_msgs::Image>(stamp));
    pairing_.add<3>(stamped<sensor_msgs::CameraInfo>(stamp));
  }
  void addPair(double stamp) {
    addLeft(stamp);
    addRight(stamp);
  }

  using Pairs = std::vector<std::pair<double, double>>;
  Pairs pairs_;
  StereoPairing pairing_;
};

class ApproximatePairingTest : public StereoPairingTest {
 protected:
  static RectifyParameters approximate() {
    RectifyParameters parameters;
    parameters.approximate_sync = true;
    parameters.max_skew = 0.01;
    return parameters;
  }
  ApproximatePairingTest() : StereoPairingTest(approximate()) {}
};

TEST_F(StereoPairingTest, MessagesOfOneStampMakeAPair) {
  addPair(1.0);
  addPair(1.1);
  EXPECT_EQ(pairs_, (Pairs{{1.0, 1.0}, {1.1, 1.1}}));
  EXPECT_EQ(pairing_.complaint(), "");
}

TEST_F(StereoPairingTest, AMissingImageCostsItsCounterpartsOnly) {
  addPair(1.0);
  addLeft(1.1);
  addPair(1.2);
  EXPECT_EQ(pairs_, (Pairs{{1.0, 1.0}, {1.2, 1.2}}));
  const auto inputs = pairing_.inputs();
  EXPECT_EQ(inputs[0].received, 3u);
  EXPECT_EQ(inputs[0].paired, 2u);
  EXPECT_EQ(inputs[0].dropped, 1u);
  EXPECT_EQ(inputs[2].received, 2u);
  EXPECT_EQ(inputs[2].dropped, 0u);
}

TEST_F(StereoPairingTest, WhatWaitsIsBounded) {
  for (int i = 0; i < 20; ++i) addLeft(1.0 + 0.1 * i);
  addRight(1.0);
  EXPECT_TRUE(pairs_.empty()) << "the left image of 1.0 s was given up long ago";
  EXPECT_EQ(pairing_.inputs()[0].dropped, 15u) << "five wait";
}

TEST_F(StereoPairingTest, ALoopingBagKeepsPairing) {
  addPair(10.0);
  addLeft(10.1);
  addPair(1.0);
  addPair(1.1);
  EXPECT_EQ(pairs_, (Pairs{{10.0, 10.0}, {1.0, 1.0}, {1.1, 1.1}}));
  EXPECT_EQ(pairing_.jumps(), 1u);
}

TEST_F(StereoPairingTest, APairThatComesAfterTheNextOneIsLeftOutAndCounted) {
  addPair(1.0);
  addPair(1.2);
  addPair(1.1);
  addPair(1.3);
  EXPECT_EQ(pairs_, (Pairs{{1.0, 1.0}, {1.2, 1.2}, {1.3, 1.3}}));
  EXPECT_EQ(pairing_.jumps(), 0u);
  for (const InputWatch::Input& input : pairing_.inputs()) {
    EXPECT_EQ(input.late, 1u) << input.topic;
    EXPECT_EQ(input.dropped, 1u) << input.topic;
  }
}

TEST_F(StereoPairingTest, ALateImageLeavesWhatWaitsInPlace) {
  addPair(1.0);
  addLeft(1.2);
  addLeft(1.1);
  addRight(1.2);
  EXPECT_EQ(pairs_, (Pairs{{1.0, 1.0}, {1.2, 1.2}}));
}

TEST_F(StereoPairingTest, AClockSetBackByLittleIsFollowedAfterTenImages) {
  addPair(1.0);
  for (int loop = 0; loop < 6; ++loop)
    for (const double stamp : {0.8, 0.9, 1.0}) addPair(stamp);
  EXPECT_EQ(pairing_.jumps(), 1u);
  EXPECT_GE(pairs_.size(), 2u);
}

TEST_F(StereoPairingTest, RightImageLeftOverFromTheLastLoopIsNotPaired) {
  addPair(10.0);
  addRight(10.1);
  addPair(1.0);
  addLeft(10.1);
  EXPECT_EQ(pairs_, (Pairs{{10.0, 10.0}, {1.0, 1.0}}));
}

TEST_F(StereoPairingTest, WhatWasUnderWayWhenTheClockWentBackLeavesWhatWaitsInPlace) {
  addPair(10.0);
  addLeft(10.1);
  addLeft(10.2);
  addLeft(1.0);
  addRight(10.1);
  addRight(10.2);
  addLeft(1.1);
  addRight(1.0);
  addRight(1.1);
  addPair(1.2);
  EXPECT_EQ(pairs_, (Pairs{{10.0, 10.0}, {1.0, 1.0}, {1.1, 1.1}, {1.2, 1.2}}));
  EXPECT_EQ(pairing_.jumps(), 1u);
  EXPECT_EQ(pairing_.inputs()[2].late, 2u);
}

TEST_F(StereoPairingTest, OneWrongStampDoesNotKeepTheOtherInputsOut) {
  addPair(10.0);
  addLeft(1.0);
  for (const double stamp : {10.1, 10.2, 10.3}) addPair(stamp);
  EXPECT_EQ(pairs_, (Pairs{{10.0, 10.0}, {10.1, 10.1}, {10.2, 10.2}, {10.3, 10.3}}));
}

TEST_F(StereoPairingTest, ARepeatedStampIsDropped) {
  addPair(1.0);
  addPair(1.0);
  addPair(1.1);
  EXPECT_EQ(pairs_, (Pairs{{1.0, 1.0}, {1.1, 1.1}}));
  EXPECT_EQ(pairing_.inputs()[0].repeated, 1u);
}

TEST_F(StereoPairingTest, AMessageThatComesTwiceCountsOnce) {
  for (const double stamp : {1.0, 1.1}) {
    const auto image = stamped<sensor_msgs::Image>(stamp);
    pairing_.add<0>(image);
    pairing_.add<0>(image);
    pairing_.add<1>(stamped<sensor_msgs::CameraInfo>(stamp));
    addRight(stamp);
  }
  EXPECT_EQ(pairs_, (Pairs{{1.0, 1.0}, {1.1, 1.1}}));
  EXPECT_EQ(pairing_.inputs()[0].received, 2u);
  EXPECT_EQ(pairing_.inputs()[0].paired, 2u);
  EXPECT_EQ(pairing_.inputs()[0].dropped, 0u);
}

TEST_F(StereoPairingTest, AMessageThatIsSentAgainAndAgainIsARepeatedStamp) {
  addPair(1.0);
  pairing_.complaint();
  const auto image = stamped<sensor_msgs::Image>(1.0);
  for (int i = 0; i < 4; ++i) pairing_.add<0>(image);
  addRight(1.0);
  pairing_.add<1>(stamped<sensor_msgs::CameraInfo>(1.0));
  EXPECT_EQ(pairing_.inputs()[0].repeated, 2u);
  EXPECT_NE(pairing_.complaint().find("the stamp never changes on /left/image_raw"), std::string::npos);
}

TEST_F(StereoPairingTest, AMessageThatIsFilledInAnewIsAnotherOne) {
  const auto image = boost::make_shared<sensor_msgs::Image>();
  for (const double stamp : {1.0, 1.1}) {
    image->header.stamp = ros::Time(stamp);
    pairing_.add<0>(image);
    pairing_.add<1>(stamped<sensor_msgs::CameraInfo>(stamp));
    addRight(stamp);
  }
  EXPECT_EQ(pairs_.size(), 2u);
  EXPECT_EQ(pairing_.inputs()[0].paired, 2u);
}

TEST_F(StereoPairingTest, AMessageFromBeforeAResetIsTakenAgain) {
  const auto image = stamped<sensor_msgs::Image>(1.0);
  pairing_.add<0>(image);
  pairing_.reset();
  pairing_.add<0>(image);
  pairing_.add<1>(stamped<sensor_msgs::CameraInfo>(1.0));
  addRight(1.0);
  EXPECT_EQ(pairs_, (Pairs{{1.0, 1.0}})) << "a latched message";
}

TEST_F(StereoPairingTest, TheComplaintNamesTheSilentInputs) {
  addLeft(1.0);
  addLeft(1.1);
  EXPECT_EQ(pairing_.complaint(), "no message on /right/image_raw, /right/camera_info");
}

TEST_F(StereoPairingTest, TheComplaintLooksAtWhatCameSinceTheLast) {
  addPair(1.0);
  EXPECT_EQ(pairing_.complaint(), "");
  addLeft(1.1);
  EXPECT_EQ(pairing_.complaint(), "no message on /right/image_raw, /right/camera_info");
  addPair(1.2);
  EXPECT_EQ(pairing_.complaint(), "");
}

TEST_F(StereoPairingTest, TheComplaintShowsStampsThatDiffer) {
  addLeft(1.0);
  addRight(1.003);
  const std::string complaint = pairing_.complaint();
  EXPECT_NE(complaint.find("stamps do not match"), std::string::npos) << complaint;
  EXPECT_NE(complaint.find("/left/image_raw 1.0"), std::string::npos) << complaint;
  EXPECT_NE(complaint.find("/right/image_raw 1.003"), std::string::npos) << complaint;
}

TEST_F(StereoPairingTest, TheComplaintTellsAQueueThatIsTooShort) {
  for (int i = 0; i < 20; ++i) {
    addLeft(1.0 + 0.05 * i);
    if (i >= 7) addRight(1.0 + 0.05 * (i - 7));
  }
  EXPECT_TRUE(pairs_.empty());
  // Of the left images 1.35 to 1.95 are newer when the right one of 1.3 comes: 7 behind it, and itself.
  EXPECT_EQ(pairing_.complaint(),
            "the queue of 5 pairs is too short: /right/image_raw, /right/camera_info came after the others "
            "of their "
            "stamps had been given up; rectify/queue_size has to be at least 8");
  RectifyParameters longer;
  longer.queue_size = 8;
  size_t count = 0;
  StereoPairing enough(longer, kTopics, [&](const auto&...) { ++count; });
  for (int i = 0; i < 20; ++i) {
    const double left = 1.0 + 0.05 * i, right = 1.0 + 0.05 * (i - 7);
    enough.add<0>(stamped<sensor_msgs::Image>(left));
    enough.add<1>(stamped<sensor_msgs::CameraInfo>(left));
    if (i < 7) continue;
    enough.add<2>(stamped<sensor_msgs::Image>(right));
    enough.add<3>(stamped<sensor_msgs::CameraInfo>(right));
  }
  EXPECT_EQ(count, 13u);
}

TEST_F(ApproximatePairingTest, TheComplaintTellsByHowMuchTheSkewIsTooLarge) {
  for (int i = 0; i < 5; ++i) {
    addLeft(1.0 + 0.05 * i);
    addRight(1.015 + 0.05 * i);
  }
  EXPECT_TRUE(pairs_.empty());
  EXPECT_EQ(pairing_.complaint().rfind("the stamps are 15 ms apart, more than max_skew, 10 ms; latest: ", 0),
            0u);
}

class LargeSkewTest : public StereoPairingTest {
 protected:
  static RectifyParameters large() {
    RectifyParameters parameters;
    parameters.approximate_sync = true;
    parameters.max_skew = 0.1;
    return parameters;
  }
  LargeSkewTest() : StereoPairingTest(large()) {}
  /// Both cameras at a period, the right one's stamps ahead.
  std::string complaintOf(int count, double period, double ahead) {
    for (int i = 0; i < count; ++i) {
      addLeft(10 + period * i);
      addRight(10 + ahead + period * i);
    }
    EXPECT_TRUE(pairs_.empty());
    return pairing_.complaint();
  }
};

TEST_F(LargeSkewTest, ClocksThatDifferAreNoShortQueueThoughMaxSkewReachesBehindIt) {
  const std::string complaint = complaintOf(40, 0.01, 1);
  EXPECT_EQ(complaint.rfind("the stamps are 1000 ms apart, more than max_skew, 100 ms; latest: ", 0), 0u)
      << complaint;
}

TEST_F(LargeSkewTest, ClocksThatDifferAreToldThoughOneCameraReachesTheOthersStamps) {
  const std::string complaint = complaintOf(150, 0.01, 1);
  EXPECT_EQ(complaint.rfind("the stamps are 1000 ms apart: the clocks differ, or /left/image_raw, "
                            "/left/camera_info came that late",
                            0),
            0u)
      << complaint;
}

TEST_F(LargeSkewTest, NoQueueIsAdvisedThatCannotBe) {
  EXPECT_EQ(complaintOf(190, 0.01, 1.2),
            "the stamps are 1200 ms apart: the clocks differ, or /left/image_raw, /left/camera_info came "
            "that late");
}

TEST_F(ApproximatePairingTest, ALateCameraIsAShortQueueWhicheverItIs) {
  for (int i = 0; i < 20; ++i) {
    addRight(1.003 + 0.05 * i);
    if (i >= 7) addLeft(1.0 + 0.05 * (i - 7));
  }
  EXPECT_TRUE(pairs_.empty());
  EXPECT_EQ(pairing_.complaint(),
            "the queue of 5 pairs is too short: /left/image_raw, /left/camera_info came after the others of "
            "their stamps had been given up; rectify/queue_size has to be at least 8");
}

TEST_F(StereoPairingTest, AShortageNamesTheTopicThatHasFewerMessages) {
  const std::vector<InputWatch::Input> before = pairing_.inputs();
  for (int i = 0; i < 20; ++i) {
    pairing_.add<0>(stamped<sensor_msgs::Image>(1.0 + 0.05 * i));
    if (i % 2 == 0) pairing_.add<1>(stamped<sensor_msgs::CameraInfo>(1.0 + 0.05 * i));
    addRight(1.0 + 0.05 * i);
  }
  EXPECT_EQ(pairs_.size(), 10u);
  EXPECT_EQ(pairing_.complaint(), "");
  EXPECT_EQ(InputWatch::shortage(pairing_.inputs(), before),
            "9 of 20 stamps have no message on /left/camera_info");
  EXPECT_EQ(InputWatch::shortage(pairing_.inputs(), pairing_.inputs()), "");
}

TEST_F(StereoPairingTest, TheComplaintNamesAStampThatNeverChanges) {
  addPair(1.0);
  pairing_.complaint();
  addPair(1.0);
  addPair(1.0);
  EXPECT_NE(pairing_.complaint().find("the stamp never changes on /left/image_raw"), std::string::npos);
}

TEST_F(StereoPairingTest, TheComplaintNamesACameraWithoutStamps) {
  for (const double stamp : {1.0, 1.1}) {
    addLeft(stamp);
    addRight(0);
  }
  EXPECT_EQ(pairing_.complaint(), "the stamp (header.stamp) is 0 on /right/image_raw, /right/camera_info");
}

TEST_F(StereoPairingTest, AMessageWithoutAStampIsCountedAndChangesNothing) {
  addPair(1.0);
  addLeft(1.1);
  addLeft(0);
  addRight(0);
  addRight(1.1);
  EXPECT_EQ(pairs_, (Pairs{{1.0, 1.0}, {1.1, 1.1}}));
  EXPECT_EQ(pairing_.jumps(), 0u);
  for (const auto& input : pairing_.inputs()) EXPECT_EQ(input.unstamped, 1u) << input.topic;
}

TEST_F(StereoPairingTest, ResetForgetsWhatWaits) {
  addLeft(1.0);
  pairing_.reset();
  addRight(1.0);
  EXPECT_TRUE(pairs_.empty());
  addPair(1.5);
  EXPECT_EQ(pairs_, (Pairs{{1.5, 1.5}}));
}

TEST_F(StereoPairingTest, ResetForgetsThatTheClockWentBack) {
  addPair(10.0);
  addLeft(1.0);
  pairing_.reset();
  // These are of the time from which the clock went back, and would be left over from it.
  addRight(10.1);
  addLeft(10.1);
  EXPECT_EQ(pairs_, (Pairs{{10.0, 10.0}, {10.1, 10.1}}));
  EXPECT_EQ(pairing_.inputs()[2].late, 0u);
}

TEST_F(StereoPairingTest, ASecondJumpBackForgetsTheFirst) {
  addPair(20.0);
  addLeft(10.0);
  addLeft(1.0);
  // The right camera, of which nothing was heard between the jumps, is not waited for any more.
  addRight(20.1);
  EXPECT_EQ(pairing_.inputs()[2].late, 0u);
}

TEST_F(ApproximatePairingTest, PairsWithinMaxSkewWithoutWaitingForTheNext) {
  addLeft(1.0);
  addRight(1.004);
  EXPECT_EQ(pairs_, (Pairs{{1.0, 1.004}}));
}

TEST_F(ApproximatePairingTest, DoesNotPairBeyondMaxSkew) {
  for (int i = 0; i < 4; ++i) {
    addLeft(1.0 + 0.1 * i);
    addRight(1.05 + 0.1 * i);
  }
  EXPECT_TRUE(pairs_.empty());
}

TEST_F(ApproximatePairingTest, ALoopingBagKeepsPairing) {
  addLeft(10.0);
  addRight(10.001);
  addLeft(1.0);
  addRight(1.002);
  EXPECT_EQ(pairs_, (Pairs{{10.0, 10.001}, {1.0, 1.002}}));
}

}  // namespace
