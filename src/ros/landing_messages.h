#pragma once

#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <geometry_msgs/TwistWithCovarianceStamped.h>
#include <sensor_msgs/Range.h>

#include <Eigen/Geometry>
#include <string>

#include "body_twist.h"

namespace uav_landing {

/// The height as the range of a sensor that looks straight down; NaN while it is not valid.
sensor_msgs::RangePtr heightMessage(const LandingResult& estimate, const ros::Time& stamp,
                                    const std::string& frame);

/// covariance: of (x, y, z, rotations about the axes of the header's frame).
geometry_msgs::PoseWithCovarianceStampedPtr poseMessage(const std_msgs::Header& header,
                                                        const Eigen::Isometry3d& pose,
                                                        const Matrix6d& covariance);

/// frame: the moving frame. The twist is in its axes.
geometry_msgs::TwistWithCovarianceStampedPtr twistMessage(const ros::Time& stamp, const std::string& frame,
                                                          const BodyTwist& twist);

}  // namespace uav_landing
