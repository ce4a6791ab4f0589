#include "uav_landing/pipeline.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "support/approach_scene.h"

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

/// A camera of the scene's rig, that needs no rectification. baseline: m, of the right one.
CameraCalibration cameraOf(const StereoRig& rig, double cx, double baseline) {
  CameraCalibration c;
  c.width = rig.size.width;
  c.height = rig.size.height;
  c.distortion_model = "plumb_bob";
  c.K << rig.fx, 0, cx, 0, rig.fy, rig.cy, 0, 0, 1;
  c.R = Eigen::Matrix3d::Identity();
  c.P << rig.fx, 0, cx, -rig.fx * baseline, 0, rig.fy, rig.cy, 0, 0, 0, 1, 0;
  return c;
}

/// Last pair of an approach to painted lines whose outermost edges are 2.12 m apart.
Pipeline::Output approachOf(double known_width) {
  test::ApproachScene scene(7);
  scene.ground.contrast = 3;
  const StereoRig& rig = scene.rig;
  Parameters parameters;
  parameters.runway.width = known_width;
  parameters.runway.side_stripe_inset = 0.001;  // so that the width is that of the edges which show
  parameters.stereo_depth.search_at_once = true;
  Pipeline pipeline =
      Pipeline::create(cameraOf(rig, rig.cx, 0), cameraOf(rig, rig.cx_right, rig.baseline), parameters)
          .value();
  const auto path = test::straight(test::attitude(-8, 0, 0), 1.8, 1.4, 10);
  for (int i = 0; i < 5; ++i) {
    const double t = i * test::kPeriod;
    pipeline.process(t, scene.ground.left(rig, path(t)), scene.ground.right(rig, path(t)));
  }
  const double t = 5 * test::kPeriod;
  return pipeline.process(t, scene.ground.left(rig, path(t)), scene.ground.right(rig, path(t)));
}

bool failed(const LandingResult& landing, const std::string& name) {
  return std::any_of(landing.tests.begin(), landing.tests.end(),
                     [&](const TestResult& test) { return test.name == name && test.failed(); });
}

TEST(Pipeline, TheRunwaysWidthIsKnownToItsEdgesAndToTheHeight) {
  const Pipeline::Output known = approachOf(2.12), wide = approachOf(1.02 * 2.12), other = approachOf(3);
  ASSERT_FALSE(known.approach.runway.failure) << known.approach.runway.failure.message();
  EXPECT_FALSE(failed(known.landing, "runway_width"));
  EXPECT_TRUE(failed(other.landing, "runway_width")) << "edges of another width";
  EXPECT_NEAR(wide.landing.width_height / known.landing.width_height, 1.02, 1e-3);
}

/// An approach with noise in a part of the raw images, or none where the seed is 0, and whether that part is
/// seen.
struct Masked {
  double height, angle;
  int points = 0, points_in_area = 0;  // matched corners of all pairs
};

Masked approachWith(const std::string& mask, const cv::Rect& area, int seed) {
  test::ApproachScene scene(7);
  scene.ground.contrast = 3;
  const StereoRig& rig = scene.rig;
  Parameters parameters;
  parameters.rig.left_mask = parameters.rig.right_mask = mask;
  parameters.stereo_depth.search_at_once = true;
  Pipeline pipeline =
      Pipeline::create(cameraOf(rig, rig.cx, 0), cameraOf(rig, rig.cx_right, rig.baseline), parameters)
          .value();
  const auto path = test::straight(test::attitude(-8, 0, 0), 1.8, 1.4, 10);
  const cv::Mat own = noise(seed, area.size());
  const auto picture = [&](cv::Mat image) {
    if (seed != 0) own.copyTo(image(area));
    return image;
  };
  Masked result;
  for (int i = 0; i < 6; ++i) {
    const double t = i * test::kPeriod;
    const Pipeline::Output& output = pipeline.process(t, picture(scene.ground.left(rig, path(t))),
                                                      picture(scene.ground.right(rig, path(t))));
    result.height = output.landing.height;
    result.angle = output.landing.approach_angle;
    for (const StereoDepthResult::Point& point : output.stereo.points) {
      const double right = point.u - point.disparity - rig.principalOffset();
      ++result.points;
      result.points_in_area += area.contains(cv::Point(cvRound(point.u), cvRound(point.v))) ||
                               area.contains(cv::Point(cvRound(right), cvRound(point.v)));
    }
  }
  return result;
}

TEST(Pipeline, LooksAtNothingUnderTheMasks) {
  const cv::Rect nose(90, 150, 120, 90);
  cv::Mat mask(240, 320, CV_8UC1, cv::Scalar(255));
  mask(nose) = 0;
  const std::string file = testing::TempDir() + "pipeline_test_" + std::to_string(getpid()) + ".png";
  ASSERT_TRUE(cv::imwrite(file, mask));
  const Masked one = approachWith(file, nose, 100), other = approachWith(file, nose, 200);
  const Masked ground = approachWith(file, nose, 0), unmasked = approachWith("", nose, 0);
  std::remove(file.c_str());
  EXPECT_GT(one.points, 500);
  EXPECT_EQ(one.points_in_area, 0);
  EXPECT_EQ(ground.points_in_area, 0);
  EXPECT_GT(unmasked.points_in_area, 50) << "without masks they are there";
  // A search along a row may come upon the noise, and leaves the corner out then.
  EXPECT_NEAR(one.height, other.height, 2e-3);
  EXPECT_NEAR(one.angle, other.angle, 1e-3);
}

TEST(Pipeline, RefusesAMaskThatItCannotRead) {
  Parameters parameters;
  parameters.rig.left_mask = "/nowhere/nose.png";
  const Expected<Pipeline> pipeline = Pipeline::create(camera(0), camera(-70), parameters);
  ASSERT_FALSE(pipeline);
  EXPECT_EQ(pipeline.error().detail.find("rig/left_mask: /nowhere/nose.png: no such file"), 0U);
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
