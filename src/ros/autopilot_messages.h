#pragma once

#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <geometry_msgs/TwistWithCovarianceStamped.h>
#include <sensor_msgs/Range.h>

#include <Eigen/Geometry>
#include <optional>
#include <string>

namespace uav_landing {

/// Parameters of the messages to the autopilot (nodelet autopilot). visit(): as in
/// uav_landing/parameters/parameters.h.
struct AutopilotParameters {
  double max_range = 655.0;
  double max_rate = 50.0;
  double max_position_stddev = 20.0;
  double runway_heading_deg = -1.0;
  std::string enu_frame = "map";

  template <class Visitor>
  void visit(Visitor&& v) {
    v.number("max_range", max_range, 1.0, 655.0, "m",
             "no range above this; the autopilot's message holds 16 bit of centimetres");
    v.number("max_rate", max_rate, 1.0, 1000.0, "Hz",
             "on average; pairs beyond are left out, as autopilots lose what comes faster than they fuse");
    v.number("max_position_stddev", max_position_stddev, 0.01, 10000.0, "m",
             "no pose while 1 sigma of x or y is more: before the runway has been found its origin is "
             "arbitrary");
    v.number("runway_heading_deg", runway_heading_deg, -1.0, 360.0, "deg",
             "landing direction clockwise from north, for pose and velocity; below 0 it is not known, and "
             "neither is sent");
    v.text("enu_frame", enu_frame,
           "frame of pose and velocity: x east, y north, z up, origin on the threshold");
  }
};

/// The reading of a range finder that looks along the aircraft's down axis: height over the cosine of the
/// tilt. An autopilot multiplies by this cosine again. pose: of the aircraft, forward-left-up. None without a
/// height, above max_range, below the ground, or tilted by more than 60 degrees.
std::optional<sensor_msgs::Range> autopilotRange(const sensor_msgs::Range& height,
                                                 const geometry_msgs::PoseWithCovarianceStamped& pose,
                                                 const AutopilotParameters& parameters);

/// Why autopilotRange() has none.
std::string whyNoRange(const sensor_msgs::Range& height, const geometry_msgs::PoseWithCovarianceStamped& pose,
                       const AutopilotParameters& parameters);

/// The pose in the axes east, north, up, covariance included. None in four cases: without the runway's
/// heading; when a number is not finite or the covariance not positive definite; when the place is not known
/// well enough; when it is tilted by more than 60 degrees, as this is a camera, whose z axis is forward.
std::optional<geometry_msgs::PoseWithCovarianceStamped> autopilotPose(
    const geometry_msgs::PoseWithCovarianceStamped& pose, const AutopilotParameters& parameters);

/// The aircraft's own motion (twist, in its axes) in the axes east, north, up. The uncertainty of the
/// attitude is turned as well. None in four cases: without the runway's heading; before the runway's
/// direction is seen (yaw known to 0.1 rad, 1 sigma); when a number is not finite or the covariance not
/// positive definite; when tilted by more than 60 degrees.
std::optional<geometry_msgs::TwistWithCovarianceStamped> autopilotVelocity(
    const geometry_msgs::TwistWithCovarianceStamped& twist,
    const geometry_msgs::PoseWithCovarianceStamped& pose, const AutopilotParameters& parameters);

/// Why autopilotVelocity() has none, for a runway with a heading.
std::string whyNoVelocity(const geometry_msgs::PoseWithCovarianceStamped& pose);

/// Whether the runway's heading is given; otherwise only the range is sent.
bool headingKnown(const AutopilotParameters& parameters);

}  // namespace uav_landing
