#include "motion/path/image_errors.h"

#include <gtest/gtest.h>

#include <cmath>

namespace uav_landing {
namespace {

TEST(ImageErrors, AStepHasThatOfItsLastImageMinusThatOfItsFirst) {
  ImageErrors errors;
  errors.add(100.0, 100.1);
  errors.add(100.1, 100.2);
  errors.add(100.2, 100.4);
  errors.add(100.0, 100.4);  // the chord
  const Eigen::MatrixXd covariance = errors.covariances().single;
  Eigen::Matrix4d expected;
  expected << 200, -100, 0, 25,  // 2 / 0.1^2; -1 / 0.1^2; 1 / (0.1 0.4)
      -100, 200, -50, 0,         // -1 / (0.1 0.2)
      0, -50, 50, 12.5,          // 2 / 0.2^2; 1 / (0.2 0.4)
      25, 0, 12.5, 12.5;         // 2 / 0.4^2
  EXPECT_LT((covariance - expected).norm(), 1e-6) << covariance;
}

TEST(ImageErrors, SimilarOnesCancelInShortSteps) {
  ImageErrors errors;
  errors.add(100.0, 100.05);
  errors.add(100.05, 100.1);
  errors.add(100.0, 101.0);
  const Eigen::MatrixXd covariance = errors.covariances().similar;
  // Two images 0.05 s apart have the correlation exp(-1/8), those 0.1 s apart exp(-1/2), those 1 s apart
  // none.
  const double near = std::exp(-0.125), far = std::exp(-0.5);
  EXPECT_NEAR(covariance(0, 0), 2 * (1 - near) / 0.0025, 1e-6);
  EXPECT_NEAR(covariance(0, 1), (near - far - 1 + near) / 0.0025, 1e-6);
  EXPECT_NEAR(covariance(2, 2), 2, 1e-6);
}

TEST(ImageErrors, StampsThatAreRoundedBelongToOneImage) {
  ImageErrors errors;
  errors.add(100.0, 100.1);
  errors.add(100.1004, 100.2);
  EXPECT_LT(errors.covariances().single(0, 1), -90);
}

TEST(ImageErrors, AMovementThatIsShorterThanStampsTellHasNone) {
  ImageErrors errors;
  errors.add(100.0, 100.0005);
  EXPECT_EQ(errors.covariances().single(0, 0), 0);
  EXPECT_EQ(errors.covariances().similar(0, 0), 0);
}

}  // namespace
}  // namespace uav_landing
