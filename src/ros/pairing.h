#pragma once

#include <message_filters/sync_policies/approximate_time.h>
#include <message_filters/sync_policies/exact_time.h>
#include <message_filters/synchronizer.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include <boost/weak_ptr.hpp>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "input_watch.h"
#include "uav_landing/parameters/rectify_parameters.h"

namespace uav_landing {

/// Pairs messages by their stamps (header.stamp), with message_filters. Messages come by plain calls, so it
/// serves subscriptions and bags. Repeated, late and missing (0) stamps are dropped. A stamp that goes back
/// farther clears everything that waits (StampOrder).
///
/// The same message object counts once when it comes twice, because roscpp may have linked a foreign
/// publisher in this process twice (see stage_nodelet.cpp). Thread safe. The callback runs in the thread of
/// the add() that completed the set, without the lock.
template <class... Messages>
class Pairing {
  static_assert(sizeof...(Messages) >= 2,
                "one input needs no pairing: subscribe to it, and count with InputWatch");

 public:
  template <size_t kInput>
  using Pointer = boost::shared_ptr<const std::tuple_element_t<kInput, std::tuple<Messages...>>>;
  using Callback = std::function<void(const boost::shared_ptr<const Messages>&...)>;

  /// topics: one name per input, for complaint(). The parameter queue_size limits the number of messages that
  /// wait.
  Pairing(const RectifyParameters& parameters, const std::vector<std::string>& topics, Callback callback)
      : parameters_(parameters),
        callback_(std::move(callback)),
        watch_(topics, static_cast<size_t>(parameters.queue_size), parameters.max_late,
               parameters.approximate_sync ? std::optional<double>(parameters.max_skew) : std::nullopt) {
    rebuild();
  }

  template <size_t kInput>
  void add(const Pointer<kInput>& message) {
    std::vector<Set> complete;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (cameTwice(message, std::get<kInput>(last_))) return;
      const ros::Time& stamp = message->header.stamp;
      const InputWatch::Arrival arrival = watch_.arrived(kInput, stamp);
      if (!StampOrder::isUsed(arrival)) return;
      if (arrival == InputWatch::Arrival::kBackwards) rebuild();
      using Message = std::tuple_element_t<kInput, std::tuple<Messages...>>;
      // The stamp replaces the receipt time, because bags are read without a system clock.
      const ros::MessageEvent<const Message> event(message, stamp);
      if (exact_)
        exact_->template add<kInput>(event);
      else
        approximate_->template add<kInput>(event);
      complete.swap(complete_);
    }
    for (const Set& set : complete) std::apply(callback_, set);
  }

  /// Forgets everything that waits.
  void reset() {
    const std::lock_guard<std::mutex> lock(mutex_);
    watch_.forget();
    last_ = {};
    rebuild();
  }

  /// Counts per input, in the order of the message types.
  std::vector<InputWatch::Input> inputs() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return watch_.inputs();
  }
  uint64_t jumps() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return watch_.jumps();
  }
  /// Says why nothing was paired since the last call; "" when something was. See InputWatch::complaint().
  std::string complaint() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return watch_.complaint();
  }

 private:
  using Set = std::tuple<boost::shared_ptr<const Messages>...>;
  using ExactPolicy = message_filters::sync_policies::ExactTime<Messages...>;
  using ApproximatePolicy = message_filters::sync_policies::ApproximateTime<Messages...>;

  template <class Message>
  struct Last {
    boost::weak_ptr<const Message> message;
    ros::Time stamp;  // a publisher may fill the same message anew
  };

  /// Whether this is the previous message object for the second time. A third time means that somebody sends
  /// it again.
  template <class Message>
  static bool cameTwice(const boost::shared_ptr<const Message>& message, Last<Message>& last) {
    const bool twice = last.message.lock() == message && last.stamp == message->header.stamp;
    if (twice)
      last = {};
    else
      last = {message, message->header.stamp};
    return twice;
  }

  // A new synchronizer also forgets the stamps that its policy has already served.
  void rebuild() {
    const auto queue_size = static_cast<uint32_t>(parameters_.queue_size);
    exact_.reset();
    approximate_.reset();
    if (!parameters_.approximate_sync) {
      exact_ = std::make_unique<message_filters::Synchronizer<ExactPolicy>>(ExactPolicy(queue_size));
      exact_->registerCallback(&Pairing::collect, this);
      return;
    }
    ApproximatePolicy policy(queue_size);
    const ros::Duration max_skew(parameters_.max_skew);
    policy.setMaxIntervalDuration(max_skew);
    // Two images of one camera are farther apart than max_skew. With this bound, the best set is known as
    // soon as it is complete, and need not wait for the next image.
    policy.setInterMessageLowerBound(max_skew);
    approximate_ = std::make_unique<message_filters::Synchronizer<ApproximatePolicy>>(policy);
    approximate_->registerCallback(&Pairing::collect, this);
  }

  void collect(const boost::shared_ptr<const Messages>&... messages) {
    size_t input = 0;
    (watch_.paired(input++, messages->header.stamp), ...);
    complete_.emplace_back(messages...);
  }

  const RectifyParameters parameters_;
  const Callback callback_;
  mutable std::mutex mutex_;
  InputWatch watch_;
  std::tuple<Last<Messages>...> last_;  // of each input
  std::unique_ptr<message_filters::Synchronizer<ExactPolicy>> exact_;
  std::unique_ptr<message_filters::Synchronizer<ApproximatePolicy>> approximate_;
  std::vector<Set> complete_;
};

/// Inputs in this order: left image, left camera_info, right image, right camera_info.
using StereoPairing =
    Pairing<sensor_msgs::Image, sensor_msgs::CameraInfo, sensor_msgs::Image, sensor_msgs::CameraInfo>;

}  // namespace uav_landing
