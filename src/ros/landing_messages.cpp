#include "landing_messages.h"

#include <tf2_eigen/tf2_eigen.h>

#include <boost/make_shared.hpp>

#include "message_arrays.h"

namespace uav_landing {

sensor_msgs::RangePtr heightMessage(const LandingResult& estimate, const ros::Time& stamp,
                                    const std::string& frame) {
  constexpr float kMaxRange = 10000;  // m
  const auto range = boost::make_shared<sensor_msgs::Range>();
  range->header.stamp = stamp;
  range->header.frame_id = frame;
  range->radiation_type = sensor_msgs::Range::INFRARED;
  range->min_range = 0;
  range->max_range = kMaxRange;
  range->range = static_cast<float>(estimate.height_valid ? estimate.height : kUnknown);
  return range;
}

geometry_msgs::PoseWithCovarianceStampedPtr poseMessage(const std_msgs::Header& header,
                                                        const Eigen::Isometry3d& pose,
                                                        const Matrix6d& covariance) {
  const auto message = boost::make_shared<geometry_msgs::PoseWithCovarianceStamped>();
  message->header = header;
  message->pose.pose = tf2::toMsg(pose);
  toArray(covariance, message->pose.covariance);
  return message;
}

geometry_msgs::TwistWithCovarianceStampedPtr twistMessage(const ros::Time& stamp, const std::string& frame,
                                                          const BodyTwist& twist) {
  const auto message = boost::make_shared<geometry_msgs::TwistWithCovarianceStamped>();
  message->header.stamp = stamp;
  message->header.frame_id = frame;
  tf2::toMsg(twist.linear, message->twist.twist.linear);
  tf2::toMsg(twist.angular, message->twist.twist.angular);
  toArray(twist.covariance, message->twist.covariance);
  return message;
}

}  // namespace uav_landing
