#include "simulator/approach/lights.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "simulator/approach/renderer.h"
#include "simulator/lens.h"

namespace uav_landing {
namespace {

/// Black ground and sky, seen by a realistic rig from a glide path of 3 degrees; a PAPI and nothing else.
SimulatorParameters darkNight() {
  SimulatorParameters p;
  p.image.width = 320;
  p.image.height = 240;
  makeRealistic(p.left_camera, p.right_camera, p.rig);
  p.surface = {};
  p.surface.runway_brightness = p.surface.grass_brightness = p.surface.marking_brightness = 0;
  p.surface.sky_horizon = p.surface.sky_zenith = p.surface.cloud_contrast = 0;
  p.surface.visibility = 4000;
  p.lights.papi_angle_deg = 3;
  p.lights.brightness = 700;
  return p;
}

/// On the glide path to the aiming point, this many degrees below the horizontal.
CameraPose onPath(const SimulatorParameters& p, double degrees, double distance = 500) {
  const double angle = degrees * kDegree;
  return {{p.runway.aiming_point_distance - distance * std::cos(angle), 4, distance * std::sin(angle)},
          {2 * kDegree, -3 * kDegree, 1.5 * kDegree}};
}

struct Night {
  CameraRig rig;
  cv::Mat left, right;
};
Night rendered(const SimulatorParameters& p, const CameraPose& pose) {
  Night night{makeCameraRig(p).value(), {}, {}};
  const GroundProfile ground(p.profile);
  const Renderer renderer(Scene(p.runway, p.surface, 1), {}, p.image, ground,
                          RunwayLights(p.lights, p.runway, p.surface.visibility, ground));
  renderer.render(night.rig.left, pose, night.left);
  renderer.render(night.rig.right, pose, night.right);
  return night;
}

/// The light around a pixel: its sum and its centre, px.
struct Spot {
  double sum = 0;
  Eigen::Vector2d centre = {0, 0};
};
Spot spotAt(const cv::Mat& image, const Eigen::Vector2d& pixel) {
  constexpr int kAround = 2;
  Spot spot;
  for (int dv = -kAround; dv <= kAround; ++dv)
    for (int du = -kAround; du <= kAround; ++du) {
      const Eigen::Vector2d at(std::lround(pixel.x()) + du, std::lround(pixel.y()) + dv);
      const double grey = image.at<float>(static_cast<int>(at.y()), static_cast<int>(at.x()));
      spot.sum += grey;
      spot.centre += grey * at;
    }
  spot.centre /= spot.sum;
  return spot;
}

/// Units of a PAPI from the one next to the runway outwards: 15 m beside the edge, 9 m apart.
Eigen::Vector3d unit(const SimulatorParameters& p, int i) {
  return {p.runway.aiming_point_distance, 0.5 * p.runway.width + 15 + 9 * i, 0};
}

TEST(RunwayLights, EachPapiUnitShowsWhereTheLensesSay) {
  const SimulatorParameters p = darkNight();
  const CameraPose pose = onPath(p, 3);
  const Night night = rendered(p, pose);
  for (int i = 0; i < 4; ++i) {
    for (const bool right : {false, true}) {
      const Eigen::Vector2d expected = imageOf(p, pose, night.rig.left.calibration.R, right, unit(p, i));
      const Spot spot = spotAt(right ? night.right : night.left, expected);
      EXPECT_NEAR(spot.centre.x(), expected.x(), 0.01) << i << right;
      EXPECT_NEAR(spot.centre.y(), expected.y(), 0.01) << i << right;
    }
  }
}

TEST(RunwayLights, ALampIsAsBrightAsASurfaceOfItsBrightnessSeenThroughHaze) {
  const SimulatorParameters p = darkNight();
  for (const double distance : {200.0, 500.0}) {
    const CameraPose pose = onPath(p, 3, distance);
    const Night night = rendered(p, pose);
    const Eigen::Vector3d outermost = unit(p, 3);
    const double away = (outermost - pose.position).norm();
    // A surface of one square metre covers (f / distance)^2 pixels. A PAPI unit is four times as bright as a
    // lamp of the edges.
    const double expected =
        4 * p.lights.brightness * std::pow(p.left_camera.fx / away, 2) * std::exp(-away / 4000);
    const Eigen::Vector2d pixel = imageOf(p, pose, night.rig.left.calibration.R, false, outermost);
    EXPECT_NEAR(spotAt(night.left, pixel).sum / expected, 1, 0.01) << distance;
  }
}

TEST(RunwayLights, APapiShowsOneMoreWhiteUnitForEveryTwentyMinutesAboveThePath) {
  const SimulatorParameters p = darkNight();
  const std::vector<std::pair<double, int>> white_at{{2.4, 0}, {2.67, 1}, {3, 2}, {3.33, 3}, {3.6, 4}};
  for (const auto& [degrees, white] : white_at) {
    const CameraPose pose = onPath(p, degrees, 800);
    const Night night = rendered(p, pose);
    std::vector<double> sums;
    for (int i = 0; i < 4; ++i)
      sums.push_back(
          spotAt(night.left, imageOf(p, pose, night.rig.left.calibration.R, false, unit(p, i))).sum);
    const double bright = 4 * p.lights.brightness * std::pow(p.left_camera.fx / 800, 2) * std::exp(-0.2);
    const auto is_white = [&](double sum) { return sum > 0.6 * bright; };
    EXPECT_EQ(std::count_if(sums.begin(), sums.end(), is_white), white) << degrees;
    EXPECT_TRUE(std::is_partitioned(sums.rbegin(), sums.rend(), is_white))
        << "the outermost turns white first";
  }
}

TEST(RunwayLights, LampsStandAlongTheEdgesAndAcrossBothEnds) {
  SimulatedRunwayParameters runway;
  runway.length = 600;
  runway.width = 30;
  SimulatedLightsParameters lights;
  EXPECT_TRUE(edgeLights(lights, runway).empty());
  lights.edge_spacing = 60;
  const std::vector<Lamp> lamps = edgeLights(lights, runway);
  const auto along_edges = std::count_if(lamps.begin(), lamps.end(),
                                         [](const Lamp& lamp) { return std::abs(lamp.place.y()) > 15; });
  EXPECT_EQ(along_edges, 2 * 11);
  for (const Lamp& lamp : lamps) {
    const bool beside = std::abs(std::abs(lamp.place.y()) - 16.5) < 1e-9;
    const bool across = lamp.place.x() == -1.5 || lamp.place.x() == 601.5;
    EXPECT_TRUE(beside != across) << lamp.place.transpose();
  }
}

TEST(RunwayLights, ApproachLightsAreBarsEveryThirtyMetresWithACrossbar) {
  SimulatedLightsParameters lights;
  EXPECT_TRUE(approachLights(lights).empty());
  lights.approach_length = 420;
  const std::vector<Lamp> lamps = approachLights(lights);
  double farthest = 0, broadest = 0, broadest_at = 0;
  for (const Lamp& lamp : lamps) {
    EXPECT_EQ(std::fmod(lamp.place.x(), 30), 0);
    farthest = std::min(farthest, lamp.place.x());
    if (std::abs(lamp.place.y()) <= broadest) continue;
    broadest = std::abs(lamp.place.y());
    broadest_at = lamp.place.x();
  }
  EXPECT_EQ(farthest, -420);
  EXPECT_EQ(broadest_at, -300);
  EXPECT_EQ(broadest, 20);
}

TEST(RunwayLights, LampsStandOnGroundThatRises) {
  SimulatorParameters p = darkNight();
  p.profile.slope_before_deg = p.profile.slope_after_deg = 1;
  const CameraPose pose = onPath(p, 4);
  const Night night = rendered(p, pose);
  Eigen::Vector3d lamp = unit(p, 0);
  lamp.z() = lamp.x() * std::tan(1 * kDegree);
  const Eigen::Vector2d expected = imageOf(p, pose, night.rig.left.calibration.R, false, lamp);
  EXPECT_NEAR((spotAt(night.left, expected).centre - expected).norm(), 0, 0.02);
}

TEST(RunwayLights, LampsBehindTheCameraAreNotSeen) {
  const SimulatorParameters p = darkNight();
  CameraPose pose = onPath(p, 3);
  pose.position.x() = p.runway.aiming_point_distance + 40;
  EXPECT_EQ(cv::norm(rendered(p, pose).left, cv::NORM_INF), 0);
}

}  // namespace
}  // namespace uav_landing
