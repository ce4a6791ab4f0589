#include "simulator/approach/renderer.h"

#include <algorithm>
#include <cmath>

namespace uav_landing {

/// A camera in the world, ready to trace rays. Directions are in the runway frame.
struct Renderer::View {
  Eigen::Matrix3f rotation;  ///< from rectified camera axes to the runway frame
  Eigen::Vector3f centre;
};

/// The rays of a square piece of a pixel.
struct Renderer::Sample {
  Eigen::Vector3f direction;         ///< of the middle, not normalised
  Eigen::Vector3f along_u, along_v;  ///< change of the direction over the sides
  float extent;                      ///< see measure()

  /// The square piece of this side around (du, dv) from the pixel's centre, in pixels.
  Sample(const View& view, const PixelRay& ray, float side, float du, float dv) {
    along_u = view.rotation.col(0) * ray.xu + view.rotation.col(1) * ray.yu;
    along_v = view.rotation.col(0) * ray.xv + view.rotation.col(1) * ray.yv;
    direction = view.rotation.col(0) * ray.x + view.rotation.col(1) * ray.y + view.rotation.col(2) +
                du * along_u + dv * along_v;
    along_u *= side;
    along_v *= side;
    measure();
  }

  /// Measures the extent: the range of the z components of its directions. Distances from the horizon are in
  /// this unit.
  void measure() { extent = std::sqrt(along_u.z() * along_u.z() + along_v.z() * along_v.z()); }

  /// Shears the directions, so that ground with this slope along x becomes level.
  void shear(float slope) {
    for (Eigen::Vector3f* v : {&direction, &along_u, &along_v}) v->z() -= slope * v->x();
    measure();
  }

  /// The ground that the sample covers.
  GroundFootprint footprint(const Eigen::Vector3f& centre, float range, float fall) const {
    const Eigen::Vector2f slope = direction.head<2>() / fall;
    const Eigen::Vector2f u = range * (along_u.head<2>() + slope * along_u.z());
    const Eigen::Vector2f v = range * (along_v.head<2>() + slope * along_v.z());
    return {centre.x() + range * direction.x(), centre.y() + range * direction.y(), u, v};
  }
};

/// A sample in axes that are sheared so that its ground is level.
struct Renderer::OnGround {
  Sample sample;
  float height;  ///< of the camera above that ground
};

Renderer::Renderer(Scene scene, std::vector<StandingObject> objects, const SimulatedImageParameters& image,
                   GroundProfile profile, RunwayLights lights)
    : scene_(std::move(scene)),
      objects_(std::move(objects)),
      filter_(image.supersampling, image.blur),
      profile_(std::move(profile)),
      lights_(std::move(lights)) {}

Renderer::OnGround Renderer::onGround(const View& view, const Sample& sample) const {
  OnGround ground{sample, view.centre.z()};
  if (profile_.flat()) return ground;
  const GroundProfile::Line tangent =
      profile_.seen(view.centre.cast<double>(), sample.direction.cast<double>());
  ground.sample.shear(static_cast<float>(tangent.slope));
  ground.height = static_cast<float>(view.centre.z() - tangent.at(view.centre.x()));
  return ground;
}

float Renderer::ground(const View& view, const OnGround& on) const {
  const Sample& sample = on.sample;
  // On the horizon the distance is limited, to where ground can just be told apart from the horizon.
  const float fall = std::max(-sample.direction.z(), 0.25f * sample.extent);
  const float range = on.height / fall;  // in units of the direction, which is not normalised
  const GroundFootprint footprint = sample.footprint(view.centre, range, fall);
  return scene_.ground(footprint, scene_.cover(footprint), range * sample.direction.norm());
}

float Renderer::sky(const Sample& sample, float share) const {
  return scene_.sky(sample.direction.normalized(), share * sample.along_u.norm());
}

float Renderer::mixed(const View& view, const PixelRay& ray) const {
  float sum = 0;
  for (const PixelFilter::Sample& piece : filter_.samples()) {
    const Sample sample(view, ray, filter_.sampleSide(), piece.du, piece.dv);
    // When the horizon passes through a sample, both sides count by their area.
    const OnGround on = onGround(view, sample);
    const float below = std::clamp(0.5f - on.sample.direction.z() / on.sample.extent, 0.0f, 1.0f);
    if (below > 0) sum += piece.weight * below * ground(view, on);
    if (below < 1) sum += piece.weight * (1 - below) * sky(sample);
  }
  return sum;
}

float Renderer::pixel(const View& view, const PixelRay& ray) const {
  // One sample is exact enough for sky. It is also enough for one material well below the horizon. There the
  // perspective within the sample moves its mean by less than 1 / (12 kFar) of its side.
  constexpr float kFar = 16.0f;
  const Sample whole(view, ray, filter_.support(), 0.0f, 0.0f);
  const float even = filter_.equivalentSide() / filter_.support();
  const OnGround on = onGround(view, whole);
  if (on.sample.direction.z() > on.sample.extent) return sky(whole, even);
  const float fall = -on.sample.direction.z();
  if (fall < kFar * even * on.sample.extent) return mixed(view, ray);
  const float range = on.height / fall;
  const GroundFootprint footprint = on.sample.footprint(view.centre, range, fall);
  const RunwaySurface::Cover cover = scene_.cover(footprint);
  if (!scene_.even(footprint, cover)) return mixed(view, ray);
  return scene_.ground(footprint.scaled(even), cover, range * whole.direction.norm());
}

void Renderer::render(const SimulatedCamera& camera, const CameraPose& pose, cv::Mat& image) const {
  image.create(camera.calibration.height, camera.calibration.width, CV_32F);
  render(camera, pose, cv::Rect({}, image.size()), image);
}

void Renderer::render(const SimulatedCamera& camera, const CameraPose& pose, const cv::Rect& part,
                      cv::Mat& image) const {
  const Eigen::Matrix3d rotation = runwayFromOptical(pose.attitude);
  const Eigen::Vector3d centre = pose.position + camera.offset_x * rotation.col(0);
  const View view{rotation.cast<float>(), centre.cast<float>()};
  cv::parallel_for_(cv::Range(part.y, part.br().y), [&](const cv::Range& rows) {
    for (int row = rows.start; row < rows.end; ++row) {
      const PixelRay* rays = &camera.rays[static_cast<size_t>(row) * image.cols + part.x];
      std::transform(rays, rays + part.width, image.ptr<float>(row) + part.x,
                     [&](const PixelRay& ray) { return pixel(view, ray); });
    }
  });
  const PlacedCamera placed{camera, rotation, centre};
  drawObjects(objects_, placed, filter_, part, image);
  lights_.draw(placed, filter_, part, image);
}

}  // namespace uav_landing
