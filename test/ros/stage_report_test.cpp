#include "stage_report.h"

#include <gtest/gtest.h>

#include <limits>
#include <map>

namespace uav_landing {
namespace {

using diagnostic_msgs::DiagnosticStatus;

constexpr double kLongAgo = 1e6;  // s

class StageReportTest : public testing::Test {
 protected:
  static void SetUpTestSuite() { ros::Time::init(); }

  /// What is published now.
  DiagnosticStatus told(const std::vector<InputWatch::Input>& inputs = {},
                        std::optional<double> subscribed = kLongAgo) {
    diagnostic_updater::DiagnosticStatusWrapper status;
    report_.write(status, inputs, subscribed);
    values_.clear();
    for (const auto& value : status.values) values_[value.key] = value.value;
    return status;
  }

  StageReport report_;
  std::map<std::string, std::string> values_;  // as told last
};

TEST_F(StageReportTest, CountsEachKindOnItsOwnSinceTheStart) {
  for (const char* reason : {"", "", "no_plane", ""}) report_.served(ros::Time::now(), 1, reason);
  report_.dropped();
  report_.dropped(2);
  report_.refused("left: no image");
  report_.refused("left: no image");
  told();
  EXPECT_EQ(values_["pairs served"], "4");
  EXPECT_EQ(values_["pairs without a result, of late"], "1");
  EXPECT_EQ(values_["pairs dropped"], "3");
  EXPECT_EQ(values_["inputs refused"], "2");
  report_.served(ros::Time::now(), 1, "");
  told();
  EXPECT_EQ(values_["pairs served"], "5");
  EXPECT_EQ(values_["pairs without a result, of late"], "0");
  EXPECT_EQ(values_["pairs dropped"], "3");
  EXPECT_EQ(values_["inputs refused"], "2");
}

TEST_F(StageReportTest, TimesAreMeansOfThePairsSinceTheLastOne) {
  report_.served(ros::Time::now() - ros::Duration(1), 2, "");
  report_.served(ros::Time::now() - ros::Duration(3), 6, "");
  told();
  EXPECT_EQ(values_["compute time"], "4.00 ms");
  EXPECT_NEAR(std::stod(values_["latency behind the image stamp"]), 2000, 50);
  report_.served(ros::Time::now(), 1, "");
  told();
  EXPECT_EQ(values_["compute time"], "1.00 ms");
  EXPECT_LT(std::stod(values_["latency behind the image stamp"]), 50);
}

TEST_F(StageReportTest, AStampAheadOfTheClockIsNoLatency) {
  report_.served(ros::Time::now() + ros::Duration(10), 1, "");
  told();
  const std::string text = values_["latency behind the image stamp"], begin = "unknown: the stamps are ";
  EXPECT_EQ(text.rfind(begin, 0), 0u) << text;
  EXPECT_NEAR(std::stod(text.substr(begin.size())), 10000, 50);
}

TEST_F(StageReportTest, ATopicWithFewerMessagesIsNamedAndNotCalledSlow) {
  InputWatch::Input image, info;
  image.topic = "/left/image_raw";
  info.topic = "/left/camera_info";
  image.received = 20;
  image.paired = image.dropped = info.received = info.paired = 10;
  report_.served(ros::Time::now(), 1, "");
  report_.dropped();
  const DiagnosticStatus status = told({image, info});
  EXPECT_EQ(status.message, "10 of 20 stamps have no message on /left/camera_info");
  EXPECT_EQ(status.level, DiagnosticStatus::WARN);
  report_.served(ros::Time::now(), 1, "");
  EXPECT_EQ(told({image, info}).message, "running");
}

TEST_F(StageReportTest, SaysTheWorstOfWhatHappenedAndForgetsItAfterwards) {
  report_.served(ros::Time::now(), 1, "");
  DiagnosticStatus status = told();
  EXPECT_EQ(status.message, "running");
  EXPECT_EQ(status.level, DiagnosticStatus::OK);

  report_.served(ros::Time::now(), 1, "");
  report_.dropped();
  status = told();
  EXPECT_EQ(status.message, "too slow: pairs are dropped");
  EXPECT_EQ(status.level, DiagnosticStatus::WARN);

  report_.served(ros::Time::now(), 1, "no_plane: 3 of 20");
  report_.dropped();
  status = told();
  EXPECT_EQ(status.message, "no_plane: 3 of 20");
  EXPECT_EQ(status.level, DiagnosticStatus::WARN);

  report_.served(ros::Time::now(), 1, "no_plane: 3 of 20");
  report_.refused("left: encoding");
  status = told();
  EXPECT_EQ(status.message, "left: encoding");
  EXPECT_EQ(status.level, DiagnosticStatus::ERROR);

  report_.served(ros::Time::now(), 1, "");
  EXPECT_EQ(told().message, "running");
}

TEST_F(StageReportTest, WithoutAPairItNamesTheInputThatIsSilent) {
  InputWatch::Input left{"left"}, right{"right"};
  left.received = 5;
  DiagnosticStatus status = told({left, right});
  EXPECT_EQ(status.message, "no message on right");
  EXPECT_EQ(status.level, DiagnosticStatus::ERROR);
  right.received = 1;
  EXPECT_EQ(told({left, right}).message, "no message on left") << "five messages came before";
  left.received = 6;
  right.received = 2;
  EXPECT_EQ(told({left, right}).message, "nothing pairs up");
  EXPECT_EQ(told({left, right}).message, "no message on left, right");
  status = told({left, right}, 0);
  EXPECT_EQ(status.message, "has just subscribed");
  EXPECT_EQ(status.level, DiagnosticStatus::OK);
  status = told({left, right}, std::nullopt);
  EXPECT_EQ(status.message, "idle: nobody subscribes");
  EXPECT_EQ(status.level, DiagnosticStatus::OK);
}

TEST_F(StageReportTest, EachCountOfAnInputIsItsOwn) {
  InputWatch::Input left{"left"};
  left.received = 50;
  left.paired = 30;
  left.dropped = 20;
  left.late = 10;
  told({left});
  EXPECT_NE(values_["left"].find("50 received, 30 paired, 20 dropped, 10 of them late"), std::string::npos)
      << values_["left"];
}

TEST_F(StageReportTest, AWarningIsNewsOnceAndIsToldAsLongAsItHolds) {
  EXPECT_EQ(report_.warned({"odd baseline"}), std::vector<std::string>{"odd baseline"});
  EXPECT_TRUE(report_.warned({"odd baseline"}).empty());
  for (int i = 0; i < 2; ++i) {
    report_.served(ros::Time::now(), 1, "");
    const DiagnosticStatus status = told();
    EXPECT_EQ(status.message, "odd baseline");
    EXPECT_EQ(status.level, DiagnosticStatus::WARN);
  }
  EXPECT_NE(told({}, std::nullopt).message, "odd baseline") << "nobody subscribes";
  EXPECT_TRUE(report_.warned({}).empty());
  report_.served(ros::Time::now(), 1, "");
  EXPECT_EQ(told().message, "running");
  EXPECT_EQ(report_.warned({"odd baseline"}), std::vector<std::string>{"odd baseline"}) << "again";
}

}  // namespace
}  // namespace uav_landing
