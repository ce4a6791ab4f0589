#include "landing_markers.h"

#include <tf2_eigen/tf2_eigen.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

namespace uav_landing {
namespace {

using visualization_msgs::Marker;

constexpr double kDegree = M_PI / 180;
constexpr double kDashes = 20;  // of the centre line, gaps included

// The scene beside the runway is drawn in units of the aircraft's height, down to this share of the runway's
// width. So it looks the same in the view of rviz/landing.rviz, which is fixed to landing_view.
constexpr double kLeastUnit = 0.1;
// Point that is looked at before an aircraft has been seen: above the threshold, in widths of the runway.
constexpr double kIdleHeight = 0.2;
const Eigen::Vector3d kViewPoint(-3.4, -0.7, 0.9);  // from the aircraft
// Above the horizon and the aircraft: middle of the foot of the text's last line.
const Eigen::Vector3d kNumbersFoot(0, -0.36, 1.0);
// Height of letters, thickness of lines, span of the aircraft.
constexpr double kLetters = 0.11, kLine = 0.012, kSpan = 0.6;
constexpr double kLineSpacing = 1.0;  // of rviz, in heights of letters
constexpr size_t kTextWidth = 42;     // letters; longer lines do not fit into the view

/// Name and number by which rviz tells markers apart.
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
void addRunway(const std_msgs::Header& header, double length, double width, std::vector<Marker>& markers) {
  const double half = width / 2, line = width / 50;
  Marker surface = marker(header, kSurface, Marker::TRIANGLE_LIST, 1, colour(1, 1, 1));
  surface.scale.y = surface.scale.z = 1;
  const double below = -line / 10;
  for (const auto& corner : {Eigen::Vector3d(0, half, below), Eigen::Vector3d(0, -half, below),
                             Eigen::Vector3d(length, half, below), Eigen::Vector3d(length, half, below),
                             Eigen::Vector3d(0, -half, below), Eigen::Vector3d(length, -half, below)}) {
    surface.points.push_back(point(corner));
    surface.colors.push_back(colour(0.25F, 0.25F, 0.27F));  // rviz's light would make it black
  }
  Marker outline = marker(header, kOutline, Marker::LINE_STRIP, line, colour(1, 1, 1));
  for (const auto& corner :
       {Eigen::Vector3d(0, half, 0), Eigen::Vector3d(length, half, 0), Eigen::Vector3d(length, -half, 0),
        Eigen::Vector3d(0, -half, 0), Eigen::Vector3d(0, half, 0)})
    outline.points.push_back(point(corner));
  Marker centre = marker(header, kCentreLine, Marker::LINE_LIST, line, colour(1, 1, 1));
  // In proportion to the length: with the width, all dashes would move at every measurement.
  const double dash = length / kDashes;
  for (double x = dash; x + dash < length; x += 2 * dash) {
    centre.points.push_back(point({x, 0, 0}));
    centre.points.push_back(point({x + dash, 0, 0}));
  }
  markers.insert(markers.end(), {surface, outline, centre});
}

/// Draws the straight path along the approach angle, down to the ground.
Marker glidePath(const std_msgs::Header& header, double line, const LandingResult& estimate,
                 const Eigen::Vector3d& position, const Eigen::Vector2d& direction) {
  Marker glide = marker(header, kGlidePath, Marker::LINE_LIST, line, colour(1.0F, 0.8F, 0.1F));
  const double slope = std::tan(estimate.approach_angle);
  if (!estimate.angle_valid || !(slope > 0.001) || !(direction.norm() > 0)) {
    glide.action = Marker::DELETE;
    return glide;
  }
  const Eigen::Vector2d ground = position.head<2>() + direction.normalized() * position.z() / slope;
  glide.points = {point(position), point({ground.x(), ground.y(), 0})};
  return glide;
}

/// A glider's outline with the given wing span and its nose along the camera's axis. It is a symbol, not to
/// scale.
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
    // With colours of their own, triangles ignore rviz's light, which would make flat wings black.
    const float shade = up > 0.1 || forward < -0.3 ? 0.7F : 1.0F;
    shape.colors.push_back(colour(shade, shade, shade));
  }
  return shape;
}

/// Whether the uncertainty is known and small enough to be drawn over the runway.
bool hasEllipsoid(const NodeParameters& parameters, const DrawnAircraft& aircraft) {
  return aircraft.stddev.maxCoeff() < parameters.drawn_runway_length / 6;
}

/// Ellipsoid of the position's three sigma, ellipsoid_scale times larger. Three ellipses about its axes are
/// drawn, so that it hides nothing. No axis is longer than one unit, because the axis along the runway would
/// leave the view.
Marker ellipsoid(const std_msgs::Header& header, double unit, const NodeParameters& parameters,
                 const DrawnAircraft& aircraft) {
  Marker shape =
      marker(header, kUncertainty, Marker::LINE_LIST, kLine * unit / 2, colour(1.0F, 0.65F, 0.3F, 0.8F));
  if (!hasEllipsoid(parameters, aircraft)) {
    shape.action = Marker::DELETE;
    return shape;
  }
  const Eigen::Vector3d half = (3 * parameters.ellipsoid_scale * aircraft.stddev).cwiseMin(unit / 2);
  constexpr int kSides = 32;
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < 2 * kSides; ++i) {
      const double turn = 2 * M_PI / kSides * ((i + 1) / 2);
      Eigen::Vector3d p = Eigen::Vector3d::Zero();
      p[(axis + 1) % 3] = half[(axis + 1) % 3] * std::cos(turn);
      p[(axis + 2) % 3] = half[(axis + 2) % 3] * std::sin(turn);
      shape.points.push_back(point(aircraft.position + p));
    }
  }
  return shape;
}

std::string number(const char* format, double value, const char* unknown) {
  if (!std::isfinite(value)) return unknown;
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

/// Breaks the text at spaces into lines of at most kTextWidth letters.
std::string wrapped(const std::string& text) {
  std::istringstream words(text);
  std::string word, lines;
  size_t length = 0;
  while (words >> word) {
    const bool fits = length == 0 || length + 1 + word.size() <= kTextWidth;
    if (!lines.empty()) lines += fits ? ' ' : '\n';
    length = fits && length > 0 ? length + 1 + word.size() : word.size();
    lines += word;
  }
  return lines;
}

std::string numbers(const LandingResult& estimate) {
  std::string text = std::string(toString(estimate.status)) + (estimate.valid() ? "" : ", not valid");
  text += "\nheight " + number("%.2f m", estimate.height_valid ? estimate.height : kUnknown, "-");
  text +=
      "\nsink rate " + number("%.2f m/s", estimate.height_valid ? -estimate.vertical_speed : kUnknown, "-");
  text += "\napproach " +
          number("%.2f deg", estimate.angle_valid ? estimate.approach_angle / kDegree : kUnknown, "-");
  text += "\nprotection level " + number("%.2f m", estimate.height_protection_level, "-");
  if (estimate.failure) text += "\n" + wrapped(estimate.failure.message());
  return text;
}

Marker numbersAt(const std_msgs::Header& header, const LandingResult& estimate, const std::string& text,
                 const Eigen::Vector3d& anchor, double unit) {
  Marker shown = marker(header, kNumbers, Marker::TEXT_VIEW_FACING, 0,
                        estimate.valid() ? colour(0.3F, 1.0F, 0.3F) : colour(1.0F, 0.4F, 0.3F));
  shown.text = text;
  shown.scale.z = kLetters * unit;
  // rviz needs the middle of the text.
  const auto lines = static_cast<double>(1 + std::count(text.begin(), text.end(), '\n'));
  shown.pose.position =
      point(anchor + unit * kNumbersFoot + Eigen::Vector3d(0, 0, lines * kLineSpacing * shown.scale.z / 2));
  return shown;
}

}  // namespace

LandingScene drawLanding(const std_msgs::Header& header, const NodeParameters& parameters,
                         const LandingResult& estimate, const std::optional<DrawnAircraft>& aircraft,
                         const Eigen::Vector2d& direction, const std::deque<Eigen::Vector3d>& track,
                         double runway_width) {
  const double width = std::isfinite(runway_width) ? runway_width : parameters.drawn_runway_width;
  const Eigen::Vector3d anchor = aircraft        ? aircraft->position
                                 : track.empty() ? Eigen::Vector3d(0, 0, kIdleHeight * width)
                                                 : track.back();
  const double unit = std::max(anchor.z(), kLeastUnit * width);
  LandingScene scene;
  std::vector<Marker>& markers = scene.markers.markers;
  addRunway(header, parameters.drawn_runway_length, width, markers);

  Marker path = marker(header, kPath, Marker::LINE_STRIP, kLine * unit, colour(0.2F, 0.7F, 1.0F));
  for (const Eigen::Vector3d& p : track) path.points.push_back(point(p));
  if (path.points.size() < 2) path.action = Marker::DELETE;
  markers.push_back(path);

  if (aircraft) {
    markers.push_back(glidePath(header, kLine * unit, estimate, aircraft->position, direction));
    markers.push_back(silhouette(header, kSpan * unit, *aircraft));
    markers.push_back(ellipsoid(header, unit, parameters, *aircraft));
  } else {
    // Without this, rviz would go on showing them at the aircraft's last place.
    for (const Identity& shown : {kGlidePath, kAircraft, kUncertainty}) {
      markers.push_back(marker(header, shown, Marker::CUBE, 0, {}));
      markers.back().action = Marker::DELETE;
    }
  }

  std::string text = numbers(estimate);
  if (aircraft && hasEllipsoid(parameters, *aircraft))
    text += "\nellipsoid 3 sigma" + number(" x %g", parameters.ellipsoid_scale, "");
  markers.push_back(numbersAt(header, estimate, text, anchor, unit));

  scene.view = tf2::eigenToTransform(Eigen::Isometry3d(Eigen::Translation3d(anchor + unit * kViewPoint)));
  scene.view.header = header;
  scene.view.child_frame_id = "landing_view";
  return scene;
}

}  // namespace uav_landing
