#include "simulator/approach/objects.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace uav_landing {
namespace {

/// One corner of the box. bits: one for each axis, which picks low or high.
Eigen::Vector3d corner(const StandingObject& object, int bits) {
  Eigen::Vector3d point;
  for (int axis = 0; axis < 3; ++axis)
    point[axis] = (bits >> axis & 1) != 0 ? object.high[axis] : object.low[axis];
  return point;
}

/// Where a ray from the origin enters a box. axis: normal of the side through which it enters.
struct Entry {
  float range;
  int axis;
};
std::optional<Entry> enter(const Eigen::Array3f& low, const Eigen::Array3f& high,
                           const Eigen::Array3f& direction) {
  const Eigen::Array3f one = low / direction, other = high / direction;
  const Eigen::Array3f first = one.min(other), last = one.max(other);
  Entry entry{};
  entry.range = first.maxCoeff(&entry.axis);
  if (!(entry.range > 0) || entry.range > last.minCoeff()) return std::nullopt;
  return entry;
}

/// A rectangle of directions (x, y, 1) in the rectified camera.
struct Outline {
  float left = 1e9f, right = -1e9f, top = 1e9f, bottom = -1e9f;
  void include(float x, float y) {
    left = std::min(left, x);
    right = std::max(right, x);
    top = std::min(top, y);
    bottom = std::max(bottom, y);
  }
  /// margin: allows for the size of a pixel.
  bool contains(const PixelRay& ray, float margin) const {
    return ray.x > left - margin && ray.x < right + margin && ray.y > top - margin && ray.y < bottom + margin;
  }
};

/// An object as one camera sees it. The corners are relative to the camera; the outline has its directions.
struct Visible {
  Eigen::Array3f low, high;
  float brightness;
  Outline outline;
};

Outline outlineOf(const StandingObject& object, const Eigen::Matrix3d& rotation,
                  const Eigen::Vector3d& centre) {
  Outline outline;
  int behind = 0;
  for (int bits = 0; bits < 8; ++bits) {
    const Eigen::Vector3d point = rotation.transpose() * (corner(object, bits) - centre);
    if (point.z() > 1e-3)
      outline.include(point.x() / point.z(), point.y() / point.z());
    else
      ++behind;
  }
  if (behind == 8) return {};
  if (behind > 0) return {-1e9f, 1e9f, -1e9f, 1e9f};  // it reaches past the camera, so it can be anywhere
  return outline;
}

/// Sides along the runway are darker, and the top is lighter.
float shadeOf(int axis) { return std::array<float, 3>{1.0f, 0.75f, 1.15f}[axis]; }

/// Grey level where the ray meets the nearest object.
std::optional<float> trace(const std::vector<const Visible*>& objects, const Eigen::Array3f& direction) {
  float nearest = std::numeric_limits<float>::infinity();
  std::optional<float> grey;
  for (const Visible* object : objects) {
    const std::optional<Entry> entry = enter(object->low, object->high, direction);
    if (!entry || entry->range >= nearest) continue;
    nearest = entry->range;
    grey = object->brightness * shadeOf(entry->axis);
  }
  return grey;
}

/// Draws the objects over the ground's grey level in one pixel.
float drawPixel(const std::vector<const Visible*>& objects, const PixelRay& ray,
                const Eigen::Matrix3f& rotation, const PixelFilter& filter, float ground) {
  float sum = 0;
  for (const PixelFilter::Sample& piece : filter.samples()) {
    const Eigen::Vector3f direction(ray.x + piece.du * ray.xu + piece.dv * ray.xv,
                                    ray.y + piece.du * ray.yu + piece.dv * ray.yv, 1.0f);
    sum += piece.weight * trace(objects, (rotation * direction).array()).value_or(ground);
  }
  return sum;
}

}  // namespace

std::vector<StandingObject> placeObjects(const SimulatedObjectsParameters& p, double runway_width,
                                         uint64_t seed) {
  cv::RNG random(seed * 0x9E3779B97F4A7C15ULL + 3);
  std::vector<StandingObject> objects;
  const auto place = [&](double length, double width, double height) {
    const double side = random.uniform(0, 2) == 0 ? -1 : 1;
    const double x = random.uniform(p.first, std::max(p.first, p.last));
    const double y = side * (0.5 * runway_width + p.clearance + 0.5 * width + random.uniform(0.0, p.band));
    StandingObject object;
    object.low = Eigen::Vector3d(x, y - 0.5 * width, 0).cast<float>();
    object.high = Eigen::Vector3d(x + length, y + 0.5 * width, height).cast<float>();
    object.brightness = random.uniform(40.0f, 200.0f);
    objects.push_back(object);
  };
  for (int i = 0; i < p.boxes; ++i) {
    const double length = p.box_size * random.uniform(0.3, 1.0),
                 width = p.box_size * random.uniform(0.3, 1.0);
    place(length, width, p.box_size * random.uniform(0.2, 1.0));
  }
  for (int i = 0; i < p.poles; ++i)
    place(p.pole_width, p.pole_width, p.pole_height * random.uniform(0.5, 1.0));
  return objects;
}

void drawObjects(const std::vector<StandingObject>& objects, const PlacedCamera& view,
                 const PixelFilter& filter, const cv::Rect& part, cv::Mat& image) {
  if (objects.empty()) return;
  const Eigen::Vector3d& centre = view.centre;
  std::vector<Visible> visible;
  for (const StandingObject& object : objects)
    visible.push_back({object.low.array() - centre.cast<float>().array(),
                       object.high.array() - centre.cast<float>().array(), object.brightness,
                       outlineOf(object, view.rotation, centre)});
  const Eigen::Matrix3f axes = view.rotation.cast<float>();
  const PixelFilter finer = filter.finer();  // only the samples show outlines
  cv::parallel_for_(cv::Range(part.y, part.br().y), [&](const cv::Range& rows) {
    std::vector<const Visible*> here;
    for (int row = rows.start; row < rows.end; ++row) {
      const PixelRay* rays = &view.camera.rays[static_cast<size_t>(row) * image.cols];
      for (int column = part.x; column < part.br().x; ++column) {
        here.clear();
        for (const Visible& object : visible)
          if (object.outline.contains(rays[column], rays[column].xu)) here.push_back(&object);
        float& grey = image.at<float>(row, column);
        if (!here.empty()) grey = drawPixel(here, rays[column], axes, finer, grey);
      }
    }
  });
}

}  // namespace uav_landing
