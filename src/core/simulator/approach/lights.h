#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "simulator/approach/objects.h"
#include "simulator/approach/pixel_filter.h"
#include "simulator/ground/ground_profile.h"
#include "uav_landing/simulator/parameters.h"

namespace uav_landing {

/// A lamp in the runway frame.
struct Lamp {
  Eigen::Vector3d place;                             ///< m
  std::optional<double> white_above = std::nullopt;  ///< of a PAPI unit: red below this angle, rad
};

/// Lamps along the runway's edges and across its ends.
std::vector<Lamp> edgeLights(const SimulatedLightsParameters& lights,
                             const SimulatedRunwayParameters& runway);
/// Bars of lamps before the threshold on the extended centre line, with a crossbar 300 m before it.
std::vector<Lamp> approachLights(const SimulatedLightsParameters& lights);
/// Four units to the left of the runway beside the aiming point, turned up as ICAO Annex 14 (5.3.5) says.
std::vector<Lamp> papi(const SimulatedLightsParameters& lights, const SimulatedRunwayParameters& runway);

/// Lamps of a runway. They are so small that each shows as a point, as bright as the lens's blur lets it be.
/// Nothing hides them: no hill, and no object.
class RunwayLights {
 public:
  RunwayLights() = default;
  /// The lamps stand on the ground's profile. visibility: m, of the haze.
  RunwayLights(const SimulatedLightsParameters& lights, const SimulatedRunwayParameters& runway,
               double visibility, const GroundProfile& ground);

  /// Adds their light to a part of an image (32-bit float). filter: the one that the ground was drawn with.
  void draw(const PlacedCamera& view, const PixelFilter& filter, const cv::Rect& part, cv::Mat& image) const;

 private:
  /// Sum over the pixels of the grey levels that a lamp adds. seen: the lamp from the camera, runway axes, m.
  double flux(const Lamp& lamp, const Eigen::Vector3d& seen, double focal_length) const;

  std::vector<Lamp> lamps_;
  double brightness_ = 0, visibility_ = 1;
};

}  // namespace uav_landing
