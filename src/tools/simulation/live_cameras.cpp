#include "simulation/live_cameras.h"

#include <cv_bridge/cv_bridge.h>
#include <rosgraph_msgs/Clock.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/image_encodings.h>

#include <algorithm>
#include <map>
#include <stdexcept>

#include "bags/stereo_bag_writer.h"

namespace uav_landing {
namespace {

const ros::Duration kTick(0.01);  // of the clock
constexpr uint32_t kQueue = 10;
constexpr double kPatience = 600;           // s, until somebody subscribes
constexpr double kConnectionPatience = 20;  // s, until all subscribers are connected

/// Number of nodes that subscribe each topic, according to the master; empty when it does not answer.
std::map<std::string, uint32_t> countSubscribers() {
  std::map<std::string, uint32_t> counts;
  XmlRpc::XmlRpcValue request, response, state;
  request[0] = ros::this_node::getName();
  if (!ros::master::execute("getSystemState", request, response, state, false)) return counts;
  if (state.getType() != XmlRpc::XmlRpcValue::TypeArray || state.size() < 2) return counts;
  XmlRpc::XmlRpcValue& subscribers = state[1];  // after the publishers
  for (int i = 0; i < subscribers.size(); ++i)
    counts[subscribers[i][0]] = static_cast<uint32_t>(subscribers[i][1].size());
  return counts;
}

}  // namespace

LiveCameras::LiveCameras(const std::string& camera, const sensor_msgs::CameraInfo& left,
                         const sensor_msgs::CameraInfo& right, double speed)
    : speed_(speed),
      left_(advertise("/" + camera + "/left", opticalFrame(camera, "left"), left)),
      right_(advertise("/" + camera + "/right", opticalFrame(camera, "right"), right)),
      truth_(handle_.advertise<LandingEstimate>("/truth/landing_estimate", kQueue)),
      clock_(handle_.advertise<rosgraph_msgs::Clock>("/clock", kQueue)) {
  handle_.setParam("/use_sim_time", true);
}

LiveCameras::Camera LiveCameras::advertise(const std::string& topic, const std::string& frame,
                                           const sensor_msgs::CameraInfo& calibration) {
  Camera camera{handle_.advertise<sensor_msgs::Image>(topic + "/image_raw", kQueue),
                handle_.advertise<sensor_msgs::CameraInfo>(topic + "/camera_info", kQueue), calibration};
  camera.calibration.header.frame_id = frame;
  return camera;
}

bool LiveCameras::seen() const {
  return left_.image.getNumSubscribers() > 0 && right_.image.getNumSubscribers() > 0 &&
         left_.info.getNumSubscribers() > 0 && right_.info.getNumSubscribers() > 0;
}

bool LiveCameras::allConnected() const {
  const std::map<std::string, uint32_t> registered = countSubscribers();
  for (const ros::Publisher& topic : {left_.image, left_.info, right_.image, right_.info, truth_, clock_}) {
    const auto found = registered.find(topic.getTopic());
    if (found != registered.end() && topic.getNumSubscribers() < found->second) return false;
  }
  return true;
}

bool LiveCameras::waitForSubscribers(const ros::Time& start) {
  const auto waitFor = [&](double patience, int ticks, auto&& condition) {
    const ros::WallTime deadline = ros::WallTime::now() + ros::WallDuration(patience);
    for (int tick = 0; ros::ok() && ros::WallTime::now() < deadline; ++tick) {
      if (tick % ticks == 0 && condition()) return true;
      setClock(start);
      ros::WallDuration(kTick.toSec()).sleep();
    }
    return false;
  };
  if (!waitFor(kPatience, 1, [&] { return seen(); })) {
    if (!ros::ok()) return false;
    throw std::runtime_error("nobody has subscribed the cameras for 10 minutes");
  }
  // The master is asked ten times a second.
  if (!waitFor(kConnectionPatience, 10, [&] { return allConnected(); }) && ros::ok())
    ROS_WARN("not all subscribers of the cameras, the truth and the clock are connected: starting without");
  return ros::ok();
}

bool LiveCameras::publish(const ros::Time& stamp, const cv::Mat& left, const cv::Mat& right,
                          const Truth& truth) {
  if (!runClock(stamp)) return false;
  publish(left_, stamp, left);
  publish(right_, stamp, right);
  truth_.publish(truthMessage(truth, left_.calibration, stamp, left_.calibration.header.frame_id));
  return true;
}

void LiveCameras::publish(Camera& camera, const ros::Time& stamp, const cv::Mat& image) {
  camera.calibration.header.stamp = stamp;
  camera.info.publish(camera.calibration);
  camera.image.publish(
      cv_bridge::CvImage(camera.calibration.header, sensor_msgs::image_encodings::MONO8, image).toImageMsg());
}

void LiveCameras::setClock(const ros::Time& now) {
  rosgraph_msgs::Clock clock;
  clock.clock = now_.emplace(now);
  clock_.publish(clock);
}

bool LiveCameras::runClock(const ros::Time& until) {
  if (!now_) setClock(until);
  while (ros::ok() && *now_ < until) {
    const ros::Duration step = std::min(kTick, until - *now_);
    ros::WallDuration(step.toSec() / speed_).sleep();
    setClock(*now_ + step);
  }
  return ros::ok();
}

}  // namespace uav_landing
