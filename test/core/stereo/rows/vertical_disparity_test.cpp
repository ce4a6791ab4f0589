#include "stereo/rows/vertical_disparity.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <random>

#include "image/windows/match_image.h"
#include "rig/rig_rotation.h"
#include "stereo/matching/corner_matching.h"
#include "support/consistency.h"
#include "support/ground_renderer.h"
#include "uav_landing/stages/stereo_depth_stage.h"

namespace uav_landing {
namespace {

using test::GroundRenderer;
using test::kDegree;
using test::Pose;

constexpr double kBaseline = 1.0;

/// A rig of two cameras that are not as calibrated, over a textured ground.
struct BentScene {
  StereoRig rig = test::makeRig(640, 480, kBaseline);
  RigModel model = test::makeModel(rig);
  GroundRenderer ground{31};
  StereoDepthParameters parameters;
  Pose pose;

  explicit BentScene(const Eigen::Vector3d& bend_deg) {
    ground.grain = 0.05;
    ground.bend = kDegree * bend_deg;
    pose.position = {0, 0, 10};
    pose.pitch = -5 * kDegree;
    pose.roll = 2 * kDegree;
    parameters.search_at_once = true;
  }
  StereoDepthResult see(StereoDepthStage& stage, double stamp, const test::Exposure& right = {}) const {
    return stage.process(stamp, ground.left(rig, pose), ground.right(rig, pose, right));
  }
  StereoDepthResult first() const {
    StereoDepthStage stage(model, parameters);
    return see(stage, 1);
  }
};

/// Pixel of a direction in the right camera after it turned by w: worked out with whole rotations.
Eigen::Vector2d turnedPixel(const StereoRig& rig, double column, double v, const Eigen::Vector3d& w) {
  const Eigen::Vector3d ray((column - rig.cx_right) / rig.fx, (v - rig.cy) / rig.fy, 1);
  const Eigen::Matrix3d axes(Eigen::AngleAxisd(w.norm(), w.normalized()));
  const Eigen::Vector3d seen = axes.transpose() * ray;
  return {rig.fx * seen.x() / seen.z() + rig.cx_right, rig.fy * seen.y() / seen.z() + rig.cy};
}

TEST(RigRotation, MovesDisparitiesAsATurnedCameraDoes) {
  const StereoRig rig = test::makeRig(640, 480, kBaseline);
  constexpr double kSmall = 1e-5;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d w = kSmall * Eigen::Vector3d::Unit(i);
    for (const double column : {3.0, 250.0, 620.0}) {
      for (const double v : {10.0, 260.0, 470.0}) {
        const Eigen::Vector2d moved = turnedPixel(rig, column, v, w) - Eigen::Vector2d(column, v);
        EXPECT_NEAR(disparityByRotation(rig, column, v)[i], -moved.x() / kSmall, 0.02) << i;
        EXPECT_NEAR(verticalDisparityByRotation(rig, column, v)[i], moved.y() / kSmall, 0.02) << i;
      }
    }
  }
}

TEST(BaselineDirection, MovesRowsAsACameraAtAnotherPlaceDoes) {
  const StereoRig rig = test::makeRig(640, 480, kBaseline);
  constexpr double kSmall = 1e-5;
  for (const Eigen::Vector3d& point : {Eigen::Vector3d(-3, 2, 10), Eigen::Vector3d(1, 6, 25)}) {
    const double v = rig.cy + rig.fy * point.y() / point.z(), disparity = rig.fb() / point.z();
    for (int i = 0; i < 2; ++i) {
      const Eigen::Vector3d place =
          kBaseline * (Eigen::Vector3d::UnitX() + kSmall * Eigen::Vector3d::Unit(i + 1));
      const Eigen::Vector3d seen = point - place;
      const double moved = rig.cy + rig.fy * seen.y() / seen.z() - v;
      EXPECT_NEAR(verticalDisparityByBaseline(rig, disparity, v)[i], moved / kSmall, 0.02) << i;
    }
  }
}

TEST(RigRotation, TurnsThePlaneAsAFitToTheDisturbedDisparitiesDoes) {
  const StereoRig rig = test::makeRig(640, 480, kBaseline);
  Pose pose;
  pose.position = {0, 0, 12};
  pose.pitch = -6 * kDegree;
  const GroundPlane plane = test::exactPlane(pose, 0, 0);
  const Eigen::Vector3d w(0.0007, -0.0004, 0.0009);
  std::vector<StereoDepthResult::Point> points;
  Eigen::MatrixXd rows(0, 3);
  Eigen::VectorXd disturbed(0);
  for (double u = 5; u < 640; u += 45) {
    for (double v = 260; v < 480; v += 35) {
      const double d = plane.disparity(rig, u, v), column = u - d - rig.principalOffset();
      const double stddev = 0.05 + 0.1 * (u / 640);
      points.push_back({u, v, d, stddev, true});
      rows.conservativeResize(rows.rows() + 1, 3);
      disturbed.conservativeResize(rows.rows());
      rows.bottomRows(1) = rig.fb() * rig.ray(u, v).transpose() / stddev;
      disturbed[rows.rows() - 1] = (d + column - turnedPixel(rig, column, v, w).x()) / stddev;
    }
  }
  points.push_back({300, 400, 1, 1e-3, false});  // not on the plane: does not count
  const Eigen::Vector3d fitted = (rows.transpose() * rows).inverse() * (rows.transpose() * disturbed);
  const Eigen::Vector3d predicted = planeByRotation(rig, points, PlaneVector(plane.g)) * w;
  EXPECT_LT((fitted - plane.g - predicted).norm(), 0.005 * predicted.norm());
  // Mostly a yaw turns the pitch and a roll changes the height, by h / b.
  EXPECT_NEAR(planeByRotation(rig, points, PlaneVector(plane.g))(2, 1), 1 / kBaseline, 0.15);
  EXPECT_NEAR(planeByRotation(rig, points, PlaneVector(plane.g))(1, 2), -1 / kBaseline, 0.15);
}

TEST(VerticalDisparity, MeasuresPitchAndRollBetweenTheCameras) {
  // Up to two rows, which is 0.2 degrees here, and any mixture.
  for (const Eigen::Vector3d& bend :
       {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0.02, 0, 0), Eigen::Vector3d(-0.1, 0, 0.1),
        Eigen::Vector3d(0.2, 0, 0), Eigen::Vector3d(-0.2, 0, 0), Eigen::Vector3d(0, 0, 0.3),
        Eigen::Vector3d(0.1, 0.1, -0.2)}) {
    const BentScene scene(bend);
    const StereoDepthResult result = scene.first();
    ASSERT_FALSE(result.failure) << bend.transpose() << ": " << result.failure.message();
    ASSERT_TRUE(result.vertical_rotation.known()) << bend.transpose();
    const Eigen::Vector3d error = result.vertical_rotation.w - kDegree * bend;
    const Eigen::Matrix3d& covariance = result.vertical_rotation.covariance;
    // Chi-square with three degrees of freedom: 16.3 once in a thousand.
    EXPECT_LT(error.dot(covariance.inverse() * error), 16.3) << bend.transpose() << "; " << error.transpose();
    EXPECT_LT(std::sqrt(covariance(0, 0)), 0.001 * kDegree) << "a hundredth of a row";
    EXPECT_LT(std::sqrt(covariance(2, 2)), 0.005 * kDegree);
  }
}

TEST(VerticalDisparity, APartOfTheImageWithAnErrorOfItsOwnMakesTheRotationUncertain) {
  const BentScene scene({0, 0, 0});
  const cv::Mat left = scene.ground.left(scene.rig, scene.pose);
  cv::Mat right = scene.ground.right(scene.rig, scene.pose);
  // The left third is 0.1 rows too low, as by a lens.
  cv::Mat third = right(cv::Rect(0, 0, right.cols / 3, right.rows));
  const cv::Mat down = (cv::Mat_<double>(2, 3) << 1, 0, 0, 0, 1, 0.1);
  cv::warpAffine(third.clone(), third, down, third.size(), cv::INTER_CUBIC, cv::BORDER_REPLICATE);
  StereoDepthStage stage(scene.model, scene.parameters);
  const StereoDepthResult result = stage.process(1, left, right);
  ASSERT_TRUE(result.vertical_rotation.known());
  // Taken as independent, the rows would claim the same as those of the whole image without the error.
  const StereoDepthResult even = scene.first();
  const double stddev = std::sqrt(result.vertical_rotation.covariance(2, 2));
  EXPECT_GT(stddev, 1.5 * std::sqrt(even.vertical_rotation.covariance(2, 2)));
  EXPECT_GT(std::abs(result.vertical_rotation.w.z()), 0.01 * kDegree) << "the third pulls at the rotation";
  EXPECT_LT(std::abs(result.vertical_rotation.w.z()), 5 * stddev);
  EXPECT_GT(result.row_agreement, 0.9);
}

/// How far the direction of the baseline is from 0, in squares of its sigma.
double ratioOf(const BaselineDirection& baseline) {
  return baseline.t.dot(baseline.covariance.inverse() * baseline.t);
}

TEST(VerticalDisparity, TellsWhereTheRightCameraWasWhenItsImageWasTaken) {
  const BentScene scene({0, 0, 0});
  const BaselineDirection together = scene.first().baseline_direction;
  ASSERT_TRUE(together.known());
  EXPECT_LT(ratioOf(together), 13.8) << "chi-square with two degrees of freedom: once in a thousand";
  // Behind or before the left one on the way down, in metres, and turned besides.
  for (const double behind : {1.0, 0.3, -0.3}) {
    Pose earlier = scene.pose;
    earlier.position += Eigen::Vector3d(-behind, 0, 0.05 * behind);
    earlier.roll += 0.05 * kDegree;
    StereoDepthStage stage(scene.model, scene.parameters);
    const cv::Mat left = scene.ground.left(scene.rig, scene.pose);
    const cv::Mat right = scene.ground.right(scene.rig, earlier);
    // The images cannot be aligned, so that the first pair's plane waits for the next.
    stage.process(1, left, right);
    const StereoDepthResult result = stage.process(1.1, left, right);
    const BaselineDirection& baseline = result.baseline_direction;
    ASSERT_TRUE(baseline.known()) << behind << ": " << result.failure.message();
    const Eigen::Vector3d place =
        kBaseline * Eigen::Vector3d::UnitX() + scene.pose.seen(earlier.position - scene.pose.position);
    const Eigen::Vector2d expected = place.tail<2>() / place.x();
    EXPECT_LT((baseline.t - expected).norm(), 0.1 * expected.norm() + 0.02) << behind << ": " << baseline.t;
    EXPECT_GT(ratioOf(baseline), 23) << behind << ": once in a hundred thousand";
  }
}

TEST(VerticalDisparity, TellsAnotherFocalLengthOfTheRightCamera) {
  const BentScene scene({0, 0, 0});
  const auto ratioWith = [&](double factor) {
    StereoRig other = scene.rig;
    other.fx *= factor;
    other.fy *= factor;
    StereoDepthStage stage(scene.model, scene.parameters);
    const BaselineDirection baseline =
        stage.process(1, scene.ground.left(scene.rig, scene.pose), scene.ground.right(other, scene.pose))
            .baseline_direction;
    EXPECT_TRUE(baseline.known()) << factor;
    return ratioOf(baseline);
  };
  EXPECT_GT(ratioWith(1.01), 23);
  EXPECT_GT(ratioWith(0.99), 23);
  EXPECT_LT(ratioWith(1.001), 13.8) << "no calibration is better";
}

TEST(VerticalDisparity, IsBlindToGainOffsetAndNoise) {
  const BentScene scene({0.1, 0, 0.1});
  StereoDepthStage stage(scene.model, scene.parameters);
  const StereoDepthResult result = scene.see(stage, 1, {0.85, 20, 4});
  ASSERT_TRUE(result.vertical_rotation.known());
  EXPECT_NEAR(result.vertical_rotation.w.x(), 0.1 * kDegree, 0.003 * kDegree);
  EXPECT_NEAR(result.vertical_rotation.w.z(), 0.1 * kDegree, 0.015 * kDegree);
}

/// By how much rows seem to be off, pixels, of a pair that is hardly more than noise.
struct NoisyRows {
  double matched, all;  ///< by the corners that are found along their rows, and by all

  NoisyRows(const BentScene& scene, const test::Exposure& exposure) {
    MatchImage left, right;
    left.assign(scene.ground.left(scene.rig, scene.pose, exposure));
    right.assign(scene.ground.right(scene.rig, scene.pose, exposure));
    const StereoDepthParameters& parameters = scene.parameters;
    StereoLevel level = reduceLevel(scene.model, 1, parameters.window_radius + 2);
    level.left = left.fine;
    level.right = right.fine;
    const PlaneVector g(test::exactPlane(scene.pose, 0, 0).g);
    const std::vector<cv::Point> corners = findGroundCorners(level, g, parameters.corner_count, parameters);
    const RowMatches matches = matchCorners(level, corners, g, parameters);
    std::vector<cv::Point> found;
    for (const DisparitySample& sample : matches.samples)
      found.emplace_back(static_cast<int>(sample.u), static_cast<int>(sample.v));
    EXPECT_LT(found.size(), 0.9 * corners.size()) << "all are found, so that noise chooses nothing";
    const auto off = [&](const std::vector<cv::Point>& some) {
      const Expected<RigRotation> rows =
          measureVerticalDisparities(level, some, matches, g, parameters.window_radius).rotation;
      return rows ? (rows->w - scene.ground.bend).x() * scene.rig.fy : kUnknown;
    };
    matched = off(found);
    all = off(corners);
  }
};

/// Over ground that shows hardly any texture, with rows half a pixel off. The horizon, which is drawn in
/// whole pixels, is out of view.
BentScene noisyScene(unsigned seed) {
  BentScene scene({0.05, 0, 0});
  scene.ground = GroundRenderer(seed);
  scene.ground.contrast = 3;
  scene.ground.bend.x() = 0.05 * kDegree;
  scene.pose.position.z() = 3;
  scene.pose.pitch = -25 * kDegree;
  return scene;
}
const test::Exposure kNoisy = {1, 0, 5};

TEST(VerticalDisparity, CornersThatNoiseKeepsInTheirRowsDoNotDecide) {
  constexpr int kPairs = 24;
  double matched = 0, all = 0;
  for (unsigned i = 0; i < kPairs; ++i) {
    const NoisyRows rows(noisyScene(100 + i), kNoisy);
    matched += rows.matched / kPairs;
    all += rows.all / kPairs;
  }
  EXPECT_LT(std::abs(all), 0.8 * std::abs(matched));
}

TEST(VerticalDisparity, MatchesABentRigAsWellAsAStraightOne) {
  const size_t straight = BentScene({0, 0, 0}).first().points.size();
  BentScene bent({0.2, 0, 0});
  EXPECT_GT(bent.first().points.size(), 0.8 * straight);
  bent.parameters.vertical_disparities = false;
  EXPECT_LT(bent.first().points.size(), 0.7 * straight) << "the rows are not what is in the way";
}

TEST(VerticalDisparity, FollowsARigThatBendsMoreAndMore) {
  BentScene scene({0, 0, 0});
  StereoDepthStage stage(scene.model, scene.parameters);
  for (int i = 0; i < 5; ++i) {
    scene.ground.bend.x() = 0.04 * i * kDegree;
    const StereoDepthResult result = scene.see(stage, 1 + 0.1 * i);
    EXPECT_EQ(result.from_search, i == 0);
    ASSERT_TRUE(result.vertical_rotation.known()) << i;
    EXPECT_NEAR(result.vertical_rotation.w.x(), 0.04 * i * kDegree, 0.003 * kDegree) << i;
  }
}

TEST(VerticalDisparity, ForgetsTheRigAtAReset) {
  BentScene scene({0.15, 0, 0.05});
  scene.ground.line_offset = 6;
  StereoDepthStage used(scene.model, scene.parameters), fresh(scene.model, scene.parameters);
  for (int i = 0; i < 4; ++i) scene.see(used, 1 + 0.1 * i);
  scene.ground.bend.setZero();
  used.reset();
  const StereoDepthResult after = scene.see(used, 2), expected = scene.see(fresh, 2);
  ASSERT_FALSE(after.failure || expected.failure);
  EXPECT_EQ(after.plane.g, expected.plane.g);
  EXPECT_EQ(after.plane.covariance, expected.plane.covariance);
}

TEST(VerticalDisparity, SaysNothingWhenSwitchedOffOrBlind) {
  BentScene scene({0.05, 0, 0});
  scene.parameters.vertical_disparities = false;
  EXPECT_FALSE(scene.first().vertical_rotation.known());
  const cv::Mat flat(scene.rig.size, CV_8UC1, cv::Scalar(128));
  StereoDepthStage stage(scene.model, StereoDepthParameters());
  const StereoDepthResult blind = stage.process(1, flat, flat);
  EXPECT_FALSE(blind.vertical_rotation.known());
  EXPECT_FALSE(blind.baseline_direction.known());
}

TEST(VerticalDisparity, StraightenedRowsAreThoseOfAStraightRig) {
  const BentScene straight({0, 0, 0});
  cv::Mat crooked, wanted, level;
  straight.ground.right(straight.rig, straight.pose, {1, 0, 0}).convertTo(wanted, CV_32F);
  // Columns stay, so that only rotations that move none can be compared: none but pitch near the middle.
  BentScene pitched({0.15, 0, 0});
  pitched.ground.right(pitched.rig, pitched.pose, {1, 0, 0}).convertTo(crooked, CV_32F);
  straightenRows(pitched.rig, pitched.ground.bend, crooked, level);
  const cv::Rect middle(pitched.rig.size.width / 2 - 20, 260, 40, 200);
  const double before = cv::norm(crooked(middle), wanted(middle), cv::NORM_L1) / middle.area();
  const double after = cv::norm(level(middle), wanted(middle), cv::NORM_L1) / middle.area();
  EXPECT_LT(after, 0.25 * before);
}

// In an image whose grey levels are its rows one reads where a row is from.
TEST(VerticalDisparity, StraightenedRowsComeFromWhereTheTurnedCameraSeesThem) {
  const StereoRig rig = test::makeRig(640, 480, kBaseline);
  cv::Mat rows(rig.size, CV_32F), level;
  for (int v = 0; v < rows.rows; ++v) rows.row(v) = static_cast<float>(v);
  for (const Eigen::Vector3d& w :
       {Eigen::Vector3d(0.004, 0, 0), Eigen::Vector3d(0, 0, 0.006), Eigen::Vector3d(-0.002, 0.001, -0.005)}) {
    straightenRows(rig, w, rows, level);
    for (int v = 8; v < rig.size.height - 8; v += 11)
      for (int u = 0; u < rig.size.width; ++u)
        ASSERT_NEAR(level.at<float>(v, u), turnedPixel(rig, u, v, w).y(), 0.03) << w.transpose() << " " << u;
  }
}

// So that a rig without vertical disparities may skip it.
TEST(VerticalDisparity, RowsThatAreLevelStayAsTheyAre) {
  const StereoRig rig = test::makeRig(640, 480, kBaseline);
  cv::Mat image(rig.size, CV_32F), level;
  cv::RNG(3).fill(image, cv::RNG::UNIFORM, 0, 255);
  straightenRows(rig, Eigen::Vector3d::Zero(), image, level);
  const cv::Range inside(2, rig.size.height - 2);  // masks are eroded by two pixels at least
  EXPECT_EQ(cv::norm(level.rowRange(inside), image.rowRange(inside), cv::NORM_INF), 0);
}

/// Corners on a grid whose rows a bent rig moves, each known to a tenth of a pixel.
struct MovedRows {
  StereoLevel level;
  std::vector<cv::Point> corners;
  PlaneVector g{normalFromPitchRoll(-5 * kDegree, 0) / 10};
  static constexpr double kStddev = 0.1;  // pixels

  MovedRows() {
    level.rig = test::makeRig(640, 480, kBaseline);
    for (int v = 262; v < 470; v += 17)
      for (int u = 70; u < 630; u += 35) corners.emplace_back(u, v);
  }
  RowMatches moved(const Eigen::Vector3d& w, std::mt19937& random) const {
    std::normal_distribution<double> normal;
    RowMatches matches;
    for (const cv::Point& corner : corners) {
      const double disparity = g.disparity(level.rig, corner.x, corner.y);
      const double column = corner.x - disparity - level.rig.principalOffset();
      RowRefinement::Across across;
      across.found = true;
      across.place = {column, turnedPixel(level.rig, column, corner.y, w).y() + kStddev * normal(random)};
      across.column_variance = across.row_variance = kStddev * kStddev;
      across.score = 1;
      matches.samples.push_back({double(corner.x), double(corner.y), kStddev, disparity});
      matches.across.emplace_back(across);
    }
    return matches;
  }
  /// After so many pairs of a rig that is bent like this.
  void measure(RowAlignment& alignment, const Eigen::Vector3d& w, int pairs, std::mt19937& random) const {
    for (int i = 0; i < pairs; ++i) alignment.measure(level, corners, moved(w, random), g);
  }
};

TEST(VerticalDisparity, AgreementIsTheShareOfMatchesWhoseRowIsFound) {
  const MovedRows rows;
  std::mt19937 random(4);
  RowMatches matches = rows.moved({1e-4, 0, 0}, random);
  const auto agreement = [&] {
    return measureVerticalDisparities(rows.level, rows.corners, matches, rows.g, 5).agreement;
  };
  EXPECT_EQ(agreement(), 1);
  for (size_t i = 0; i < matches.across.size(); i += 4) matches.across[i]->found = false;
  EXPECT_NEAR(agreement(), 0.75, 0.01);
}

TEST(RowAlignment, SearchTellsWhetherTheRowsHaveToBeMadeLevel) {
  for (const double bend : {0.0, 0.15}) {
    const BentScene scene({bend, 0, 0});
    StereoLevel level = reduceLevel(scene.model, 1, scene.parameters.window_radius + 2);
    MatchImage left, right;
    left.assign(scene.ground.left(scene.rig, scene.pose));
    right.assign(scene.ground.right(scene.rig, scene.pose));
    level.left = left.fine;
    level.right = right.fine;
    const PlaneVector g(test::exactPlane(scene.pose, 0, 0).g);
    const std::vector<cv::Point> corners = findGroundCorners(level, g, 300, scene.parameters);
    RowAlignment alignment(true, scene.parameters.window_radius, 0.3, 0.3);
    EXPECT_EQ(alignment.search(level, corners, g), bend != 0) << bend;
    EXPECT_EQ(alignment.isLevel(), bend == 0) << bend;
    RowAlignment off(false, scene.parameters.window_radius, 0.3, 0.3);
    EXPECT_FALSE(off.search(level, corners, g));
  }
}

TEST(VerticalDisparity, GroundCornersAreBelowTheHorizonAndInTheRightImage) {
  const BentScene scene({0, 0, 0});
  StereoLevel level = reduceLevel(scene.model, 1, scene.parameters.window_radius + 2);
  MatchImage left;
  left.assign(scene.ground.left(scene.rig, scene.pose));
  level.left = left.fine;
  // A plane of which much lies outside the right image, and whose horizon is well below the picture's.
  const PlaneVector g(normalFromPitchRoll(2 * kDegree, 10 * kDegree) / 4);
  const std::vector<cv::Point> corners = findGroundCorners(level, g, 400, scene.parameters);
  EXPECT_GT(corners.size(), 100u);
  for (const cv::Point& corner : corners) {
    const double disparity = g.disparity(scene.rig, corner.x, corner.y);
    const double column = corner.x - disparity - scene.rig.principalOffset();
    EXPECT_TRUE(disparity >= 0.3 && column >= 0 && column <= scene.rig.size.width - 1) << corner;
  }
}

double normalisedError(const RigRotation& found, const Eigen::Vector3d& truth) {
  const Eigen::Vector3d error = found.w - truth;
  return error.dot(found.covariance.inverse() * error);
}

constexpr double kVagueCalibration = 50;  // pixels

TEST(RowAlignment, ClaimsTheScatterOfOnePairAndHalfOfWhatManySay) {
  constexpr int kRuns = 300;
  const MovedRows rows;
  const Eigen::Vector3d w(2e-4, 0, -2e-4);  // a tenth of a pixel: nothing has to be taken out
  std::mt19937 random(5);
  double one = 0, many = 0, gained = 0;
  for (int run = 0; run < kRuns; ++run) {
    RowAlignment alignment(true, 5, kVagueCalibration, kVagueCalibration);
    rows.measure(alignment, w, 1, random);
    const RigRotation first = alignment.residual(rows.level.rig);
    one += normalisedError(first, w) / kRuns;
    rows.measure(alignment, w, 39, random);
    const RigRotation averaged = alignment.residual(rows.level.rig);
    many += normalisedError(averaged, w) / kRuns;
    gained += first.covariance(0, 0) / averaged.covariance(0, 0) / kRuns;
  }
  const double tolerance = test::chiSquareMeanTolerance(kRuns, 3);
  EXPECT_LT(one, 3 + tolerance);
  EXPECT_GT(one, 0.6 * 3 - tolerance);
  // Weights of 0.95^k add up to 17.4 pairs, their squares to 10.1: the scatter is 10.1 / 17.4 of the claim.
  EXPECT_LT(many, 10.1 / 17.4 * 3 + tolerance);
  EXPECT_GT(many, 0.6 * 10.1 / 17.4 * 3 - tolerance);
  EXPECT_NEAR(gained, 17.4, 4);
}

TEST(RowAlignment, ForgetsARigThatHasBentOtherwise) {
  const MovedRows rows;
  std::mt19937 random(6);
  RowAlignment alignment(true, 5, kVagueCalibration, kVagueCalibration);
  rows.measure(alignment, {4e-4, 0, 0}, 50, random);
  const Eigen::Vector3d now(-4e-4, 0, 3e-4);
  rows.measure(alignment, now, 150, random);
  EXPECT_LT(normalisedError(alignment.residual(rows.level.rig), now), 16.3);
  alignment.reset();
  EXPECT_TRUE(alignment.isLevel());
  EXPECT_TRUE(alignment.residual(rows.level.rig).w.isZero()) << "nothing is measured yet";
}

TEST(RowAlignment, ExpectsOfACalibrationWhatItIsGoodTo) {
  const MovedRows rows;
  const StereoRig& rig = rows.level.rig;
  // 0.3 px of the cameras turn a camera by 0.3 / f about any axis; 0.4 px of a lens look like pitch.
  const Eigen::Matrix3d cameras = RowAlignment(true, 5, 0.3, 0).residual(rig).covariance;
  const Eigen::Matrix3d both = RowAlignment(true, 5, 0.3, 0.4).residual(rig).covariance;
  EXPECT_TRUE(cameras.isApprox(std::pow(0.3 / rig.fy, 2) * Eigen::Matrix3d::Identity(), 1e-9));
  EXPECT_NEAR(both(0, 0), (0.3 * 0.3 + 0.4 * 0.4) / (rig.fy * rig.fy), 1e-12);
  EXPECT_NEAR(both(1, 1), 0.3 * 0.3 / (rig.fy * rig.fy), 1e-12);
  // With a measurement that is as good, the mean; one that contradicts it is believed alone.
  const Eigen::Vector3d w(3e-4, 0, 0);
  std::mt19937 random(7);
  RowAlignment vague(true, 5, kVagueCalibration, kVagueCalibration), sure(true, 5, 1e-3, 0);
  rows.measure(vague, w, 1, random);
  const RigRotation measured = vague.residual(rig);
  random.seed(7);
  rows.measure(sure, w, 1, random);
  EXPECT_LT((sure.residual(rig).w - measured.w).norm(), 0.01 * w.norm());
  RowAlignment fair(true, 5, rig.fy * 2e-4, 0);
  random.seed(7);
  rows.measure(fair, w, 1, random);
  const Eigen::Matrix3d information = measured.covariance.inverse(),
                        prior = Eigen::Matrix3d::Identity() / (2e-4 * 2e-4);
  const Eigen::Matrix3d mean = (information + prior).inverse();
  EXPECT_TRUE(fair.residual(rig).covariance.isApprox(mean, 0.01));
  EXPECT_TRUE(fair.residual(rig).w.isApprox(mean * information * measured.w, 0.01));
}

}  // namespace
}  // namespace uav_landing
