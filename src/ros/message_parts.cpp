#include "message_parts.h"

#include "message_arrays.h"

namespace uav_landing {

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

HeightOrigin parseOrigin(const std::string& name) {
  for (int i = 0; i <= static_cast<int>(HeightOrigin::kPrediction); ++i)
    if (name == toString(static_cast<HeightOrigin>(i))) return static_cast<HeightOrigin>(i);
  return HeightOrigin::kNone;
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
  toArray(motion.turn_rate, message.turn_rate);
  toArray(motion.covariance, message.covariance);
  message.approach_angle = motion.angle;
  message.approach_angle_variance = motion.angle_variance;
  message.row_motion = motion.row_motion;
  message.row_motion_limit = motion.row_motion_limit;
  toArray(motion.normal, message.normal);
  toArray(motion.normal_covariance, message.normal_covariance);
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
  fromArray(message.turn_rate, motion.turn_rate);
  fromArray(message.normal, motion.normal);
  fromArray(message.normal_covariance, motion.normal_covariance);
  fromArray(message.covariance, motion.covariance);
  motion.angle = message.approach_angle;
  motion.angle_variance = message.approach_angle_variance;
  motion.row_motion = message.row_motion;
  motion.row_motion_limit = message.row_motion_limit;
  return motion;
}

RunwayPosition toMessage(const ApproachAngleResult::Runway& runway) {
  RunwayPosition message;
  message.reason = runway.failure.message();
  message.y = runway.y;
  message.y_variance = runway.y_variance;
  for (int i = 0; i < kCentreSources; ++i) {
    message.y_without[i] = runway.y_without.without[i].value;
    message.y_variance_without[i] = runway.y_without.without[i].variance;
  }
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
  for (int i = 0; i < kCentreSources; ++i)
    runway.y_without.without[i] = {message.y_without[i], message.y_variance_without[i]};
  runway.width = message.width;
  runway.width_variance = message.width_variance;
  runway.threshold_failure = parseFailure(message.threshold_reason);
  runway.x = message.x;
  runway.x_variance = message.x_variance;
  runway.x_systematic_variance = message.x_systematic_variance;
  return runway;
}

RunwaySight toMessage(const ApproachAngleResult::Sight& sight) {
  RunwaySight message;
  message.reason = sight.failure.message();
  toArray(sight.position, message.position);
  toArray(sight.covariance, message.covariance);
  message.yaw = sight.yaw;
  message.yaw_variance = sight.yaw_variance;
  message.width = sight.width;
  message.width_variance = sight.width_variance;
  message.length = sight.length;
  message.length_variance = sight.length_variance;
  toArray(sight.height_without, message.height_without);
  toArray(sight.variance_without, message.variance_without);
  message.height_by_chart = sight.height_by_chart;
  message.disparity = sight.disparity;
  message.disparity_variance = sight.disparity_variance;
  message.height_by_bias = sight.height_by_bias;
  message.size_over_chart = sight.size_over_chart;
  message.size_over_chart_variance = sight.size_over_chart_variance;
  return message;
}

ApproachAngleResult::Sight toResult(const RunwaySight& message) {
  ApproachAngleResult::Sight sight;
  sight.failure = parseFailure(message.reason);
  fromArray(message.position, sight.position);
  fromArray(message.covariance, sight.covariance);
  sight.yaw = message.yaw;
  sight.yaw_variance = message.yaw_variance;
  sight.width = message.width;
  sight.width_variance = message.width_variance;
  sight.length = message.length;
  sight.length_variance = message.length_variance;
  fromArray(message.height_without, sight.height_without);
  fromArray(message.variance_without, sight.variance_without);
  sight.height_by_chart = message.height_by_chart;
  sight.disparity = message.disparity;
  sight.disparity_variance = message.disparity_variance;
  sight.height_by_bias = message.height_by_bias;
  sight.size_over_chart = message.size_over_chart;
  sight.size_over_chart_variance = message.size_over_chart_variance;
  return sight;
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

}  // namespace uav_landing
