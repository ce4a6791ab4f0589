#include "nodelet_chain.h"

#include <cv_bridge/cv_bridge.h>
#include <sensor_msgs/image_encodings.h>

#include <boost/make_shared.hpp>
#include <functional>
#include <stdexcept>
#include <thread>

#include "camera_info.h"

namespace uav_landing {
namespace benchmark {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kDeadline{20};

void waitUntil(const std::string& what, const std::function<bool()>& condition) {
  const auto end = Clock::now() + kDeadline;
  while (!condition()) {
    if (!ros::ok() || Clock::now() > end) throw std::runtime_error(what + ": not within 20 s");
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

std_msgs::Header header(const std::string& frame, const ros::Time& stamp) {
  std_msgs::Header header;
  header.frame_id = frame;
  header.stamp = stamp;
  return header;
}

sensor_msgs::ImagePtr toImage(const cv::Mat& image, const std_msgs::Header& header) {
  return cv_bridge::CvImage(header, sensor_msgs::image_encodings::MONO8, image).toImageMsg();
}

}  // namespace

NodeletChain::NodeletChain(const Sequence& sequence) : left_(advertise("left")), right_(advertise("right")) {
  spinner_.start();
  // With it the chain never rests, because nobody can tell who listens to tf.
  ros::param::set("/uav_landing/kalman_height/publish_tf", false);
  for (const std::string nodelet : {"rectify", "stereo_depth", "approach_angle", "kalman_height", "overlay"})
    if (!loader_.load("/uav_landing/" + nodelet, "uav_landing/" + nodelet, {}, {}))
      throw std::runtime_error(sequence.name + ": the nodelet " + nodelet + " does not load");
}

NodeletChain::~NodeletChain() {
  estimates_.shutdown();
  loader_.clear();
  spinner_.stop();
}

NodeletChain::Pair NodeletChain::message(const Sequence& sequence, size_t pair, const ros::Time& stamp) {
  const std_msgs::Header left = header("left_optical", stamp), right = header("right_optical", stamp);
  return {toImage(sequence.pairs[pair].left, left), toImage(sequence.pairs[pair].right, right),
          boost::make_shared<sensor_msgs::CameraInfo>(toCameraInfo(sequence.left, left)),
          boost::make_shared<sensor_msgs::CameraInfo>(toCameraInfo(sequence.right, right))};
}

void NodeletChain::listen(const Sequence& sequence, size_t pair) {
  estimates_ = handle_.subscribe<LandingEstimate>("/uav_landing/landing_estimate", 100,
                                                  [this](const LandingEstimateConstPtr& estimate) {
                                                    const auto now = Clock::now();
                                                    const std::lock_guard<std::mutex> lock(mutex_);
                                                    latest_ = estimate->header.stamp;
                                                    when_ = now;
                                                    came_.notify_all();
                                                  });
  waitUntil("subscriptions of the cameras", [&] { return subscribers() == 4; });
  double before = 50;  // s
  waitUntil("a first estimate", [&] {
    const ros::Time stamp(sequence.pairs[pair].stamp - (before -= 0.1));
    publish(message(sequence, pair, stamp));
    return waitFor(stamp, std::chrono::milliseconds(500));
  });
}

void NodeletChain::stopListening() {
  estimates_.shutdown();
  waitUntil("end of the subscriptions of the cameras", [&] { return subscribers() == 0; });
}

void NodeletChain::publish(const Pair& pair) {
  left_.info.publish(pair.left_info);
  left_.image.publish(pair.left);
  right_.info.publish(pair.right_info);
  right_.image.publish(pair.right);
}

Clock::duration NodeletChain::process(const Pair& pair) {
  const auto start = Clock::now();
  publish(pair);
  if (!waitFor(pair.left->header.stamp, kDeadline))
    throw std::runtime_error("the pair of " + std::to_string(pair.left->header.stamp.toSec()) +
                             " s has no estimate within 20 s");
  return when_ - start;
}

NodeletChain::View NodeletChain::advertise(const std::string& side) {
  ros::NodeHandle handle;
  return {handle.advertise<sensor_msgs::Image>("/stereo/" + side + "/image_raw", 10),
          handle.advertise<sensor_msgs::CameraInfo>("/stereo/" + side + "/camera_info", 10)};
}

uint32_t NodeletChain::subscribers() const {
  return left_.image.getNumSubscribers() + left_.info.getNumSubscribers() + right_.image.getNumSubscribers() +
         right_.info.getNumSubscribers();
}

bool NodeletChain::waitFor(const ros::Time& stamp, std::chrono::milliseconds deadline) {
  std::unique_lock<std::mutex> lock(mutex_);
  return came_.wait_for(lock, deadline, [&] { return latest_ == stamp; });
}

}  // namespace benchmark
}  // namespace uav_landing
