#include "landing_markers.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace uav_landing {
namespace {

using visualization_msgs::Marker;

constexpr double kDegree = M_PI / 180;

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

Marker marker(const std_msgs::Header& header, int id, const char* name, int type, double width,
              const std_msgs::ColorRGBA& colour) {
  Marker marker;
  marker.header = header;
  marker.ns = name;
  marker.id = id;
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
  const double length = parameters.runway_length, half = parameters.runway_width / 2;
  const double line = parameters.runway_width / 50;
  Marker surface = marker(header, 0, "runway", Marker::CUBE, length, colour(0.25F, 0.25F, 0.27F, 0.9F));
  surface.scale.y = parameters.runway_width;
  surface.scale.z = line / 10;
  surface.pose.position = point({length / 2, 0, -line / 10});
  Marker outline = marker(header, 1, "runway", Marker::LINE_STRIP, line, colour(1, 1, 1));
  for (const auto& corner :
       {Eigen::Vector3d(0, half, 0), Eigen::Vector3d(length, half, 0), Eigen::Vector3d(length, -half, 0),
        Eigen::Vector3d(0, -half, 0), Eigen::Vector3d(0, half, 0)})
    outline.points.push_back(point(corner));
  Marker centre = marker(header, 2, "runway", Marker::LINE_LIST, line, colour(1, 1, 1));
  const double dash = parameters.runway_width;
  for (double x = dash; x + dash < length; x += 2 * dash) {
    centre.points.push_back(point({x, 0, 0}));
    centre.points.push_back(point({x + dash, 0, 0}));
  }
  markers.insert(markers.end(), {surface, outline, centre});
}

/// Straight on along the approach angle, down to the ground.
Marker glidePath(const std_msgs::Header& header, double line, const LandingResult& estimate,
                 const Eigen::Vector3d& position, const Eigen::Vector2d& direction) {
  Marker glide = marker(header, 4, "glide_path", Marker::LINE_LIST, line, colour(1.0F, 0.8F, 0.1F));
  const double slope = std::tan(estimate.approach_angle);
  if (!estimate.angle_valid || !(slope > 0.001) || !(direction.norm() > 0)) {
    glide.action = Marker::DELETE;
    return glide;
  }
  const Eigen::Vector2d ground = position.head<2>() + direction.normalized() * position.z() / slope;
  glide.points = {point(position), point({ground.x(), ground.y(), 0})};
  return glide;
}

std::string number(const char* format, double value, const char* unknown) {
  if (!std::isfinite(value)) return unknown;
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

std::string numbers(const LandingResult& estimate) {
  std::string text = std::string(toString(estimate.status)) + (estimate.valid() ? "" : ", not valid");
  text += "\nheight " + number("%.2f m", estimate.height_valid ? estimate.height : kUnknown, "-");
  text += "\napproach " +
          number("%.2f deg", estimate.angle_valid ? estimate.approach_angle / kDegree : kUnknown, "-");
  if (estimate.failure) text += "\n" + estimate.failure.message();
  return text;
}

}  // namespace

visualization_msgs::MarkerArray drawLanding(const std_msgs::Header& header, const NodeParameters& parameters,
                                            const LandingResult& estimate,
                                            const std::optional<Eigen::Vector3d>& position,
                                            const Eigen::Vector2d& direction,
                                            const std::deque<Eigen::Vector3d>& track) {
  visualization_msgs::MarkerArray array;
  const double line = parameters.runway_width / 50;
  addRunway(header, parameters, array.markers);

  Marker path = marker(header, 3, "path", Marker::LINE_STRIP, line, colour(0.2F, 0.7F, 1.0F));
  for (const Eigen::Vector3d& p : track) path.points.push_back(point(p));
  if (path.points.size() < 2) path.action = Marker::DELETE;
  array.markers.push_back(path);

  if (position) array.markers.push_back(glidePath(header, line, estimate, *position, direction));

  Marker text = marker(header, 5, "numbers", Marker::TEXT_VIEW_FACING, 0,
                       estimate.valid() ? colour(0.3F, 1.0F, 0.3F) : colour(1.0F, 0.4F, 0.3F));
  text.text = numbers(estimate);
  const Eigen::Vector3d anchor = position        ? *position
                                 : track.empty() ? Eigen::Vector3d::Zero()
                                                 : track.back();
  text.scale.z = std::max(parameters.runway_width / 12, 0.08 * anchor.z());
  text.pose.position = point(anchor + Eigen::Vector3d(0, 0, 3 * text.scale.z));
  array.markers.push_back(text);
  return array;
}

}  // namespace uav_landing
