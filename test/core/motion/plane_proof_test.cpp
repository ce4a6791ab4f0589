#include "motion/step/plane_proof.h"

#include <gtest/gtest.h>

namespace uav_landing {
namespace {

/// Corners in a row, those of the left part of a picture with contrast.
struct Scene {
  cv::Mat image{60, 400, CV_32FC1, cv::Scalar(100)};
  std::vector<TrackedCorner> corners;
  std::vector<TemporalMatch> matches;
  MotionEstimate estimate;

  /// grey: by which each second column is brighter, so half of it is 1 sigma in a window.
  void add(int count, float grey, int on_plane, int followed) {
    for (int i = 0; i < count; ++i) {
      const int u = 10 + 10 * static_cast<int>(corners.size());
      for (int column = u - 4; column <= u + 4; column += 2) image.col(column) += grey;
      TrackedCorner corner;
      corner.u = u;
      corner.v = 30;
      corners.push_back(corner);
      if (i >= followed) continue;
      TemporalMatch match;
      match.now = {u, 30};
      match.then = {u, 30};
      matches.push_back(match);
      estimate.inliers.push_back(i < on_plane ? 1 : 0);
    }
  }
  Failure doubt() const { return doubtOfPlane(image, corners, matches, estimate); }
};

TEST(PlaneProof, SevenInTenCornersOnOnePlaneAreEnough) {
  Scene scene;
  scene.add(20, 40, 14, 20);
  EXPECT_FALSE(scene.doubt()) << scene.doubt().message();
}

TEST(PlaneProof, FewerAreNotWhetherTheOthersMoveElsewhereOrAreNotFound) {
  for (const int followed : {13, 20}) {
    Scene scene;
    scene.add(20, 40, 13, followed);
    EXPECT_EQ(scene.doubt().message(),
              "plane_unproven: 13 of 20 corners move as on one plane, at least 70 % needed without stereo");
  }
}

TEST(PlaneProof, CornersOfNoiseSayNothing) {
  Scene scene;
  scene.add(10, 40, 10, 10);
  scene.add(20, 8, 0, 0);  // 4 grey levels
  EXPECT_FALSE(scene.doubt()) << scene.doubt().message();
  Scene seen;
  seen.add(10, 40, 10, 10);
  seen.add(20, 16, 0, 0);
  EXPECT_TRUE(seen.doubt());
}

TEST(PlaneProof, WithoutAnyCornerNothingIsShown) {
  Scene scene;
  EXPECT_TRUE(scene.doubt());
  scene.add(20, 4, 20, 20);
  EXPECT_TRUE(scene.doubt()) << "all of them noise";
}

TEST(PlaneProof, AFewCornersProveNothing) {
  Scene few, enough;
  few.add(9, 40, 9, 9);
  EXPECT_EQ(few.doubt().message(),
            "plane_unproven: 9 corners stand out from noise, at least 10 needed without stereo");
  enough.add(10, 40, 10, 10);
  EXPECT_FALSE(enough.doubt());
}

}  // namespace
}  // namespace uav_landing
