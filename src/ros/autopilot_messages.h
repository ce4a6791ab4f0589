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
/// tilt. An autopilot multiplies by this cosine again. pose: of the aircraft, forward-left-up. There is no
/// range without a height, above max_range, below the ground, or with a tilt of more than 60 degrees.
std::optional<sensor_msgs::Range> autopilotRange(const sensor_msgs::Range& height,
                                                 const geometry_msgs::PoseWithCovarianceStamped& pose,
                                                 const AutopilotParameters& parameters);

/// Says why autopilotRange() has none.
std::string whyNoRange(const sensor_msgs::Range& height, const geometry_msgs::PoseWithCovarianceStamped& pose,
                       const AutopilotParameters& parameters);

/// The pose in the axes east, north, up, with its covariance. There is none in four cases:
/// - the runway's heading is not known;
/// - a number is not finite, or the covariance is not positive definite;
/// - the place is not known well enough;
/// - the tilt is more than 60 degrees: this is the pose of a camera, whose z axis is forward.
std::optional<geometry_msgs::PoseWithCovarianceStamped> autopilotPose(
    const geometry_msgs::PoseWithCovarianceStamped& pose, const AutopilotParameters& parameters);

/// The aircraft's own motion (twist, in its axes) in the axes east, north, up. The uncertainty of the
/// attitude is turned as well. There is none in four cases:
/// - the runway's heading is not known;
/// - the runway's direction has not been seen (yaw known to 0.1 rad, 1 sigma);
/// - a number is not finite, or the covariance is not positive definite;
/// - the tilt is more than 60 degrees.
std::optional<geometry_msgs::TwistWithCovarianceStamped> autopilotVelocity(
    const geometry_msgs::TwistWithCovarianceStamped& twist,
    const geometry_msgs::PoseWithCovarianceStamped& pose, const AutopilotParameters& parameters);

/// Says why autopilotVelocity() has none, for a runway with a heading.
std::string whyNoVelocity(const geometry_msgs::PoseWithCovarianceStamped& pose);

/// Whether the runway's heading is given; otherwise only the range is sent.
bool headingKnown(const AutopilotParameters& parameters);

}  // namespace uav_landing
