#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>
#include <nodelet/loader.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Log.h>

#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace uav_landing {
namespace test {

constexpr std::chrono::seconds kDeadline{30};

/// Waits for a condition that nothing signals; false after the deadline.
inline bool eventually(const std::function<bool()>& condition,
                       std::chrono::milliseconds deadline = kDeadline) {
  const auto end = std::chrono::steady_clock::now() + deadline;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

/// Keeps what comes on a topic.
template <class Message>
class Listener {
 public:
  using Pointer = boost::shared_ptr<const Message>;

  explicit Listener(const std::string& topic)
      : subscriber_(ros::NodeHandle().subscribe<Message>(topic, 1000, [this](const Pointer& message) {
          {
            const std::lock_guard<std::mutex> lock(mutex_);
            messages_.push_back(message);
          }
          came_.notify_all();
        })) {}
  ~Listener() { subscriber_.shutdown(); }

  /// True when at least this many messages have come.
  bool waitFor(size_t count) {
    std::unique_lock<std::mutex> lock(mutex_);
    return came_.wait_for(lock, kDeadline, [&] { return messages_.size() >= count; });
  }
  /// True when a message with this property has come.
  bool waitFor(const std::function<bool(const Message&)>& property,
               std::chrono::milliseconds deadline = kDeadline) {
    std::unique_lock<std::mutex> lock(mutex_);
    return came_.wait_for(lock, deadline, [&] {
      for (const Pointer& message : messages_)
        if (property(*message)) return true;
      return false;
    });
  }
  std::vector<Pointer> messages() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return messages_;
  }
  void clear() {
    const std::lock_guard<std::mutex> lock(mutex_);
    messages_.clear();
  }
  bool connected() const { return subscriber_.getNumPublishers() > 0; }
  /// Nothing comes any more.
  void leave() { subscriber_.shutdown(); }

 private:
  mutable std::mutex mutex_;
  std::condition_variable came_;
  std::vector<Pointer> messages_;
  ros::Subscriber subscriber_;
};

/// What /diagnostics says of the nodelets under /uav_landing.
class Diagnostics {
 public:
  bool said(const std::string& nodelet, int level, const std::string& message) const {
    for (const auto& array : listener_.messages())
      for (const auto& status : array->status)
        if (status.name.find("uav_landing/" + nodelet + ": ") != std::string::npos && status.level == level &&
            status.message == message)
          return true;
    return false;
  }
  void clear() { listener_.clear(); }

 private:
  Listener<diagnostic_msgs::DiagnosticArray> listener_{"/diagnostics"};
};

/// Loads nodelets into the test's own process, under /uav_landing.
class NodeletTest : public testing::Test {
 protected:
  NodeletTest() : log_("/rosout") {
    ros::param::del("/uav_landing");
    spinner_.start();
  }
  ~NodeletTest() override {
    loader_.clear();
    spinner_.stop();
  }

  template <class Value>
  void setParameter(const std::string& nodelet, const std::string& name, const Value& value) {
    ros::param::set("/uav_landing/" + nodelet + "/" + name, value);
  }
  void load(const std::string& nodelet) {
    ASSERT_TRUE(loader_.load("/uav_landing/" + nodelet, "uav_landing/" + nodelet, {}, {}));
  }
  void unload(const std::string& nodelet) { ASSERT_TRUE(loader_.unload("/uav_landing/" + nodelet)); }

  /// Loading fails and the log says why.
  void expectRefusal(const std::string& nodelet, const std::string& why) {
    EXPECT_FALSE(loader_.load("/uav_landing/" + nodelet, "uav_landing/" + nodelet, {}, {}));
    EXPECT_TRUE(logged(why)) << wholeLog();
  }

  /// True when the log gets a line that contains the text.
  bool logged(const std::string& text) {
    return log_.waitFor(
        [&](const rosgraph_msgs::Log& line) { return line.msg.find(text) != std::string::npos; });
  }
  /// How often the log has exactly this line.
  size_t timesLogged(const std::string& text) const {
    size_t count = 0;
    for (const auto& line : log_.messages()) count += line->msg == text;
    return count;
  }
  std::string wholeLog() const {
    std::string text;
    for (const auto& line : log_.messages()) text += line->msg + "\n";
    return text;
  }

  ros::NodeHandle handle_;
  ros::AsyncSpinner spinner_{1};
  Listener<rosgraph_msgs::Log> log_;
  nodelet::Loader loader_{false};
};

}  // namespace test
}  // namespace uav_landing
