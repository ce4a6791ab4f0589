#include "stereo/matching/corner_matcher.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "image/windows/corners.h"
#include "support/ground_renderer.h"
#include "uav_landing/stages/stereo_depth_stage.h"

namespace uav_landing {
namespace {

/// Another matcher: Shi-Tomasi corners and OpenCV's pyramidal Lucas-Kanade. It knows nothing of the plane but
/// where to begin.
class LucasKanade : public CornerMatcher {
 public:
  std::vector<cv::Point> detect(const StereoLevel& level, const PlaneVector& g, int count) override {
    std::vector<cv::Point> corners;
    cv::goodFeaturesToTrack(level.left, corners, count, 1e-4, 4, level.left_mask);
    return cornersOnGround(level, corners, g);
  }

  RowMatches match(const StereoLevel& level, const std::vector<cv::Point>& corners,
                   const PlaneVector& g) override {
    RowMatches found;
    if (corners.empty()) return found;
    cv::Mat left, right;
    level.left.convertTo(left, CV_8U);
    level.right.convertTo(right, CV_8U);
    std::vector<cv::Point2f> from, to;
    for (const cv::Point& corner : corners) {
      from.emplace_back(corner);
      to.emplace_back(corner.x - shiftAt(level.rig, g, corner), corner.y);
    }
    std::vector<uchar> status;
    std::vector<float> error;
    cv::calcOpticalFlowPyrLK(left, right, from, to, status, error, cv::Size(15, 15), 2,
                             {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 30, 0.005},
                             cv::OPTFLOW_USE_INITIAL_FLOW);
    for (size_t i = 0; i < corners.size(); ++i) {
      if (!status[i] || std::abs(to[i].y - from[i].y) > kOffRow) continue;
      const double disparity = from[i].x - to[i].x - level.rig.principalOffset();
      if (disparity > 0) found.samples.push_back({from[i].x, from[i].y, kStddev, disparity, {}});
    }
    found.across.resize(found.samples.size());
    return found;
  }

 private:
  static constexpr double kOffRow = 0.5, kStddev = 0.15;  // px

  static float shiftAt(const StereoRig& rig, const PlaneVector& g, const cv::Point& corner) {
    return static_cast<float>(g.disparity(rig, corner.x, corner.y) + rig.principalOffset());
  }
};

struct Scene {
  StereoRig rig = test::makeRig(320, 240, 0.65);
  RigModel model = test::makeModel(rig);
  test::GroundRenderer ground{1};
  StereoDepthParameters parameters;

  Scene() {
    ground.grain = 0.01;
    parameters.direct_refinement = false;  // it would hide what the matches are worth
    parameters.search_at_once = true;
  }
};

double errorOf(const Scene& scene, std::unique_ptr<CornerMatcher> matcher, const test::Pose& pose) {
  StereoDepthStage stage(scene.model, scene.parameters, std::move(matcher));
  const cv::Mat left = scene.ground.left(scene.rig, pose), right = scene.ground.right(scene.rig, pose);
  stage.process(0.95, left, right);  // searched; one that is followed is found by all corners
  const StereoDepthResult result = stage.process(1, left, right);
  EXPECT_FALSE(result.failure) << result.failure.message();
  EXPECT_GT(result.points.size(), 50U);
  return std::abs(result.plane.height() - pose.height()) / pose.height();
}

TEST(CornerMatcher, AnotherOneTakesThePlaceOfTheOwn) {
  const Scene scene;
  for (const double height : {1.0, 2.0, 4.0}) {
    const test::Pose pose = test::makePose(height, -8, 0);
    EXPECT_LT(errorOf(scene, makeRowMatcher(scene.parameters), pose), 0.005) << height;
    EXPECT_LT(errorOf(scene, std::make_unique<LucasKanade>(), pose), 0.02) << height;
  }
}

/// One that finds nothing.
class Blind : public CornerMatcher {
 public:
  std::vector<cv::Point> detect(const StereoLevel&, const PlaneVector&, int) override { return {}; }
  RowMatches match(const StereoLevel&, const std::vector<cv::Point>&, const PlaneVector&) override {
    return {};
  }
};

TEST(CornerMatcher, OneThatFindsNothingGivesNoPlane) {
  const Scene scene;
  StereoDepthStage stage(scene.model, scene.parameters, std::make_unique<Blind>());
  const test::Pose pose = test::makePose(2, -8, 0);
  const StereoDepthResult result =
      stage.process(1, scene.ground.left(scene.rig, pose), scene.ground.right(scene.rig, pose));
  EXPECT_TRUE(result.failure);
}

}  // namespace
}  // namespace uav_landing
