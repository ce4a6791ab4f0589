#include "conversions.h"

#include <cmath>

#include "message_arrays.h"
#include "message_parts.h"

namespace uav_landing {

StereoDepth toMessage(const StereoDepthResult& result, const std_msgs::Header& header, double compute_ms) {
  StereoDepth message;
  message.header = header;
  message.reason = result.failure.message();
  message.corners = static_cast<uint32_t>(result.corners);
  const size_t count = result.points.size();
  message.u.resize(count);
  message.v.resize(count);
  message.disparity.resize(count);
  message.disparity_stddev.resize(count);
  message.on_plane.resize(count);
  for (size_t i = 0; i < count; ++i) {
    const StereoDepthResult::Point& point = result.points[i];
    message.u[i] = point.u;
    message.v[i] = point.v;
    message.disparity[i] = point.disparity;
    message.disparity_stddev[i] = point.disparity_stddev;
    message.on_plane[i] = point.on_plane;
  }
  toArray(result.plane.g, message.plane);
  toArray(result.plane.covariance, message.plane_covariance);
  toArray(result.row_covariance, message.plane_row_covariance);
  toArray(result.plane_rate, message.plane_rate);
  toArray(result.plane_by_rate, message.plane_by_rate);
  message.plane_lasting_share = result.lasting_share;
  toArray(result.below.g, message.plane_below);
  toArray(result.below.covariance, message.plane_below_covariance);
  message.surface_curvature = result.curvature;
  message.surface_curvature_variance = result.curvature_variance;
  message.residual_stddev = result.residual_stddev;
  message.surface_variance = result.surface_variance;
  message.disparity_bias_stddev = result.disparity_bias_stddev;
  message.row_bias_stddev = result.row_bias_stddev;
  toArray(result.vertical_rotation.w, message.vertical_rotation);
  toArray(result.vertical_rotation.covariance, message.vertical_rotation_covariance);
  message.vertical_rotation_count = static_cast<uint32_t>(result.vertical_rotation.count);
  toArray(result.baseline_direction.t, message.baseline_direction);
  toArray(result.baseline_direction.covariance, message.baseline_direction_covariance);
  message.row_agreement = result.row_agreement;
  message.photometric_agreement = result.photometric_agreement;
  message.left_repeated = result.left_repeated;
  message.right_repeated = result.right_repeated;
  message.from_search = result.from_search;
  message.skew = result.skew;
  message.compute_ms = compute_ms;
  return message;
}

StereoDepthResult toResult(const StereoDepth& message) {
  StereoDepthResult result;
  result.stamp = message.header.stamp.toSec();
  result.failure = parseFailure(message.reason);
  result.corners = static_cast<int>(message.corners);
  const size_t count = message.u.size();
  for (const size_t other : {message.v.size(), message.disparity.size(), message.disparity_stddev.size(),
                             message.on_plane.size()}) {
    if (other == count) continue;
    result.failure = {Reason::kInputInvalid, "u, v, disparity, disparity_stddev, on_plane: lengths differ"};
    return result;
  }
  result.points.resize(count);
  for (size_t i = 0; i < count; ++i)
    result.points[i] = {message.u[i], message.v[i], message.disparity[i], message.disparity_stddev[i],
                        message.on_plane[i] != 0};
  fromArray(message.plane, result.plane.g);
  fromArray(message.plane_covariance, result.plane.covariance);
  fromArray(message.plane_row_covariance, result.row_covariance);
  fromArray(message.plane_rate, result.plane_rate);
  fromArray(message.plane_by_rate, result.plane_by_rate);
  // A publisher that does not know this field leaves it 0.
  result.lasting_share = message.plane_lasting_share == 0 ? kUnknown : message.plane_lasting_share;
  fromArray(message.plane_below, result.below.g);
  fromArray(message.plane_below_covariance, result.below.covariance);
  // A publisher that does not know this field leaves it zero.
  if (result.below.g.isZero()) result.below = GroundPlane();
  result.curvature = message.surface_curvature;
  result.curvature_variance = message.surface_curvature_variance;
  result.residual_stddev = message.residual_stddev;
  result.surface_variance = message.surface_variance;
  result.disparity_bias_stddev = message.disparity_bias_stddev;
  result.row_bias_stddev = message.row_bias_stddev;
  fromArray(message.vertical_rotation, result.vertical_rotation.w);
  fromArray(message.vertical_rotation_covariance, result.vertical_rotation.covariance);
  result.vertical_rotation.count = static_cast<int>(message.vertical_rotation_count);
  fromArray(message.baseline_direction, result.baseline_direction.t);
  fromArray(message.baseline_direction_covariance, result.baseline_direction.covariance);
  result.row_agreement = message.row_agreement;
  result.photometric_agreement = message.photometric_agreement;
  result.left_repeated = message.left_repeated;
  result.right_repeated = message.right_repeated;
  result.from_search = message.from_search;
  result.skew = message.skew;
  return result;
}

ApproachAngle toMessage(const ApproachAngleResult& result, const std_msgs::Header& header,
                        double compute_ms) {
  ApproachAngle message;
  message.header = header;
  message.reason = result.failure.message();
  message.left = toMessage(result.left);
  message.right = toMessage(result.right);
  toArray(result.vanishing_direction, message.vanishing_direction);
  toArray(result.vanishing_covariance, message.vanishing_covariance);
  message.other_runway_probability = result.other_runway_probability;
  toArray(result.n_vp, message.n_vp);
  toArray(result.n_vp_covariance, message.n_vp_covariance);
  toArray(result.n, message.n);
  toArray(result.n_covariance, message.n_covariance);
  message.step = toMessage(result.step);
  message.window = toMessage(result.window);
  toArray(result.foe, message.foe);
  toArray(result.foe_covariance, message.foe_covariance);
  message.runway = toMessage(result.runway);
  message.sight = toMessage(result.sight);
  message.imu = toMessage(result.imu);
  toArray(result.plane_by_turns.mean, message.plane_by_turns);
  toArray(result.plane_by_turns.covariance, message.plane_by_turns_covariance);
  message.readout_time = result.readout.time;
  message.readout_time_variance = result.readout.variance;
  message.compute_ms = compute_ms;
  return message;
}

ApproachAngleResult toResult(const ApproachAngle& message) {
  ApproachAngleResult result;
  result.stamp = message.header.stamp.toSec();
  result.failure = parseFailure(message.reason);
  result.left = toResult(message.left);
  result.right = toResult(message.right);
  fromArray(message.vanishing_direction, result.vanishing_direction);
  fromArray(message.vanishing_covariance, result.vanishing_covariance);
  result.other_runway_probability = message.other_runway_probability;
  fromArray(message.n_vp, result.n_vp);
  fromArray(message.n_vp_covariance, result.n_vp_covariance);
  fromArray(message.n, result.n);
  fromArray(message.n_covariance, result.n_covariance);
  result.step = toResult(message.step);
  result.window = toResult(message.window);
  fromArray(message.foe, result.foe);
  fromArray(message.foe_covariance, result.foe_covariance);
  result.runway = toResult(message.runway);
  result.sight = toResult(message.sight);
  result.imu = toResult(message.imu);
  fromArray(message.plane_by_turns, result.plane_by_turns.mean);
  fromArray(message.plane_by_turns_covariance, result.plane_by_turns.covariance);
  result.readout = {message.readout_time, message.readout_time_variance};
  return result;
}

LandingEstimate toMessage(const LandingResult& result, const std_msgs::Header& header,
                          const std::string& child_frame_id, double skew, double compute_ms) {
  LandingEstimate message;
  message.header = header;
  message.child_frame_id = child_frame_id;
  message.status = static_cast<uint8_t>(result.status);
  message.reason = result.failure.message();
  message.valid = result.valid();
  message.height_valid = result.height_valid;
  message.angle_valid = result.angle_valid;
  message.height = result.height;
  message.height_variance = result.height_variance;
  message.raw_height = result.raw_height;
  message.raw_height_variance = result.raw_height_variance;
  message.points_height = result.points_height;
  message.vertical_speed = result.vertical_speed;
  message.vertical_speed_variance = result.vertical_speed_variance;
  message.approach_angle = result.approach_angle;
  message.approach_angle_variance = result.approach_angle_variance;
  message.raw_approach_angle = result.raw_approach_angle;
  message.raw_approach_angle_variance = result.raw_approach_angle_variance;
  message.pitch = result.pitch;
  message.pitch_variance = result.pitch_variance;
  message.roll = result.roll;
  message.roll_variance = result.roll_variance;
  message.yaw_known = std::isfinite(result.yaw);
  message.yaw_reason = result.yaw_failure.message();
  message.yaw = result.yaw;
  message.yaw_variance = result.yaw_variance;
  message.other_runway_probability = result.other_runway_probability;
  toArray(result.foe, message.foe);
  toArray(result.velocity, message.velocity);
  toArray(result.angular_velocity, message.angular_velocity);
  toArray(result.twist_covariance, message.twist_covariance);
  message.innovation = result.innovation;
  message.innovation_variance = result.innovation_variance;
  message.rejected = result.rejected;
  message.consecutive_rejections = static_cast<uint32_t>(result.consecutive_rejections);
  message.resets = static_cast<uint32_t>(result.resets);
  message.x_known = std::isfinite(result.x);
  message.y_known = std::isfinite(result.y);
  message.x = result.x;
  message.x_variance = result.x_variance;
  message.y = result.y;
  message.y_variance = result.y_variance;
  message.y_protection_level = result.y_protection_level;
  message.height_above_runway = result.height_above_runway;
  message.height_above_runway_variance = result.height_above_runway_variance;
  message.height_above_runway_known = result.height_above_runway_known;
  message.height_above_runway_protection_level = result.height_above_runway_protection_level;
  message.height_above_runway_limit = result.height_above_runway_limit;
  message.height_origin = toString(result.height_origin);
  message.runway_reason = result.runway_failure.message();
  message.runway_width = result.runway_width;
  message.runway_width_variance = result.runway_width_variance;
  message.width_height = result.width_height;
  message.width_height_variance = result.width_height_variance;
  toArray(result.rig_rotation.w, message.rig_rotation);
  toArray(result.rig_rotation.covariance, message.rig_rotation_covariance);
  message.height_protection_level = result.height_protection_level;
  message.height_alert_limit = result.height_alert_limit;
  message.protection_source = result.protection_source;
  for (const TestResult& test : result.tests) message.tests.push_back(toMessage(test));
  message.skew = skew;
  message.compute_ms = compute_ms;
  return message;
}

LandingResult toResult(const LandingEstimate& message) {
  LandingResult result;
  result.stamp = message.header.stamp.toSec();
  result.status = static_cast<Status>(message.status);
  result.failure = parseFailure(message.reason);
  result.height_valid = message.height_valid;
  result.angle_valid = message.angle_valid;
  result.height = message.height;
  result.height_variance = message.height_variance;
  result.raw_height = message.raw_height;
  result.raw_height_variance = message.raw_height_variance;
  result.points_height = message.points_height;
  result.vertical_speed = message.vertical_speed;
  result.vertical_speed_variance = message.vertical_speed_variance;
  result.approach_angle = message.approach_angle;
  result.approach_angle_variance = message.approach_angle_variance;
  result.raw_approach_angle = message.raw_approach_angle;
  result.raw_approach_angle_variance = message.raw_approach_angle_variance;
  result.pitch = message.pitch;
  result.pitch_variance = message.pitch_variance;
  result.roll = message.roll;
  result.roll_variance = message.roll_variance;
  result.yaw = message.yaw;
  result.yaw_variance = message.yaw_variance;
  result.yaw_failure = parseFailure(message.yaw_reason);
  result.other_runway_probability = message.other_runway_probability;
  fromArray(message.foe, result.foe);
  fromArray(message.velocity, result.velocity);
  fromArray(message.angular_velocity, result.angular_velocity);
  fromArray(message.twist_covariance, result.twist_covariance);
  result.innovation = message.innovation;
  result.innovation_variance = message.innovation_variance;
  result.rejected = message.rejected;
  result.consecutive_rejections = static_cast<int>(message.consecutive_rejections);
  result.resets = static_cast<int>(message.resets);
  result.x = message.x;
  result.x_variance = message.x_variance;
  result.y = message.y;
  result.y_variance = message.y_variance;
  result.y_protection_level = message.y_protection_level;
  result.height_above_runway = message.height_above_runway;
  result.height_above_runway_variance = message.height_above_runway_variance;
  result.height_above_runway_known = message.height_above_runway_known;
  result.height_above_runway_protection_level = message.height_above_runway_protection_level;
  result.height_above_runway_limit = message.height_above_runway_limit;
  result.height_origin = parseOrigin(message.height_origin);
  result.runway_failure = parseFailure(message.runway_reason);
  result.runway_width = message.runway_width;
  result.runway_width_variance = message.runway_width_variance;
  result.width_height = message.width_height;
  result.width_height_variance = message.width_height_variance;
  fromArray(message.rig_rotation, result.rig_rotation.w);
  fromArray(message.rig_rotation_covariance, result.rig_rotation.covariance);
  result.height_protection_level = message.height_protection_level;
  result.height_alert_limit = message.height_alert_limit;
  result.protection_source = message.protection_source;
  for (const ConsistencyTest& test : message.tests) result.tests.push_back(toResult(test));
  return result;
}

}  // namespace uav_landing
