#include "autopilot_messages.h"

#include <tf2_eigen/tf2_eigen.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <sstream>

namespace uav_landing {
namespace {

using Covariance = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;
using CovarianceMap = Eigen::Map<const Covariance>;

constexpr double kMinCosTilt = 0.5;

/// Of the up axis against the vertical.
double cosTilt(const Eigen::Isometry3d& runway_from_aircraft) { return runway_from_aircraft.linear()(2, 2); }

/// Of the pose's up axis against the vertical.
double cosTilt(const geometry_msgs::PoseWithCovarianceStamped& pose) {
  Eigen::Isometry3d runway_from_aircraft;
  tf2::fromMsg(pose.pose.pose, runway_from_aircraft);
  return cosTilt(runway_from_aircraft);
}

bool positiveDefinite(const Covariance& covariance) {
  return covariance.allFinite() && covariance.llt().info() == Eigen::Success;
}

}  // namespace

std::optional<sensor_msgs::Range> autopilotRange(const sensor_msgs::Range& height,
                                                 const geometry_msgs::PoseWithCovarianceStamped& pose,
                                                 const AutopilotParameters& parameters) {
  const double cos_tilt = cosTilt(pose);
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
  const double cos_tilt = cosTilt(pose);
  if (!(cos_tilt >= kMinCosTilt))
    why << "what is estimated is tilted by " << std::round(std::acos(cos_tilt) * 180 / M_PI)
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

  // Angles count from east to the left, headings from north to the right.
  const double angle = M_PI / 2 - parameters.runway_heading_deg * M_PI / 180;
  const Eigen::Isometry3d enu_from_runway(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()));
  Eigen::Isometry3d runway_from_aircraft;
  tf2::fromMsg(pose.pose.pose, runway_from_aircraft);
  if (!(cosTilt(runway_from_aircraft) >= kMinCosTilt)) return std::nullopt;
  const Eigen::Isometry3d enu_from_aircraft = enu_from_runway * runway_from_aircraft;
  Covariance turn = Covariance::Zero();
  turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = enu_from_runway.linear();
  const Covariance covariance = turn * in_runway * turn.transpose();
  if (!enu_from_aircraft.matrix().allFinite() || !positiveDefinite(covariance)) return std::nullopt;

  geometry_msgs::PoseWithCovarianceStamped enu;
  enu.header = pose.header;
  enu.header.frame_id = parameters.enu_frame;
  enu.pose.pose = tf2::toMsg(enu_from_aircraft);
  std::copy_n(covariance.data(), covariance.size(), enu.pose.covariance.begin());
  return enu;
}

}  // namespace uav_landing
