#include "stereo/surface/surface_variance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "support/refined_pair.h"

namespace uav_landing {
namespace {

using test::RefinedPair;

/// Ground that rises and falls about the plane, some 60 pixels from a rise to a fall. bumps: root mean square
/// of the heights, m.
void unlevel(RefinedPair& scene, double bumps) {
  cv::Mat columns(scene.right.size(), CV_32F), rows(scene.right.size(), CV_32F);
  for (int v = 0; v < rows.rows; ++v) {
    for (int u = 0; u < rows.cols; ++u) {
      const double height = 2 * bumps * std::sin(u / 20.0) * std::sin(v / 20.0);
      const double disparity = scene.truth.disparity(scene.rig, u, v);
      // What is higher by e is seen at the disparity of a plane nearer by e.
      const double more = disparity > 0 ? disparity * height / (scene.pose.height() - height) : 0;
      columns.at<float>(v, u) = static_cast<float>(u + more);
      rows.at<float>(v, u) = static_cast<float>(v);
    }
  }
  cv::remap(scene.right, scene.right, columns, rows, cv::INTER_CUBIC, cv::BORDER_REPLICATE);
}

/// Mean over scenes, as it is by chance less than zero in some; m^2.
double meanOverScenes(double contrast, double noise, double bumps) {
  constexpr unsigned kScenes = 16;
  double sum = 0;
  for (unsigned scene = 0; scene < kScenes; ++scene) {
    RefinedPair pair(40 + scene);
    pair.ground.contrast = contrast;
    pair.render({1, 0, noise}, {1, 0, noise});
    if (bumps > 0) unlevel(pair, bumps);
    DirectRefinement direct(pair.model, 4);
    const Expected<PlaneFit> fit =
        direct.refine(pair.left, pair.right, {pair.truth, pair.rows}, test::groundLimits(), 0);
    EXPECT_TRUE(fit) << fit.error().message();
    if (fit) sum += surfaceVariance(pair.rig, direct.samples(), *fit, 1);
  }
  return sum / kScenes;
}

// From a height of 4 m; contrast and noise in grey levels: clear, noisy, and texture that is hardly more than
// noise.
TEST(SurfaceVarianceOfBlocks, IsNoneOfFlatGround) {
  EXPECT_NEAR(meanOverScenes(14, 1, 0), 0, std::pow(0.003, 2));
  EXPECT_NEAR(meanOverScenes(14, 4, 0), 0, std::pow(0.006, 2));
  EXPECT_NEAR(meanOverScenes(4, 5, 0), 0, std::pow(0.013, 2));
}

TEST(SurfaceVarianceOfBlocks, IsThatOfUnevenGround) {
  EXPECT_NEAR(std::sqrt(meanOverScenes(14, 1, 0.02)), 0.02, 0.007);
  EXPECT_NEAR(std::sqrt(meanOverScenes(14, 1, 0.04)), 0.04, 0.014);
  EXPECT_NEAR(std::sqrt(meanOverScenes(4, 5, 0.04)), 0.04, 0.014);
}

}  // namespace
}  // namespace uav_landing
