#include "landing_markers.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace uav_landing {
namespace {

using visualization_msgs::Marker;

constexpr double kDegree = M_PI / 180;

/// By which rviz tells markers apart.
struct Identity {
  int id;
  const char* name;
};
constexpr Identity kSurface{0, "runway"}, kOutline{1, "runway"}, kCentreLine{2, "runway"}, kPath{3, "path"};
constexpr Identity kGlidePath{4, "glide_path"}, kNumbers{5, "numbers"}, kAircraft{6, "aircraft"};
constexpr Identity kUncertainty{7, "uncertainty"};

geometry_msgs::Point point(const Eigen::Vector3d& p) {
  geometry_msgs::Point out;
  out.x = p.x();
  out.y = p.y();
  out.z = p.z();
  return out;
}

std_msgs::ColorRGBA colour(float r, float g, float b, float a = 1) {
  std_msgs::ColorRGBA out;
  out.r = r;
  out.g = g;
  out.b = b;
  out.a = a;
  return out;
}

Marker marker(const std_msgs::Header& header, const Identity& identity, int type, double width,
              const std_msgs::ColorRGBA& colour) {
  Marker marker;
  marker.header = header;
  marker.ns = identity.name;
  marker.id = identity.id;
  marker.type = type;
  marker.action = Marker::ADD;
  marker.pose.orientation.w = 1;
  marker.scale.x = width;
  marker.color = colour;
  return marker;
}

/// Outline, surface and centre line.
void addRunway(const std_msgs::Header& header, const NodeParameters& parameters,
               std::vector<Marker>& markers) {
  const double length = parameters.drawn_runway_length, half = parameters.drawn_runway_width / 2;
  const double line = parameters.drawn_runway_width / 50;
  Marker surface = marker(header, kSurface, Marker::CUBE, length, colour(0.25F, 0.25F, 0.27F, 0.9F));
  surface.scale.y = parameters.drawn_runway_width;
  surface.scale.z = line / 10;
  surface.pose.position = point({length / 2, 0, -line / 10});
  Marker outline = marker(header, kOutline, Marker::LINE_STRIP, line, colour(1, 1, 1));
  for (const auto& corner :
       {Eigen::Vector3d(0, half, 0), Eigen::Vector3d(length, half, 0), Eigen::Vector3d(length, -half, 0),
        Eigen::Vector3d(0, -half, 0), Eigen::Vector3d(0, half, 0)})
    outline.points.push_back(point(corner));
  Marker centre = marker(header, kCentreLine, Marker::LINE_LIST, line, colour(1, 1, 1));
  const double dash = parameters.drawn_runway_width;
  for (double x = dash; x + dash < length; x += 2 * dash) {
    centre.points.push_back(point({x, 0, 0}));
    centre.points.push_back(point({x + dash, 0, 0}));
  }
  markers.insert(markers.end(), {surface, outline, centre});
}

/// Straight on along the approach angle, down to the ground.
Marker glidePath(const std_msgs::Header& header, double line, const LandingResult& estimate,
                 const Eigen::Vector3d& position, const Eigen::Vector2d& direction) {
  Marker glide = marker(header, kGlidePath, Marker::LINE_LIST, line / 2, colour(1.0F, 0.8F, 0.1F));
  const double slope = std::tan(estimate.approach_angle);
  if (!estimate.angle_valid || !(slope > 0.001) || !(direction.norm() > 0)) {
    glide.action = Marker::DELETE;
    return glide;
  }
  const Eigen::Vector2d ground = position.head<2>() + direction.normalized() * position.z() / slope;
  glide.points = {point(position), point({ground.x(), ground.y(), 0})};
  return glide;
}

/// A glider's outline, of the given wing span: nose along the camera's axis. It is a sign, not to scale.
Marker silhouette(const std_msgs::Header& header, double span, const DrawnAircraft& aircraft) {
  Marker shape = marker(header, kAircraft, Marker::TRIANGLE_LIST, 1, colour(0.95F, 0.95F, 1.0F));
  shape.scale.y = shape.scale.z = 1;
  // Forward, left, up in wing spans, three corners each.
  constexpr double kTriangles[][3] = {{0.45, 0, 0},     {0.1, 0.05, 0},  {0.1, -0.05, 0},  // nose
                                      {0.1, 0.05, 0},   {-0.5, 0, 0},    {0.1, -0.05, 0},  // fuselage
                                      {0.12, 0, 0.02},  {0, 0.5, 0.05},  {-0.08, 0, 0.02},
                                      {0.12, 0, 0.02},                                      // wings
                                      {-0.08, 0, 0.02}, {0, -0.5, 0.05},                    //
                                      {-0.4, 0, 0.01},  {-0.5, 0.15, 0}, {-0.5, -0.15, 0},  // tail
                                      {-0.35, 0, 0},    {-0.5, 0, 0.16}, {-0.5, 0, 0}};     // fin
  for (const auto& [forward, left, up] : kTriangles) {
    const Eigen::Vector3d optical(-left, -up, forward);
    shape.points.push_back(point(aircraft.position + span * (aircraft.runway_from_camera * optical)));
    // Colours of their own leave rviz's light out, in which flat wings are black.
    const float shade = up > 0.1 || forward < -0.3 ? 0.7F : 1.0F;
    shape.colors.push_back(colour(shade, shade, shade));
  }
  return shape;
}

/// Whether the uncertainty is known and small enough to be drawn over the runway.
bool hasEllipsoid(const NodeParameters& parameters, const DrawnAircraft& aircraft) {
  return aircraft.stddev.maxCoeff() < parameters.drawn_runway_length / 6;
}

/// Where the aircraft is with three sigma, ellipsoid_scale times larger; as thick as a line at least.
Marker ellipsoid(const std_msgs::Header& header, double line, const NodeParameters& parameters,
                 const DrawnAircraft& aircraft) {
  Marker shape = marker(header, kUncertainty, Marker::SPHERE, 1, colour(1.0F, 0.65F, 0.3F, 0.8F));
  if (!hasEllipsoid(parameters, aircraft)) {
    shape.action = Marker::DELETE;
    return shape;
  }
  shape.pose.position = point(aircraft.position);
  const Eigen::Vector3d size = (6 * parameters.ellipsoid_scale * aircraft.stddev).cwiseMax(line);
  shape.scale.x = size.x();
  shape.scale.y = size.y();
  shape.scale.z = size.z();
  return shape;
}

std::string number(const char* format, double value, const char* unknown) {
  if (!std::isfinite(value)) return unknown;
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

// Short lines: the aircraft may be near the edge of the view.
std::string numbers(const LandingResult& estimate) {
  std::string text = std::string(toString(estimate.status)) + (estimate.valid() ? "" : ", not valid");
  text += "\nheight " + number("%.2f m", estimate.height_valid ? estimate.height : kUnknown, "-");
  text +=
      "\nsink rate " + number("%.2f m/s", estimate.height_valid ? -estimate.vertical_speed : kUnknown, "-");
  text += "\napproach " +
          number("%.2f deg", estimate.angle_valid ? estimate.approach_angle / kDegree : kUnknown, "-");
  text += "\nprotection level " + number("%.2f m", estimate.height_protection_level, "-");
  if (estimate.failure) text += "\n" + estimate.failure.message();
  return text;
}

}  // namespace

visualization_msgs::MarkerArray drawLanding(const std_msgs::Header& header, const NodeParameters& parameters,
                                            const LandingResult& estimate,
                                            const std::optional<DrawnAircraft>& aircraft,
                                            const Eigen::Vector2d& direction,
                                            const std::deque<Eigen::Vector3d>& track) {
  visualization_msgs::MarkerArray array;
  const double line = parameters.drawn_runway_width / 50;
  addRunway(header, parameters, array.markers);

  Marker path = marker(header, kPath, Marker::LINE_STRIP, line / 2, colour(0.2F, 0.7F, 1.0F));
  for (const Eigen::Vector3d& p : track) path.points.push_back(point(p));
  if (path.points.size() < 2) path.action = Marker::DELETE;
  array.markers.push_back(path);

  if (aircraft) {
    array.markers.push_back(glidePath(header, line, estimate, aircraft->position, direction));
    array.markers.push_back(silhouette(header, parameters.drawn_runway_width / 2.5, *aircraft));
    array.markers.push_back(ellipsoid(header, line, parameters, *aircraft));
  } else {
    // rviz would go on showing them where the aircraft was.
    for (const Identity& shown : {kGlidePath, kAircraft, kUncertainty}) {
      array.markers.push_back(marker(header, shown, Marker::CUBE, 0, {}));
      array.markers.back().action = Marker::DELETE;
    }
  }

  Marker text = marker(header, kNumbers, Marker::TEXT_VIEW_FACING, 0,
                       estimate.valid() ? colour(0.3F, 1.0F, 0.3F) : colour(1.0F, 0.4F, 0.3F));
  text.text = numbers(estimate);
  if (aircraft && hasEllipsoid(parameters, *aircraft))
    text.text += "\nellipsoid 3 sigma" + number(" x %g", parameters.ellipsoid_scale, "");
  const Eigen::Vector3d anchor = aircraft        ? aircraft->position
                                 : track.empty() ? Eigen::Vector3d::Zero()
                                                 : track.back();
  text.scale.z = std::max(parameters.drawn_runway_width / 14, 0.08 * anchor.z());
  // The middle of the text, so high that its last line is above the aircraft.
  const auto lines = 1 + std::count(text.text.begin(), text.text.end(), '\n');
  text.pose.position =
      point(anchor + Eigen::Vector3d(0, 0, 0.75 * static_cast<double>(lines) * text.scale.z));
  array.markers.push_back(text);
  return array;
}

}  // namespace uav_landing
