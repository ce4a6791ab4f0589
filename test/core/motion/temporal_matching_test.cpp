#include "motion/matching/temporal_matching.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <functional>

#include "image/windows/corners.h"
#include "image/windows/patch_refiner.h"
#include "support/ground_renderer.h"
#include "support/random_texture.h"

namespace uav_landing {
namespace {

using test::GroundRenderer;
using test::kDegree;
using test::Movement;
using test::Pose;

/// Two frames of an approach with corners of the later one.
struct Frames {
  StereoRig rig;
  Pose then, now;
  GroundRenderer ground;
  MatchImage image_then, image_now;
  cv::Mat mask;
  std::vector<TrackedCorner> corners;
  Movement movement;

  Frames(const Pose& from, const Pose& to, int width = 320,
         const GroundRenderer& renderer = GroundRenderer{21}, const test::Exposure& exposure_then = {})
      : rig(test::makeRig(width, width * 3 / 4, 0.65)),
        then(from),
        now(to),
        ground(renderer),
        mask(rig.size, CV_8UC1, cv::Scalar(255)),
        movement(from, to) {
    const cv::Mat grey = ground.left(rig, now);
    image_then.assign(ground.left(rig, then, exposure_then));
    image_now.assign(grey);
    cv::Mat below = cv::Mat::zeros(rig.size, CV_8UC1);
    below.rowRange(rig.size.height * 45 / 100, rig.size.height - 8) = 255;
    for (const cv::Point& p : findCorners(grey, below, {250, 1e-7, 4, 0.04})) {
      TrackedCorner corner;
      corner.u = p.x;
      corner.v = p.y;
      corners.push_back(corner);
    }
  }

  CameraMotion truth() const { return {movement.R, movement.t / now.height()}; }

  std::vector<TemporalMatch> match(const CameraMotion& predicted, int coarse_steps) const {
    TemporalMatchOptions options;
    options.coarse_steps = coarse_steps;
    MatchingMemory memory;
    return matchOverTime({rig, image_now, image_then, mask}, corners, {predicted, now.down()}, options,
                         memory);
  }

  /// Where the point of the world that is seen at a pixel now, at this depth, was then.
  Eigen::Vector2d wanted(const Eigen::Vector2d& pixel, double depth) const {
    const Eigen::Vector3d X = depth * rig.ray(pixel.x(), pixel.y());
    return rig.project(then.seen(now.worldFromOptical() * X + now.position - then.position));
  }
  double groundDepth(const Eigen::Vector2d& pixel) const {
    return now.height() / now.down().dot(rig.ray(pixel.x(), pixel.y()));
  }
};

Frames approach(int width = 320) {
  Pose then, now;
  then.position = {-0.35, 0.02, 1.56};
  then.pitch = -8 * kDegree;
  then.roll = 1 * kDegree;
  now.position = {0, 0, 1.5};
  now.pitch = -7.6 * kDegree;
  now.roll = 1.8 * kDegree;
  now.yaw = 0.5 * kDegree;
  return Frames(then, now, width);
}

/// From the pixels now to those then, of the ground.
Eigen::Matrix3d homography(const StereoRig& rig, const CameraMotion& motion, const Eigen::Vector3d& normal) {
  return rig.K() * motion.R.transpose() * (Eigen::Matrix3d::Identity() + motion.t * normal.transpose()) *
         rig.Kinv();
}

/// RMS of a component over the matches that are not plainly wrong, the normalised square, the share of wrong
/// ones.
struct Errors {
  double rms = 0, nees = 0, wrong = 0;
};

Errors errorsOf(const Frames& frames, const std::vector<TemporalMatch>& matches) {
  Errors errors;
  int good = 0;
  for (const TemporalMatch& match : matches) {
    const Eigen::Vector2d error = match.then - frames.wanted(match.now, frames.groundDepth(match.now));
    if (error.norm() > 1) continue;
    ++good;
    errors.rms += error.squaredNorm() / 2;
    errors.nees += error.dot(match.covariance.inverse() * error);
  }
  errors.rms = std::sqrt(errors.rms / good);
  errors.nees /= good;
  errors.wrong = 1 - good / static_cast<double>(matches.size());
  return errors;
}

TEST(MatchOverTime, FindsGroundCornersToSubPixelFromTheTruePrediction) {
  const Frames frames = approach();
  const std::vector<TemporalMatch> matches = frames.match(frames.truth(), 0);
  EXPECT_GT(matches.size(), 0.8 * static_cast<double>(frames.corners.size()));
  const Errors errors = errorsOf(frames, matches);
  EXPECT_LT(errors.rms, 0.08);
  EXPECT_LT(errors.wrong, 0.01);
  // Factor two in the deviation; two components.
  EXPECT_LT(errors.nees, 2 * 4);
  EXPECT_GT(errors.nees, 2 / 4.0);
}

/// Two views of a plane with a texture that is as coarse everywhere in the view now, so that nothing but
/// perspective tells windows apart; corners in a grid.
TEST(MatchOverTime, HasNoBiasByPerspective) {
  const StereoRig rig = test::makeRig(640, 480, 0.65);
  Pose then, now;
  then.position = {-1.2, 0, 1.57};
  now.position = {0, 0, 1.5};
  then.pitch = now.pitch = -6 * kDegree;
  const Movement movement(then, now);
  const CameraMotion truth{movement.R, movement.t / now.height()};
  const Eigen::Vector3d normal = now.down();
  const Eigen::Matrix3d H = homography(rig, truth, normal);
  const test::RandomTexture texture(3);
  const Eigen::Matrix3d back = H.inverse();
  cv::Mat image_now(rig.size, CV_8UC1, cv::Scalar(110)), image_then = image_now.clone();
  for (int v = 0; v < rig.size.height; ++v)
    for (int u = 0; u < rig.size.width; ++u) {
      image_now.at<uchar>(v, u) = cv::saturate_cast<uchar>(110 + 30 * texture.at(u / 4.0, v / 4.0));
      const Eigen::Vector3d x = back * Eigen::Vector3d(u, v, 1);
      if (!(x.z() > 0)) continue;
      const double light = 110 + 30 * texture.at(x.x() / x.z() / 4, x.y() / x.z() / 4);
      image_then.at<uchar>(v, u) = cv::saturate_cast<uchar>(light);
    }
  MatchImage match_now, match_then;
  match_now.assign(image_now);
  match_then.assign(image_then);
  std::vector<TrackedCorner> corners;
  for (int v = 300; v < 400; v += 5)
    for (int u = 40; u < 600; u += 10) {
      TrackedCorner corner;
      corner.u = u;
      corner.v = v;
      corners.push_back(corner);
    }
  const cv::Mat mask(rig.size, CV_8UC1, cv::Scalar(255));
  TemporalMatchOptions options;
  options.coarse_steps = 0;
  MatchingMemory memory;
  const std::vector<TemporalMatch> matches =
      matchOverTime({rig, match_now, match_then, mask}, corners, {truth, normal}, options, memory);
  ASSERT_GT(matches.size(), 500u);
  double sum = 0;
  for (const TemporalMatch& match : matches)
    sum += match.then.y() - (H * match.now.homogeneous()).hnormalized().y();
  EXPECT_LT(std::abs(sum) / static_cast<double>(matches.size()), 0.005);
}

/// Errors of windows with gains of their own, over those of matches: root mean squares over scenes.
double ownGainsOverHeld(const test::Exposure& exposure_then,
                        const std::function<void(GroundRenderer&)>& paint) {
  Pose then, now;
  then.position = {-1, 0.02, 1.56};
  now.position = {0, 0, 1.5};
  then.pitch = now.pitch = -6 * kDegree;
  double own = 0, held = 0;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    GroundRenderer ground{seed};
    paint(ground);
    const Frames frames(then, now, 640, ground, exposure_then);
    const CameraMotion truth = frames.truth();
    const Eigen::Matrix3d H = homography(frames.rig, truth, now.down());
    for (const TemporalMatch& match : frames.match(truth, 0)) {
      const Eigen::Vector2d wanted = frames.wanted(match.now, frames.groundDepth(match.now));
      const Eigen::Vector3d y = H * match.now.homogeneous();
      const Eigen::Matrix2d warp = (H.topLeftCorner<2, 2>() - wanted * H.block<1, 2>(2, 0)) / y.z();
      const PatchRefinement alone =
          refinePatch(frames.image_now.fine, frames.image_then.fine,
                      {cvRound(match.now.x()), cvRound(match.now.y()), TemporalMatchOptions().window_radius},
                      {wanted, warp});
      if (!alone.converged || (match.then - wanted).norm() > 1) continue;
      own += (alone.position - wanted).squaredNorm();
      held += (match.then - wanted).squaredNorm();
    }
  }
  return std::sqrt(own / held);
}

// What is near is blurred more in the frame then, which its window's gain would make up for.
TEST(MatchOverTime, HoldsGainsToThatOfTheImages) {
  for (const double gain : {1.0, 0.7}) {
    test::Exposure exposure;
    exposure.gain = gain;
    exposure.offset = 60 * (1 - gain);
    EXPECT_GT(ownGainsOverHeld(exposure, [](GroundRenderer&) {}), 1.03) << gain;
  }
}

void paintThreshold(GroundRenderer& ground) {
  ground.contrast = 6;
  ground.line_offset = 1.1;
  ground.line_width = 0.3;
  ground.bar_period = 0.6;
  ground.bar_from = 3;
  ground.bar_to = 6;
  ground.bar_reach = 1;
}

// Paint that is brighter than the camera can see takes the means off the gain.
TEST(MatchOverTime, DoesNotHoldGainsToWhatClippedPaintSays) {
  for (const double gain : {1.3, 1.5, 1.8}) {
    test::Exposure exposure;
    exposure.gain = gain;
    EXPECT_GT(ownGainsOverHeld(exposure, paintThreshold), 0.98) << gain;
  }
}

// Its edges stand elsewhere with another exposure.
TEST(MatchOverTime, ClaimsLessOfClippedPaintThatWasSeenWithAnotherExposure) {
  Pose then, now;
  then.position = {-0.35, 0.02, 1.56};
  now.position = {0, 0, 1.5};
  then.pitch = now.pitch = -6 * kDegree;
  GroundRenderer ground{21};
  paintThreshold(ground);
  for (const double gain : {0.6, 1.0, 1.3, 1.6, 2.2}) {
    test::Exposure exposure;
    exposure.gain = gain;
    const Frames frames(then, now, 640, ground, exposure);
    const std::vector<TemporalMatch> matches = frames.match(frames.truth(), 0);
    EXPECT_GT(matches.size(), 100u) << gain;
    const Errors errors = errorsOf(frames, matches);
    EXPECT_LT(errors.nees, 2) << gain << ": the expected value";
    EXPECT_LT(errors.wrong, 0.1) << gain;
  }
}

TEST(MatchOverTime, FindsThemBySearchingAroundAPoorPrediction) {
  for (const int width : {320, 640}) {
    const Frames frames = approach(width);
    CameraMotion poor = frames.truth();
    poor.t *= 0.8;
    poor.R = Eigen::AngleAxisd(0.8 * kDegree, Eigen::Vector3d(1, 1, 0).normalized()) * poor.R;
    const std::vector<TemporalMatch> matches = frames.match(poor, 10);
    EXPECT_GT(matches.size(), 0.6 * static_cast<double>(frames.corners.size())) << width;
    const Errors errors = errorsOf(frames, matches);
    EXPECT_LT(errors.rms, 0.08) << width;
    EXPECT_LT(errors.wrong, 0.03) << width;
    EXPECT_LT(frames.match(poor, 0).size(), matches.size()) << "without searching";
  }
}

TEST(MatchOverTime, UsesTheDepthOfCornersOffTheGround) {
  // A wall across the view; its distance is known.
  Pose then, now;
  then.position = {-0.4, 0, 1.55};
  now.position = {0, 0, 1.5};
  then.pitch = now.pitch = -3 * kDegree;
  const double wall = 4;
  GroundRenderer ground{21};
  ground.boxes = {{{wall, -6, 0}, {wall + 1, 6, 3}}};
  Frames frames(then, now, 320, ground);
  const Eigen::Matrix3d R = now.worldFromOptical();
  std::vector<TrackedCorner> on_wall;
  for (TrackedCorner corner : frames.corners) {
    const Eigen::Vector3d ray = R * frames.rig.ray(corner.u, corner.v);
    const double depth = wall / ray.x();
    if (now.height() + depth * ray.z() < 0.3) continue;  // on the floor before it
    corner.on_plane = false;
    corner.inverse_depth = now.height() / depth;
    corner.inverse_depth_stddev = 0.01;
    on_wall.push_back(corner);
  }
  ASSERT_GT(on_wall.size(), 30U);
  frames.corners = on_wall;
  const std::vector<TemporalMatch> matches = frames.match(frames.truth(), 0);
  EXPECT_GT(matches.size(), 0.7 * static_cast<double>(on_wall.size()));
  for (const TemporalMatch& match : matches) {
    EXPECT_FALSE(match.on_plane);
    EXPECT_EQ(match.inverse_depth_stddev, 0.01);
    const Eigen::Vector2d wanted = frames.wanted(match.now, now.height() / match.inverse_depth);
    EXPECT_LT((match.then - wanted).norm(), 0.5);
  }
}

TEST(MatchOverTime, TakesNothingFromOutsideTheMask) {
  Frames frames = approach();
  const size_t all = frames.match(frames.truth(), 0).size();
  frames.mask.colRange(0, 160) = 0;
  const std::vector<TemporalMatch> matches = frames.match(frames.truth(), 0);
  EXPECT_LT(matches.size(), 0.8 * static_cast<double>(all));
  for (const TemporalMatch& match : matches) EXPECT_GE(match.then.x(), 159.5);
}

TEST(MatchOverTime, FindsNothingInAnotherScene) {
  Frames frames = approach();
  GroundRenderer other(77);
  frames.image_then.assign(other.left(frames.rig, frames.then));
  EXPECT_LT(frames.match(frames.truth(), 10).size(), 0.1 * static_cast<double>(frames.corners.size()));
  frames.corners.clear();
  EXPECT_TRUE(frames.match(frames.truth(), 10).empty());
}

}  // namespace
}  // namespace uav_landing
