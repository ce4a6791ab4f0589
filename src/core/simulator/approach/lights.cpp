#include "simulator/approach/lights.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;
constexpr double kBesideEdge = 1.5;                       // m, from the surface to the lamps along it
constexpr double kThresholdSpacing = 3, kEndSpacing = 6;  // m, between lamps across the ends
constexpr double kBarSpacing = 30, kCrossbar = 300;       // m, before the threshold
constexpr int kBarLamps = 2, kCrossbarLamps = 10;         // on each side of the middle one
constexpr double kInBar = 1, kInCrossbar = 2;             // m, from lamp to lamp
constexpr double kPapiBeside = 15, kPapiSpacing = 9;      // m, from the runway's edge; from unit to unit
constexpr double kPapiBrighter = 4;                       // than other lamps
constexpr double kRed = 0.3;                              // share of a white lamp's light that gets through
constexpr double kNearest = 1;                            // m ahead of the camera
constexpr int kIterations = 8;
constexpr double kSettled = 0.01;    // px
constexpr double kLeastSpacing = 1;  // m

/// The raw pixel that sees a direction (x, y, 1), by Newton's method over the pixels' rays; nothing where no
/// pixel does.
std::optional<Eigen::Vector2d> pixelOf(const SimulatedCamera& camera, const Eigen::Vector2d& direction) {
  const int width = camera.calibration.width, height = camera.calibration.height;
  Eigen::Vector2d pixel(0.5 * (width - 1), 0.5 * (height - 1));
  double step = 0;
  for (int i = 0; i < kIterations; ++i) {
    const Eigen::Vector2d before = pixel;
    const int u = std::clamp(static_cast<int>(std::lround(pixel.x())), 0, width - 1);
    const int v = std::clamp(static_cast<int>(std::lround(pixel.y())), 0, height - 1);
    const PixelRay& ray = camera.rays[static_cast<size_t>(v) * width + u];
    Eigen::Matrix2d slopes;
    slopes << ray.xu, ray.xv, ray.yu, ray.yv;
    pixel = Eigen::Vector2d(u, v) + slopes.inverse() * (direction - Eigen::Vector2d(ray.x, ray.y));
    step = (pixel - before).norm();
  }
  const bool inside =
      step < kSettled && pixel.x() > -1 && pixel.x() < width && pixel.y() > -1 && pixel.y() < height;
  return inside ? std::optional<Eigen::Vector2d>(pixel) : std::nullopt;
}

void addRow(double x, double spacing, int on_each_side, std::vector<Lamp>& lamps) {
  for (int i = -on_each_side; i <= on_each_side; ++i) lamps.push_back({{x, i * spacing, 0}});
}

void append(const std::vector<Lamp>& more, std::vector<Lamp>& lamps) {
  lamps.insert(lamps.end(), more.begin(), more.end());
}

}  // namespace

std::vector<Lamp> edgeLights(const SimulatedLightsParameters& lights,
                             const SimulatedRunwayParameters& runway) {
  std::vector<Lamp> lamps;
  if (lights.edge_spacing == 0) return lamps;
  const double aside = 0.5 * runway.width + kBesideEdge;
  const double spacing = std::max(lights.edge_spacing, kLeastSpacing);
  const int count = static_cast<int>(runway.length / spacing);
  for (int i = 0; i <= count; ++i)
    for (const double y : {-aside, aside}) lamps.push_back({{i * spacing, y, 0}});
  const auto half = [&](double spacing) { return static_cast<int>(0.5 * runway.width / spacing); };
  addRow(-kBesideEdge, kThresholdSpacing, half(kThresholdSpacing), lamps);
  addRow(runway.length + kBesideEdge, kEndSpacing, half(kEndSpacing), lamps);
  return lamps;
}

std::vector<Lamp> approachLights(const SimulatedLightsParameters& lights) {
  std::vector<Lamp> lamps;
  for (double x = kBarSpacing; x <= lights.approach_length; x += kBarSpacing)
    addRow(-x, kInBar, kBarLamps, lamps);
  if (lights.approach_length >= kCrossbar) addRow(-kCrossbar, kInCrossbar, kCrossbarLamps, lamps);
  return lamps;
}

std::vector<Lamp> papi(const SimulatedLightsParameters& lights, const SimulatedRunwayParameters& runway) {
  std::vector<Lamp> lamps;
  if (lights.papi_angle_deg == 0) return lamps;
  // Minutes of arc above the glide path; the unit next to the runway is turned up by most.
  double y = 0.5 * runway.width + kPapiBeside;
  for (const double minutes : {30, 10, -10, -30}) {
    const double angle = (lights.papi_angle_deg + minutes / 60) * kDegree;
    lamps.push_back({{runway.aiming_point_distance, y, 0}, angle});
    y += kPapiSpacing;
  }
  return lamps;
}

RunwayLights::RunwayLights(const SimulatedLightsParameters& lights, const SimulatedRunwayParameters& runway,
                           double visibility, const GroundProfile& ground)
    : brightness_(lights.brightness), visibility_(visibility) {
  append(edgeLights(lights, runway), lamps_);
  append(approachLights(lights), lamps_);
  append(papi(lights, runway), lamps_);
  for (Lamp& lamp : lamps_) lamp.place.z() += ground.height(lamp.place.x());
}

double RunwayLights::flux(const Lamp& lamp, const Eigen::Vector3d& seen, double focal_length) const {
  const double distance = seen.norm();
  double brightness = brightness_ * std::exp(-distance / visibility_);
  if (lamp.white_above) {
    const double elevation = std::asin(-seen.z() / distance);
    brightness *= kPapiBrighter * (elevation > *lamp.white_above ? 1 : kRed);
  }
  return brightness * std::pow(focal_length / distance, 2);
}

void RunwayLights::draw(const PlacedCamera& view, const PixelFilter& filter, const cv::Rect& part,
                        cv::Mat& image) const {
  const Eigen::Matrix3d to_camera = view.rotation.transpose();
  for (const Lamp& lamp : lamps_) {
    const Eigen::Vector3d seen = lamp.place - view.centre, ray = to_camera * seen;
    if (ray.z() < kNearest) continue;
    const auto pixel = pixelOf(view.camera, ray.head<2>() / ray.z());
    if (!pixel) continue;
    const double sum = flux(lamp, seen, view.camera.calibration.K(0, 0));
    const int left = static_cast<int>(std::floor(pixel->x())), top = static_cast<int>(std::floor(pixel->y()));
    const cv::Rect reached = cv::Rect(left - 1, top - 1, 4, 4) & part;
    for (int v = reached.y; v < reached.br().y; ++v)
      for (int u = reached.x; u < reached.br().x; ++u)
        image.at<float>(v, u) += static_cast<float>(sum * filter.weightOf(pixel->x() - u, pixel->y() - v));
  }
}

}  // namespace uav_landing
