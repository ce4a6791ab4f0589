#include "conversions.h"

#include <cmath>

namespace uav_landing {
namespace {

template <class Vector, class Array>
void toArray(const Vector& vector, Array& array) {
  // Symmetric 3x3 and 6x6 matrices and vectors: row major or column major makes no difference to a
  // covariance, but the messages promise row major.
  for (int row = 0, i = 0; row < vector.rows(); ++row)
    for (int column = 0; column < vector.cols(); ++column) array[i++] = vector(row, column);
}

template <class Array, class Vector>
void fromArray(const Array& array, Vector& vector) {
  for (int row = 0, i = 0; row < vector.rows(); ++row)
    for (int column = 0; column < vector.cols(); ++column) vector(row, column) = array[i++];
}

ImageLines toMessage(const ApproachAngleResult::View& view) {
  ImageLines message;
  message.reason = view.failure.message();
  message.lines.reserve(view.lines.size());
  for (const auto& line : view.lines) {
    Line out;
    out.u1 = line.a.x();
    out.v1 = line.a.y();
    out.u2 = line.b.x();
    out.v2 = line.b.y();
    out.inlier = line.inlier;
    message.lines.push_back(out);
  }
  toArray(view.vanishing_direction, message.vanishing_direction);
  toArray(view.vanishing_covariance, message.vanishing_covariance);
  return message;
}

ApproachAngleResult::View toResult(const ImageLines& message) {
  ApproachAngleResult::View view;
  view.failure = parseFailure(message.reason);
  view.lines.reserve(message.lines.size());
  for (const Line& line : message.lines)
    view.lines.push_back({{line.u1, line.v1}, {line.u2, line.v2}, static_cast<bool>(line.inlier)});
  fromArray(message.vanishing_direction, view.vanishing_direction);
  fromArray(message.vanishing_covariance, view.vanishing_covariance);
  return view;
}

ConsistencyTest toMessage(const TestResult& test) {
  ConsistencyTest message;
  message.name = test.name;
  message.difference = test.difference;
  message.variance = test.variance;
  message.ratio = test.ratio;
  message.limit = test.limit;
  message.failed = test.failed();
  message.consecutive_failures = static_cast<uint32_t>(test.consecutive_failures);
  return message;
}

TestResult toResult(const ConsistencyTest& message) {
  TestResult test;
  test.name = message.name;
  test.difference = message.difference;
  test.variance = message.variance;
  test.ratio = message.ratio;
  test.limit = message.limit;
  test.consecutive_failures = static_cast<int>(message.consecutive_failures);
  return test;
}

Motion toMessage(const ApproachAngleResult::Motion& motion) {
  Motion message;
  message.reason = motion.failure.message();
  message.duration = motion.duration;
  message.matches = static_cast<uint32_t>(motion.matches);
  message.inliers = static_cast<uint32_t>(motion.inliers);
  toArray(motion.rotation, message.rotation);
  toArray(motion.translation_over_height, message.translation_over_height);
  toArray(motion.covariance, message.covariance);
  message.approach_angle = motion.angle;
  message.approach_angle_variance = motion.angle_variance;
  return message;
}

ApproachAngleResult::Motion toResult(const Motion& message) {
  ApproachAngleResult::Motion motion;
  motion.failure = parseFailure(message.reason);
  motion.duration = message.duration;
  motion.matches = static_cast<int>(message.matches);
  motion.inliers = static_cast<int>(message.inliers);
  fromArray(message.rotation, motion.rotation);
  fromArray(message.translation_over_height, motion.translation_over_height);
  fromArray(message.covariance, motion.covariance);
  motion.angle = message.approach_angle;
  motion.angle_variance = message.approach_angle_variance;
  return motion;
}

RunwayPosition toMessage(const ApproachAngleResult::Runway& runway) {
  RunwayPosition message;
  message.reason = runway.failure.message();
  message.y = runway.y;
  message.y_variance = runway.y_variance;
  message.width = runway.width;
  message.width_variance = runway.width_variance;
  message.threshold_reason = runway.threshold_failure.message();
  message.x = runway.x;
  message.x_variance = runway.x_variance;
  message.x_systematic_variance = runway.x_systematic_variance;
  return message;
}

ApproachAngleResult::Runway toResult(const RunwayPosition& message) {
  ApproachAngleResult::Runway runway;
  runway.failure = parseFailure(message.reason);
  runway.y = message.y;
  runway.y_variance = message.y_variance;
  runway.width = message.width;
  runway.width_variance = message.width_variance;
  runway.threshold_failure = parseFailure(message.threshold_reason);
  runway.x = message.x;
  runway.x_variance = message.x_variance;
  runway.x_systematic_variance = message.x_systematic_variance;
  return runway;
}

ImuPrior toMessage(const AttitudePrior& prior) {
  ImuPrior message;
  message.reason = prior.failure.message();
  toArray(prior.normal, message.normal);
  toArray(prior.normal_covariance, message.normal_covariance);
  message.duration = prior.duration;
  toArray(prior.rotation, message.rotation);
  toArray(prior.rotation_covariance, message.rotation_covariance);
  return message;
}

AttitudePrior toResult(const ImuPrior& message) {
  AttitudePrior prior;
  prior.failure = parseFailure(message.reason);
  fromArray(message.normal, prior.normal);
  fromArray(message.normal_covariance, prior.normal_covariance);
  prior.duration = message.duration;
  fromArray(message.rotation, prior.rotation);
  fromArray(message.rotation_covariance, prior.rotation_covariance);
  return prior;
}

}  // namespace

Failure parseFailure(const std::string& reason) {
  if (reason.empty()) return {};
  const size_t colon = reason.find(':');
  const std::string name = reason.substr(0, colon);
  const size_t detail = colon == std::string::npos ? colon : reason.find_first_not_of(' ', colon + 1);
  for (int i = 1; i <= static_cast<int>(Reason::kRigBent); ++i)
    if (name == toString(static_cast<Reason>(i)))
      return {static_cast<Reason>(i), detail == std::string::npos ? "" : reason.substr(detail)};
  return {Reason::kInputInvalid, reason};
}

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
  toArray(result.below.g, message.plane_below);
  toArray(result.below.covariance, message.plane_below_covariance);
  message.surface_curvature = result.curvature;
  message.surface_curvature_variance = result.curvature_variance;
  message.residual_stddev = result.residual_stddev;
  message.surface_variance = result.surface_variance;
  message.disparity_bias_stddev = result.disparity_bias_stddev;
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
  fromArray(message.plane_below, result.below.g);
  fromArray(message.plane_below_covariance, result.below.covariance);
  // Who does not know the field leaves it empty.
  if (result.below.g.isZero()) result.below = GroundPlane();
  result.curvature = message.surface_curvature;
  result.curvature_variance = message.surface_curvature_variance;
  result.residual_stddev = message.residual_stddev;
  result.surface_variance = message.surface_variance;
  result.disparity_bias_stddev = message.disparity_bias_stddev;
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
  toArray(result.n_vp, message.n_vp);
  toArray(result.n_vp_covariance, message.n_vp_covariance);
  toArray(result.n, message.n);
  toArray(result.n_covariance, message.n_covariance);
  message.step = toMessage(result.step);
  message.window = toMessage(result.window);
  toArray(result.foe, message.foe);
  toArray(result.foe_covariance, message.foe_covariance);
  message.runway = toMessage(result.runway);
  message.imu = toMessage(result.imu);
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
  fromArray(message.n_vp, result.n_vp);
  fromArray(message.n_vp_covariance, result.n_vp_covariance);
  fromArray(message.n, result.n);
  fromArray(message.n_covariance, result.n_covariance);
  result.step = toResult(message.step);
  result.window = toResult(message.window);
  fromArray(message.foe, result.foe);
  fromArray(message.foe_covariance, result.foe_covariance);
  result.runway = toResult(message.runway);
  result.imu = toResult(message.imu);
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
  message.yaw = result.yaw;
  message.yaw_variance = result.yaw_variance;
  toArray(result.foe, message.foe);
  toArray(result.velocity, message.velocity);
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
  fromArray(message.foe, result.foe);
  fromArray(message.velocity, result.velocity);
  result.innovation = message.innovation;
  result.innovation_variance = message.innovation_variance;
  result.rejected = message.rejected;
  result.consecutive_rejections = static_cast<int>(message.consecutive_rejections);
  result.resets = static_cast<int>(message.resets);
  result.x = message.x;
  result.x_variance = message.x_variance;
  result.y = message.y;
  result.y_variance = message.y_variance;
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
