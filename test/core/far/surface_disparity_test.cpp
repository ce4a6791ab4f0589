#include "far/surface_disparity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "runway_picture.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;

/// A pair that looks at a runway, without noise, and what belongs to it.
class Pair {
 public:
  Pair() {
    picture_.size = {320, 240};
    picture_.noise = 0;
    left_ = picture_.render(pose);
    RunwayPose right = pose;
    right.position += pose.cameraFromRunway().transpose().col(0);  // a baseline of 1 m
    right_ = picture_.render(right);
    model_.rig = picture_.rig();
    model_.left_mask = model_.right_mask = cv::Mat(picture_.size, CV_8U, cv::Scalar(255));
  }

  /// scale: of the plane that is known roughly.
  std::optional<SurfaceDisparity> measure(const cv::Mat& left, const cv::Mat& right, double scale = 1,
                                          const RightCamera& camera = {}) const {
    GroundPlane about = planeOf(pose);
    about.g *= scale;
    const Corners corners = *cornersOf(pose, {picture_.width, picture_.length}, picture_.rig());
    return measureDisparity({left, right}, model_, camera, corners, about);
  }

  /// By the way from the camera to where the pixel's ray meets the ground.
  double disparityAt(const Eigen::Vector2d& pixel) const {
    const Eigen::Vector3d ray = picture_.rig().ray(pixel.x(), pixel.y());
    const double down = -(pose.cameraFromRunway().transpose() * ray).z();
    return picture_.focal * down / pose.position.z();
  }

  cv::Mat noisy(const cv::Mat& image, cv::RNG& random) const {
    cv::Mat noise(image.size(), CV_32F), sum;
    random.fill(noise, cv::RNG::NORMAL, 0, 2);
    cv::add(image, noise, sum, cv::noArray(), CV_8U);
    return sum;
  }

  const cv::Mat& left() const { return left_; }
  const cv::Mat& right() const { return right_; }

  RunwayPose pose{{-900, 6, 48}, 2 * kDegree, -3 * kDegree, 0.5 * kDegree};

 private:
  RunwayPicture picture_;
  RigModel model_;
  cv::Mat left_, right_;
};

TEST(SurfaceDisparity, OfARunwayIsFoundFromFarOff) {
  const Pair pair;
  for (const double scale : {0.7, 1.0, 1.4}) {
    const auto found = pair.measure(pair.left(), pair.right(), scale);
    ASSERT_TRUE(found) << scale;
    EXPECT_NEAR(found->value, pair.disparityAt(found->pixel), 0.02) << scale;
    EXPECT_LT(found->variance, 0.02 * 0.02);
  }
}

TEST(SurfaceDisparity, ErrorsAreAsLargeAsClaimed) {
  const Pair pair;
  cv::RNG random(3);
  constexpr int kSamples = 60;
  double squares = 0, claimed = 0;
  for (int i = 0; i < kSamples; ++i) {
    const auto found = pair.measure(pair.noisy(pair.left(), random), pair.noisy(pair.right(), random));
    ASSERT_TRUE(found);
    squares += std::pow(found->value - pair.disparityAt(found->pixel), 2) / kSamples;
    claimed += found->variance / kSamples;
  }
  EXPECT_LT(std::sqrt(squares), 0.05);
  EXPECT_GT(std::sqrt(squares / claimed), 0.5);
  EXPECT_LT(std::sqrt(squares / claimed), 1.3);
}

TEST(SurfaceDisparity, AnotherExposureOfTheRightCameraDoesNotMatter) {
  const Pair pair;
  cv::Mat other;
  pair.right().convertTo(other, CV_8U, 0.7, 30);
  const auto found = pair.measure(pair.left(), other);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->value, pair.disparityAt(found->pixel), 0.01);
}

TEST(SurfaceDisparity, IsLookedForInTheRowsWhereTheRightCameraHasThem) {
  const Pair pair;
  cv::Mat lower = pair.right().clone();  // by two rows
  pair.right().rowRange(0, 238).copyTo(lower.rowRange(2, 240));
  RigRotation rows;
  rows.w = {2 / 554.0, 0, 0};
  rows.covariance.setZero();
  const auto found = pair.measure(pair.left(), lower, 1, {rows, {}});
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->value, pair.disparityAt(found->pixel), 0.02);
  const auto level = pair.measure(pair.left(), lower);
  EXPECT_TRUE(!level || std::abs(level->value - found->value) > 0.02 ||
              level->variance > 4 * found->variance);
}

TEST(SurfaceDisparity, IsNotKnownWhereTheRightImageShowsSomethingElse) {
  const Pair pair;
  cv::RNG random(4);
  const cv::Mat black(pair.right().size(), CV_8U, cv::Scalar(0));
  EXPECT_FALSE(pair.measure(pair.left(), black));
  EXPECT_FALSE(pair.measure(pair.left(), pair.noisy(black, random)));
  EXPECT_FALSE(pair.measure(pair.left(), 255 - pair.right()));
  cv::Mat turned;
  cv::flip(pair.right(), turned, 0);
  EXPECT_FALSE(pair.measure(pair.left(), turned));
}

}  // namespace
}  // namespace uav_landing
