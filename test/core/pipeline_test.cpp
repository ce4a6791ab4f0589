#include "uav_landing/pipeline.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <string>

namespace uav_landing {
namespace {

constexpr int kWidth = 160, kHeight = 120;

CameraCalibration camera(double Tx) {
  CameraCalibration c;
  c.width = kWidth;
  c.height = kHeight;
  c.distortion_model = "plumb_bob";
  c.K << 140, 0, 80, 0, 140, 60, 0, 0, 1;
  c.R = Eigen::Matrix3d::Identity();
  c.P << 140, 0, 80, Tx, 0, 140, 60, 0, 0, 0, 1, 0;
  return c;
}

cv::Mat noise(int seed, cv::Size size = {kWidth, kHeight}) {
  cv::Mat image(size, CV_8UC1);
  cv::RNG(seed).fill(image, cv::RNG::UNIFORM, 0, 255);
  return image;
}

Pipeline create() { return Pipeline::create(camera(0), camera(-70), {}).value(); }

TEST(Pipeline, AnImageOfAnotherSizeIsAFailureOfEveryStageThatNamesItsSide) {
  const cv::Mat good = noise(1), small = noise(2, {kWidth, kHeight / 2});
  for (const std::string side : {"left", "right"}) {
    SCOPED_TRACE(side);
    Pipeline pipeline = create();
    pipeline.process(9.9, noise(3), noise(4));
    const Pipeline::Output& output =
        pipeline.process(10, side == "left" ? small : good, side == "left" ? good : small, 0.002);
    for (const Failure& failure : {output.stereo.failure, output.approach.failure, output.landing.failure}) {
      EXPECT_EQ(failure.reason, Reason::kInputInvalid);
      EXPECT_EQ(failure.detail.substr(0, side.size() + 1), side + " ");
    }
    EXPECT_EQ(output.stereo.stamp, 10);
    EXPECT_EQ(output.stereo.skew, 0.002);
    EXPECT_EQ(output.approach.stamp, 10);
    EXPECT_EQ(output.landing.stamp, 10);
    EXPECT_TRUE(output.stereo.points.empty()) << "those were of the pair before";
    EXPECT_FALSE(output.landing.valid());
    pipeline.process(10.1, noise(5), noise(6));
    EXPECT_NE(output.stereo.failure.reason, Reason::kInputInvalid) << "the next pair is good";
  }
}

TEST(Pipeline, RectifiesEachImageIntoItsOwn) {
  const cv::Mat left = noise(1), right = noise(2);
  Pipeline pipeline = create();
  const Pipeline::Output& output = pipeline.process(10, left, right);
  // These calibrations leave images as they are, but perhaps for their outermost pixels.
  const cv::Rect inside(2, 2, kWidth - 4, kHeight - 4);
  EXPECT_EQ(cv::norm(output.left(inside), left(inside), cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(output.right(inside), right(inside), cv::NORM_INF), 0);
}

TEST(Pipeline, TimesAreThoseOfTheStagesThatThisPairWentThrough) {
  const auto stages = [](const Pipeline::Output& output) {
    std::string names;
    for (const auto& [name, ms] : output.stages.parts()) names += name + " ";
    return names;
  };
  Pipeline pipeline = create();
  EXPECT_EQ(stages(pipeline.process(10, noise(1), noise(2))),
            "rectify stereo_depth approach_angle kalman_height ");
  EXPECT_EQ(stages(pipeline.process(10.1, noise(1, {8, 8}), noise(2))), "rectify kalman_height ");
}

}  // namespace
}  // namespace uav_landing
