#include "autopilot_messages.h"

#include <tf2_eigen/tf2_eigen.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <sstream>

#include "aircraft_tilt.h"
#include "geometry/cross_matrix.h"
#include "landing_messages.h"

namespace uav_landing {
namespace {

using Covariance = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;
using CovarianceMap = Eigen::Map<const Covariance>;

constexpr double kMaxYawStddev = 0.1;  // rad; the yaw is unknown before the runway is seen

/// Cosine of the angle between the pose's up axis and the vertical.
double cosTiltOf(const geometry_msgs::PoseWithCovarianceStamped& pose) {
  Eigen::Isometry3d runway_from_aircraft;
  tf2::fromMsg(pose.pose.pose, runway_from_aircraft);
  return cosTilt(runway_from_aircraft.linear());
}

// Angles count from east to the left, but headings count from north to the right.
Eigen::Isometry3d enuFromRunway(const AutopilotParameters& parameters) {
  const double angle = M_PI / 2 - parameters.runway_heading_deg * M_PI / 180;
  return Eigen::Isometry3d(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()));
}

/// Turns both halves of the covariance of a pose or a twist.
Covariance turned(const Covariance& covariance, const Eigen::Matrix3d& rotation) {
  Covariance turn = Covariance::Zero();
  turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = rotation;
  return turn * covariance * turn.transpose();
}

bool yawKnown(const CovarianceMap& of_pose) { return of_pose(5, 5) <= kMaxYawStddev * kMaxYawStddev; }

bool positiveDefinite(const Covariance& covariance) {
  return covariance.allFinite() && covariance.llt().info() == Eigen::Success;
}

}  // namespace

std::optional<sensor_msgs::Range> autopilotRange(const sensor_msgs::Range& height,
                                                 const geometry_msgs::PoseWithCovarianceStamped& pose,
                                                 const AutopilotParameters& parameters) {
  const double cos_tilt = cosTiltOf(pose);
  const double distance = height.range / cos_tilt;
  if (!(cos_tilt >= kMinCosTilt) || !(distance >= 0) || !(distance <= parameters.max_range))
    return std::nullopt;
  sensor_msgs::Range range = height;
  range.max_range = static_cast<float>(parameters.max_range);
  range.range = static_cast<float>(distance);
  return range;
}

std::string whyNoRange(const sensor_msgs::Range& height, const geometry_msgs::PoseWithCovarianceStamped& pose,
                       const AutopilotParameters& parameters) {
  if (!std::isfinite(height.range)) return "no valid height";
  std::ostringstream why;
  const double cos_tilt = cosTiltOf(pose);
  if (!(cos_tilt >= kMinCosTilt))
    why << "what is estimated is tilted by " << tiltInDegrees(cos_tilt)
        << " deg, as a camera is and no aircraft: base_frame or its static tf is missing";
  else
    why << "the surface is not within 0 to " << parameters.max_range << " m (max_range), at a height of "
        << height.range << " m";
  return why.str();
}

bool headingKnown(const AutopilotParameters& parameters) { return parameters.runway_heading_deg >= 0; }

std::optional<geometry_msgs::PoseWithCovarianceStamped> autopilotPose(
    const geometry_msgs::PoseWithCovarianceStamped& pose, const AutopilotParameters& parameters) {
  if (!headingKnown(parameters)) return std::nullopt;
  const CovarianceMap in_runway(pose.pose.covariance.data());
  const double known = parameters.max_position_stddev * parameters.max_position_stddev;
  if (!(in_runway(0, 0) <= known) || !(in_runway(1, 1) <= known)) return std::nullopt;

  const Eigen::Isometry3d enu_from_runway = enuFromRunway(parameters);
  Eigen::Isometry3d runway_from_aircraft;
  tf2::fromMsg(pose.pose.pose, runway_from_aircraft);
  if (!(cosTilt(runway_from_aircraft.linear()) >= kMinCosTilt)) return std::nullopt;
  const Eigen::Isometry3d enu_from_aircraft = enu_from_runway * runway_from_aircraft;
  const Covariance covariance = turned(in_runway, enu_from_runway.linear());
  if (!enu_from_aircraft.matrix().allFinite() || !positiveDefinite(covariance)) return std::nullopt;

  std_msgs::Header header = pose.header;
  header.frame_id = parameters.enu_frame;
  return *poseMessage(header, enu_from_aircraft, covariance);
}

std::string whyNoVelocity(const geometry_msgs::PoseWithCovarianceStamped& pose) {
  if (!(cosTiltOf(pose) >= kMinCosTilt)) return "the attitude is not that of an aircraft";
  if (!yawKnown(CovarianceMap(pose.pose.covariance.data()))) return "the runway's direction is not seen";
  return "it has no definite covariance";
}

std::optional<geometry_msgs::TwistWithCovarianceStamped> autopilotVelocity(
    const geometry_msgs::TwistWithCovarianceStamped& twist,
    const geometry_msgs::PoseWithCovarianceStamped& pose, const AutopilotParameters& parameters) {
  const CovarianceMap of_pose(pose.pose.covariance.data()), of_twist(twist.twist.covariance.data());
  Eigen::Isometry3d runway_from_aircraft;
  tf2::fromMsg(pose.pose.pose, runway_from_aircraft);
  if (!headingKnown(parameters) || !yawKnown(of_pose) ||
      !(cosTilt(runway_from_aircraft.linear()) >= kMinCosTilt))
    return std::nullopt;
  const Eigen::Matrix3d enu_from_runway = enuFromRunway(parameters).linear();
  const Eigen::Matrix3d enu_from_aircraft = enu_from_runway * runway_from_aircraft.linear();
  Eigen::Vector3d linear, angular;
  tf2::fromMsg(twist.twist.twist.linear, linear);
  tf2::fromMsg(twist.twist.twist.angular, angular);
  linear = enu_from_aircraft * linear;
  angular = enu_from_aircraft * angular;
  Eigen::Matrix<double, 6, 3> by_attitude;
  by_attitude << -crossMatrix(linear), -crossMatrix(angular);
  by_attitude *= enu_from_runway;
  const Covariance covariance =
      turned(of_twist, enu_from_aircraft) +
      Covariance(by_attitude * of_pose.bottomRightCorner<3, 3>() * by_attitude.transpose());
  if (!linear.allFinite() || !angular.allFinite() || !positiveDefinite(covariance)) return std::nullopt;

  return *twistMessage(twist.header.stamp, parameters.enu_frame, {linear, angular, covariance});
}

}  // namespace uav_landing
