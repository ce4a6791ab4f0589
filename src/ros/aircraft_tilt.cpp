#include "aircraft_tilt.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "body_pose.h"

namespace uav_landing {
namespace {

/// Advice when the mounting turns the aircraft's up axis too far from the camera's.
std::string wrongMounting(const Eigen::Matrix3d& rectified_from_child, const std::string& left_frame) {
  // Upside down while the camera looks ahead: the aircraft's z axis is down, or the camera's y axis is up.
  const bool upside_down = rectified_from_child(1, 2) > kMinCosTilt;
  const bool looks_ahead = rectified_from_child(2, 0) > kMinCosTilt;
  if (upside_down && looks_ahead)
    return "its z axis must be up (x forward, y left), and the frame_id of camera_info an optical frame "
           "(z forward, x right, y down)";
  return "the frame_id of camera_info must be an optical frame (z forward, x right, y down), in static tf " +
         left_frame + " is not";
}

}  // namespace

double tiltInDegrees(double cos_tilt) {
  // Rotations are orthogonal to the last digit but one, so the cosine may slightly exceed 1.
  return std::round(std::acos(std::clamp(cos_tilt, -1.0, 1.0)) * 180 / M_PI);
}

Failure wrongTilt(const RigFrames::Child& child, const Eigen::Matrix3d& rectified_from_child,
                  const LandingResult& camera, const std::string& left_frame) {
  if (!child.isAircraft()) return {};
  const double of_level_camera = -rectified_from_child(1, 2);
  const double in_flight = cosTilt(runwayFromCamera(camera) * rectified_from_child);  // NaN: not known
  const bool wrong_mounting = of_level_camera < kMinCosTilt;
  const bool wrong_in_flight = in_flight < kMinCosTilt;
  const bool something_valid = camera.height_valid || camera.angle_valid;
  if (!wrong_mounting && !(wrong_in_flight && something_valid)) return {};
  std::ostringstream why;
  why << child.frame << " is tilted by " << tiltInDegrees(wrong_in_flight ? in_flight : of_level_camera)
      << " deg: ";
  if (wrong_mounting)
    why << wrongMounting(rectified_from_child, left_frame);
  else
    why << "its static tf is wrong, or the attitude is";
  return {Reason::kTransformInvalid, why.str()};
}

}  // namespace uav_landing
