#include <std_srvs/Empty.h>
#include <sys/resource.h>

#include <algorithm>

#include "nodelets/nodelet_fixture.h"
#include "nodelets/nodelet_test_main.h"
#include "nodelets/stereo_scene.h"

using namespace uav_landing::test;

namespace {

class RectifyNodeletTest : public NodeletTest {
 protected:
  /// Loads the nodelet and subscribes to its output.
  void start() {
    setParameter("rectify", "complaint_period", 0.2);
    load("rectify");
    left_ = std::make_unique<Listener<sensor_msgs::Image>>("/uav_landing/left/image_rect");
    right_ = std::make_unique<Listener<sensor_msgs::Image>>("/uav_landing/right/image_rect");
    ASSERT_TRUE(
        eventually([&] { return cameras_.connected() && left_->connected() && right_->connected(); }));
  }

  /// As OtherTopics has them.
  void nameTopics() {
    setParameter("rectify", "left_image", std::string("/cam0/image"));
    setParameter("rectify", "left_info", std::string("/cam0/info"));
    setParameter("rectify", "right_image", std::string("/cam1/image"));
    setParameter("rectify", "right_info", std::string("/cam1/info"));
  }

  StereoScene scene_;
  PairPublisher cameras_{PairPublisher::kRaw};
  std::unique_ptr<Listener<sensor_msgs::Image>> left_, right_;
};

TEST_F(RectifyNodeletTest, SubscribesOnlyWhileSomebodyListens) {
  load("rectify");
  EXPECT_TRUE(cameras_.unconnected());
  {
    Listener<sensor_msgs::CameraInfo> info("/uav_landing/right/camera_info");
    EXPECT_TRUE(eventually([&] { return cameras_.connected(); }));
  }
  EXPECT_TRUE(eventually([&] { return cameras_.unconnected(); }));
}

TEST_F(RectifyNodeletTest, PublishesBothImagesInfosAndTheSkewWithTheLeftStamp) {
  start();
  Listener<sensor_msgs::CameraInfo> info("/uav_landing/right/camera_info");
  Listener<sensor_msgs::TimeReference> time("/uav_landing/right/time_reference");
  ASSERT_TRUE(eventually([&] { return info.connected() && time.connected(); }));
  cameras_.publish(scene_, 0);
  ASSERT_TRUE(left_->waitFor(1) && right_->waitFor(1) && info.waitFor(1) && time.waitFor(1));
  const ros::Time stamp = PairPublisher::stampOf(0);
  EXPECT_EQ(left_->messages()[0]->header.stamp, stamp);
  EXPECT_EQ(left_->messages()[0]->header.frame_id, "left_optical");
  EXPECT_EQ(right_->messages()[0]->header.stamp, stamp);
  EXPECT_EQ(right_->messages()[0]->header.frame_id, "right_optical");
  EXPECT_EQ(info.messages()[0]->P, scene_.info(true)->P);
  EXPECT_EQ(time.messages()[0]->time_ref, stamp);
  EXPECT_EQ(left_->messages()[0]->data, scene_.image(0, false)->data) << "ideal cameras: nothing to rectify";
}

/// What cameras that hang show: the picture turned by 180 degrees.
sensor_msgs::ImagePtr turned(sensor_msgs::ImagePtr image) {
  std::reverse(image->data.begin(), image->data.end());
  return image;
}

TEST_F(RectifyNodeletTest, OfARigUpsideDownComesThePairThatStandsUpright) {
  ros::param::set("/uav_landing/rig/upside_down", true);
  start();
  Listener<sensor_msgs::CameraInfo> left_info("/uav_landing/left/camera_info"),
      right_info("/uav_landing/right/camera_info");
  ASSERT_TRUE(eventually([&] { return left_info.connected() && right_info.connected(); }));
  const auto infoOf = [&](bool right) {
    auto info = scene_.info(right);
    info->K[2] = info->P[2] = scene_.width - 1 - 0.5 * scene_.width;
    info->K[5] = info->P[6] = scene_.height - 1 - 0.5 * scene_.height;
    return info;
  };
  cameras_.publishLeft(ros::Time(1000), turned(scene_.image(0, true)), infoOf(false));
  cameras_.publishRight(ros::Time(1000), turned(scene_.image(0, false)), infoOf(true));
  ASSERT_TRUE(left_->waitFor(1) && right_->waitFor(1) && left_info.waitFor(1) && right_info.waitFor(1));
  EXPECT_EQ(left_->messages()[0]->data, scene_.image(0, false)->data);
  EXPECT_EQ(right_->messages()[0]->data, scene_.image(0, true)->data);
  EXPECT_EQ(left_->messages()[0]->header.frame_id, "right_optical") << "the camera that is on the left";
  const sensor_msgs::CameraInfo &left = *left_info.messages()[0], &right = *right_info.messages()[0];
  EXPECT_EQ(left.P, scene_.info(false)->P);
  EXPECT_NEAR(right.P[3], scene_.info(true)->P[3], 1e-9);
  EXPECT_EQ(left.R[0], -1) << "from the camera as it hangs to the image";
  EXPECT_EQ(left.R[8], 1);
}

TEST_F(RectifyNodeletTest, OfARigUpsideDownThatIsNoPairNothingComes) {
  ros::param::set("/uav_landing/rig/upside_down", true);
  start();
  auto info = scene_.info(true);
  info->P[3] = 0;
  cameras_.publishLeft(ros::Time(1000), scene_.image(0, false), scene_.info(false));
  cameras_.publishRight(ros::Time(1000), scene_.image(0, true), info);
  ASSERT_TRUE(logged("camera_info: right P[3]: 0, expected -P[0] times the baseline")) << wholeLog();
  cameras_.publishLeft(ros::Time(1001), scene_.image(0.1, false), scene_.info(false));
  cameras_.publishRight(ros::Time(1001), scene_.image(0.1, true), scene_.info(true));
  ASSERT_TRUE(left_->waitFor(1));
  EXPECT_EQ(left_->messages()[0]->header.stamp, ros::Time(1001));
}

/// With 16 bits, values times this.
sensor_msgs::ImagePtr deep(sensor_msgs::ImagePtr image, int times) {
  std::vector<uint8_t> data;
  for (const uint8_t grey : image->data) {  // the last byte first
    data.push_back(static_cast<uint8_t>((times * grey) & 255));
    data.push_back(static_cast<uint8_t>((times * grey) >> 8));
  }
  image->data = data;
  image->step *= 2;
  image->encoding = "mono16";
  return image;
}

TEST_F(RectifyNodeletTest, FindsTheBitsAnewAfterAResetAndWhenTheClockIsSetBack) {
  start();
  const auto publish = [&](double stamp, int times) {
    const double t = stamp == 1001 ? 0.1 : 0;  // no picture comes twice in a row
    cameras_.publishLeft(ros::Time(stamp), deep(scene_.image(t, false), times), scene_.info(false));
    cameras_.publishRight(ros::Time(stamp), deep(scene_.image(t, true), times), scene_.info(true));
  };
  publish(1000, 64);
  ASSERT_TRUE(logged("values 0 to 16383 of 65535")) << wholeLog();
  publish(1001, 16);
  ASSERT_TRUE(left_->waitFor(2));
  EXPECT_EQ(wholeLog().find("values 0 to 4095"), std::string::npos) << wholeLog();
  std_srvs::Empty nothing;
  ASSERT_TRUE(ros::service::call("/uav_landing/rectify/reset", nothing));
  publish(1002, 16);
  EXPECT_TRUE(logged("values 0 to 4095 of 65535")) << wholeLog();
  publish(900, 4);
  EXPECT_TRUE(logged("values 0 to 1023 of 65535")) << wholeLog();
}

TEST_F(RectifyNodeletTest, StretchesTheBitsThatAreUsedAndSaysSo) {
  start();
  cameras_.publishLeft(ros::Time(1000), deep(scene_.image(0, false), 4), scene_.info(false));
  cameras_.publishRight(ros::Time(1000), deep(scene_.image(0, true), 4), scene_.info(true));
  ASSERT_TRUE(left_->waitFor(1));
  const auto expected = scene_.image(0, false)->data, data = left_->messages()[0]->data;
  for (size_t i = 0; i < expected.size(); i += 97) EXPECT_NEAR(data[i], expected[i], 1) << i;
  EXPECT_TRUE(logged("values 0 to 1023 of 65535 become black to white")) << wholeLog();
}

TEST_F(RectifyNodeletTest, AnApproximatePairCarriesTheLeftStampAndReportsTheSkew) {
  setParameter("rectify", "approximate_sync", true);
  start();
  Listener<sensor_msgs::TimeReference> time("/uav_landing/right/time_reference");
  ASSERT_TRUE(eventually([&] { return time.connected(); }));
  cameras_.publishLeft(ros::Time(1000), scene_.image(0, false), scene_.info(false));
  cameras_.publishRight(ros::Time(1000.004), scene_.image(0, true), scene_.info(true));
  ASSERT_TRUE(right_->waitFor(1) && time.waitFor(1));
  EXPECT_EQ(right_->messages()[0]->header.stamp, ros::Time(1000));
  EXPECT_NEAR((time.messages()[0]->time_ref - ros::Time(1000)).toSec(), 0.004, 1e-9);
}

TEST_F(RectifyNodeletTest, TheMissingRightCameraIsNamed) {
  start();
  cameras_.publishLeft(ros::Time(1000), scene_.blank(0), scene_.info(false));
  EXPECT_TRUE(eventually([&] {
    cameras_.publishLeft(ros::Time::now(), scene_.blank(0), scene_.info(false));
    return wholeLog().find("no message on /stereo/right/image_raw, /stereo/right/camera_info") !=
           std::string::npos;
  })) << wholeLog();
}

TEST_F(RectifyNodeletTest, WhatWaitedIsForgottenWhenNobodyListensAnyMore) {
  setParameter("rectify", "drop_frames", false);
  start();
  cameras_.publishLeft(ros::Time(1000), scene_.blank(0), scene_.info(false));
  // It is there, and waits for the right image.
  ASSERT_TRUE(logged("no message on /stereo/right/image_raw, /stereo/right/camera_info")) << wholeLog();
  left_.reset();
  right_.reset();
  ASSERT_TRUE(eventually([&] { return cameras_.unconnected(); }));
  left_ = std::make_unique<Listener<sensor_msgs::Image>>("/uav_landing/left/image_rect");
  right_ = std::make_unique<Listener<sensor_msgs::Image>>("/uav_landing/right/image_rect");
  ASSERT_TRUE(eventually([&] { return cameras_.connected() && left_->connected() && right_->connected(); }));
  cameras_.publishRight(ros::Time(1000), scene_.blank(0), scene_.info(true));
  cameras_.publishLeft(ros::Time(1001), scene_.blank(0), scene_.info(false));
  cameras_.publishRight(ros::Time(1001), scene_.blank(0), scene_.info(true));
  ASSERT_TRUE(left_->waitFor(1));
  EXPECT_EQ(left_->messages()[0]->header.stamp, ros::Time(1001));
}

TEST_F(RectifyNodeletTest, StampsThatNeverMatchAreShown) {
  start();
  double t = 0;
  EXPECT_TRUE(eventually([&] {
    cameras_.publishLeft(PairPublisher::stampOf(t), scene_.blank(0), scene_.info(false));
    cameras_.publishRight(PairPublisher::stampOf(t + 0.003), scene_.blank(0), scene_.info(true));
    t += 0.1;
    return wholeLog().find("the stamps do not match (approximate_sync") != std::string::npos;
  })) << wholeLog();
}

TEST_F(RectifyNodeletTest, ABagThatLoopsIsFollowed) {
  start();
  cameras_.publish(scene_, 5);
  ASSERT_TRUE(left_->waitFor(1));
  cameras_.publish(scene_, 0);
  cameras_.publish(scene_, 0.1);
  ASSERT_TRUE(
      left_->waitFor([](const auto& image) { return image.header.stamp == PairPublisher::stampOf(0.1); }));
}

TEST_F(RectifyNodeletTest, ProcessesAllInOrderWhenToldNotToDrop) {
  setParameter("rectify", "drop_frames", false);
  start();
  for (int i = 0; i < 50; ++i) cameras_.publishUniform(scene_, 0.1 * i, 100);
  ASSERT_TRUE(right_->waitFor(50));
  const auto images = right_->messages();
  for (size_t i = 0; i < 50; ++i)
    EXPECT_EQ(images[i]->header.stamp, PairPublisher::stampOf(0.1 * static_cast<double>(i)));
}

TEST_F(RectifyNodeletTest, AnImageOfAnotherSizeIsRefusedByName) {
  start();
  StereoScene larger = scene_;
  larger.width = 400;
  cameras_.publishLeft(ros::Time(1000), larger.blank(0), scene_.info(false));
  cameras_.publishRight(ros::Time(1000), scene_.blank(0), scene_.info(true));
  EXPECT_TRUE(logged("/stereo/left/image_raw: width, height: 400x240, but camera_info announces 320x240"));
  cameras_.publish(scene_, 1);
  EXPECT_TRUE(left_->waitFor(1)) << "goes on with the next";
}

TEST_F(RectifyNodeletTest, ACameraInfoOfAHugeImageTakesNoMemory) {
  start();
  const auto kilobytes = [] {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;
  };
  const auto before = kilobytes();
  StereoScene huge = scene_;
  huge.width = huge.height = 16000;
  cameras_.publishLeft(ros::Time(1000), scene_.blank(0), huge.info(false));
  cameras_.publishRight(ros::Time(1000), scene_.blank(0), huge.info(true));
  EXPECT_TRUE(logged("width, height: 320x240, but camera_info announces 16000x16000")) << wholeLog();
  // Its maps would take 14 bytes a pixel.
  EXPECT_LT(kilobytes() - before, 500 * 1024);
}

TEST_F(RectifyNodeletTest, AnUnknownEncodingIsRefusedByName) {
  start();
  const auto image = scene_.blank(0);
  image->encoding = "16SC1";
  cameras_.publishLeft(ros::Time(1000), image, scene_.info(false));
  cameras_.publishRight(ros::Time(1000), scene_.blank(0), scene_.info(true));
  EXPECT_TRUE(logged("/stereo/left/image_raw: encoding: \"16SC1\" is not one of"));
}

TEST_F(RectifyNodeletTest, TruncatedDataIsRefusedByName) {
  start();
  const auto image = scene_.blank(0);
  image->data.resize(1000);
  cameras_.publishLeft(ros::Time(1000), scene_.blank(0), scene_.info(false));
  cameras_.publishRight(ros::Time(1000), image, scene_.info(true));
  EXPECT_TRUE(logged("/stereo/right/image_raw: data: 1000 bytes"));
}

TEST_F(RectifyNodeletTest, ACameraInfoOfZerosIsRefusedByName) {
  start();
  cameras_.publishLeft(ros::Time(1000), scene_.blank(0), boost::make_shared<sensor_msgs::CameraInfo>());
  cameras_.publishRight(ros::Time(1000), scene_.blank(0), scene_.info(true));
  EXPECT_TRUE(logged("camera_info: left width: 0, expected 1 to 16384 pixels (/stereo/left/camera_info)"))
      << wholeLog();
  cameras_.publish(scene_, 1);
  EXPECT_TRUE(left_->waitFor(1)) << "goes on with the next";
}

TEST_F(RectifyNodeletTest, AnUncalibratedCameraIsRefusedAsInTheListOfTroubles) {
  start();
  const auto info = boost::make_shared<sensor_msgs::CameraInfo>(*scene_.info(true));
  info->K.fill(0);
  cameras_.publishLeft(ros::Time(1000), scene_.blank(0), scene_.info(false));
  cameras_.publishRight(ros::Time(1000), scene_.blank(0), info);
  EXPECT_TRUE(logged("camera_info: right K[0]: 0, expected a positive focal length in pixels")) << wholeLog();
}

TEST_F(RectifyNodeletTest, ACameraInfoOfAnotherPictureSizeIsRefusedInLogAndDiagnostics) {
  setParameter("rectify", "diagnostic_period", 0.2);
  const Diagnostics diagnostics;
  start();
  const auto wrong = scene_.info(true);
  wrong->K[2] = 320;
  const std::string message =
      "camera_info: right K[2]: 320, expected 96 to 224 in an image 320 px wide: is this the calibration of "
      "another image size? If the image is cropped off the middle, raise rig/max_principal_point_offset "
      "(/stereo/right/camera_info)";
  double t = 0;
  EXPECT_TRUE(eventually([&] {
    t += 0.1;
    cameras_.publishLeft(PairPublisher::stampOf(t), scene_.blank(0), scene_.info(false));
    cameras_.publishRight(PairPublisher::stampOf(t), scene_.blank(0), wrong);
    return diagnostics.said("rectify", diagnostic_msgs::DiagnosticStatus::ERROR, message);
  }));
  EXPECT_TRUE(logged("/uav_landing/rectify: " + message)) << wholeLog();
  EXPECT_TRUE(left_->messages().empty());
  cameras_.publish(scene_, t + 0.1);
  EXPECT_TRUE(left_->waitFor(1)) << "goes on with the next";
}

TEST_F(RectifyNodeletTest, APictureCroppedOffTheMiddleIsLetThroughByTheSharedParameter) {
  setParameter("rig", "max_principal_point_offset", 0.6);
  start();
  scene_.calibrated_scale = 2;
  cameras_.publish(scene_, 0);
  EXPECT_TRUE(left_->waitFor(1)) << wholeLog();
}

TEST_F(RectifyNodeletTest, ACameraInfoThatChangesIsFollowed) {
  start();
  cameras_.publish(scene_, 0);
  ASSERT_TRUE(left_->waitFor(1));
  StereoScene smaller = scene_;
  smaller.width = 160;
  cameras_.publish(smaller, 0.1);
  ASSERT_TRUE(left_->waitFor(2));
  EXPECT_EQ(left_->messages()[1]->width, 160u);
  EXPECT_TRUE(logged("/stereo/left/image_raw: the camera_info changed"));
}

TEST_F(RectifyNodeletTest, BadParametersRefuseToLoadByName) {
  setParameter("rectify", "max_skew", 7.0);
  expectRefusal("rectify", "rectify/max_skew: 7 is out of range");
  ros::param::del("/uav_landing/rectify");
  setParameter("rectify", "que_size", 5);
  expectRefusal("rectify", "rectify/que_size: no such parameter; did you mean queue_size?");
  ros::param::del("/uav_landing/rectify");
  setParameter("rectify", "drop_frames", std::string("perhaps"));
  expectRefusal("rectify", "rectify/drop_frames: 'perhaps' is not true or false");
  EXPECT_TRUE(cameras_.unconnected());
}

TEST_F(RectifyNodeletTest, AnotherCameraNamespaceIsAParameter) {
  setParameter("rectify", "camera", std::string("/rig"));
  load("rectify");
  Listener<sensor_msgs::Image> listener("/uav_landing/left/image_rect");
  const ros::Publisher raw = handle_.advertise<sensor_msgs::Image>("/rig/left/image_raw", 1);
  EXPECT_TRUE(eventually([&] { return raw.getNumSubscribers() > 0; }));
}

/// Publishers of a rig whose topics have names of their own, and whether somebody subscribed all.
struct OtherTopics {
  explicit OtherTopics(ros::NodeHandle& handle)
      : left(handle.advertise<sensor_msgs::Image>("/cam0/image", 1)),
        right(handle.advertise<sensor_msgs::Image>("/cam1/image", 1)),
        left_info(handle.advertise<sensor_msgs::CameraInfo>("/cam0/info", 1)),
        right_info(handle.advertise<sensor_msgs::CameraInfo>("/cam1/info", 1)) {}
  bool connected() const {
    return left.getNumSubscribers() > 0 && right.getNumSubscribers() > 0 &&
           left_info.getNumSubscribers() > 0 && right_info.getNumSubscribers() > 0;
  }
  ros::Publisher left, right, left_info, right_info;
};

TEST_F(RectifyNodeletTest, NamedTopicsStayThoseOfTheirCameraWhereTheRigIsUpsideDown) {
  ros::param::set("/uav_landing/rig/upside_down", true);
  nameTopics();
  load("rectify");
  const OtherTopics topics(handle_);
  Listener<sensor_msgs::Image> listener("/uav_landing/left/image_rect");
  ASSERT_TRUE(eventually([&] { return topics.connected() && listener.connected(); }));
  for (const bool right : {false, true}) {
    const auto image = turned(scene_.image(0, !right));
    const auto info = scene_.info(right);
    info->K[2] = info->P[2] = scene_.width - 1 - 0.5 * scene_.width;
    info->K[5] = info->P[6] = scene_.height - 1 - 0.5 * scene_.height;
    info->header.stamp = image->header.stamp = ros::Time(1000);
    (right ? topics.right_info : topics.left_info).publish(info);
    (right ? topics.right : topics.left).publish(image);
  }
  ASSERT_TRUE(listener.waitFor(1)) << wholeLog();
  EXPECT_EQ(listener.messages()[0]->data, scene_.image(0, false)->data);
}

TEST_F(RectifyNodeletTest, EachTopicMayHaveANameOfItsOwn) {
  nameTopics();
  load("rectify");
  const OtherTopics topics(handle_);
  Listener<sensor_msgs::Image> listener("/uav_landing/left/image_rect");
  EXPECT_TRUE(eventually([&] { return topics.connected(); }));
}

TEST_F(RectifyNodeletTest, ARemapGivesATopicAnotherName) {
  ASSERT_TRUE(loader_.load("/uav_landing/rectify", "uav_landing/rectify",
                           {{"/stereo/left/image_raw", "/cam0/image"},
                            {"/stereo/left/camera_info", "/cam0/info"},
                            {"/stereo/right/image_raw", "/cam1/image"},
                            {"/stereo/right/camera_info", "/cam1/info"}},
                           {}));
  const OtherTopics topics(handle_);
  Listener<sensor_msgs::Image> listener("/uav_landing/left/image_rect");
  EXPECT_TRUE(eventually([&] { return topics.connected(); }));
}

TEST_F(RectifyNodeletTest, APairThatComesTwiceIsServedOnce) {
  setParameter("rectify", "drop_frames", false);
  start();
  for (int i = 0; i < 10; ++i) {
    cameras_.publishLeft(PairPublisher::stampOf(0.1 * i), scene_.image(0.2 * (i / 2), false),
                         scene_.info(false));
    cameras_.publishRight(PairPublisher::stampOf(0.1 * i), scene_.image(0.2 * (i / 2), true),
                          scene_.info(true));
  }
  ASSERT_TRUE(left_->waitFor(5));
  ASSERT_TRUE(logged("each pair of images comes 2 times, bit by bit the same under new stamps"))
      << wholeLog();
  std::vector<ros::Time> stamps, expected;
  for (const auto& image : left_->messages()) stamps.push_back(image->header.stamp);
  for (int i = 0; i < 5; ++i) expected.push_back(PairPublisher::stampOf(0.2 * i));
  EXPECT_EQ(stamps, expected);
}

TEST_F(RectifyNodeletTest, ATopicThatComesMoreSeldomIsNamed) {
  start();
  double t = 0;
  EXPECT_TRUE(eventually([&] {
    // No more than the queue takes, as the topics come on connections of their own.
    t += 0.1;
    cameras_.publishRight(PairPublisher::stampOf(t), scene_.blank(0), scene_.info(true));
    cameras_.publishLeft(PairPublisher::stampOf(t), scene_.blank(0), scene_.info(false));
    cameras_.publishLeft(PairPublisher::stampOf(t + 0.05), scene_.blank(0), scene_.info(false));
    return wholeLog().find("stamps have no message on /stereo/right/image_raw, /stereo/right/camera_info") !=
           std::string::npos;
  })) << wholeLog();
}

TEST_F(RectifyNodeletTest, CanBeUnloadedAtAnyTime) {
  start();
  for (int i = 0; i < 20; ++i) cameras_.publishUniform(scene_, 0.1 * i, 100);
  unload("rectify");
  EXPECT_TRUE(eventually([&] { return cameras_.unconnected(); }));
}

}  // namespace

UAV_LANDING_NODELET_TEST_MAIN("rectify_nodelet_test")
