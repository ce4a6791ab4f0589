#include "input_watch.h"

#include <algorithm>
#include <sstream>

namespace uav_landing {

InputWatch::InputWatch(const std::vector<std::string>& topics, size_t queue_size, double max_late)
    : waiting_(topics.size(), Waiting(max_late)), queue_size_(queue_size) {
  for (const std::string& topic : topics) inputs_.push_back(Input{topic});
}

InputWatch::Arrival InputWatch::arrived(size_t input, const ros::Time& stamp) {
  Waiting& waiting = waiting_[input];
  ++inputs_[input].received;
  if (isLeftOver(input, stamp)) return refused(input, Arrival::kLate);
  const Arrival arrival = waiting.order.follow(static_cast<int64_t>(stamp.toNSec()));
  if (!StampOrder::isUsed(arrival)) return refused(input, arrival);
  if (arrival == Arrival::kBackwards) {
    goBack(input);
    waiting.order.follow(static_cast<int64_t>(stamp.toNSec()));
  }
  waiting.latest = stamp;
  waiting.stamps.push_back(stamp);
  if (waiting.stamps.size() > queue_size_) {
    waiting.stamps.pop_front();
    ++inputs_[input].dropped;
  }
  return arrival;
}

InputWatch::Arrival InputWatch::refused(size_t input, Arrival arrival) {
  Input& counted = inputs_[input];
  ++(arrival == Arrival::kLate       ? counted.late
     : arrival == Arrival::kRepeated ? counted.repeated
                                     : counted.unstamped);
  ++counted.dropped;
  return arrival;
}

bool InputWatch::isLeftOver(size_t input, const ros::Time& stamp) {
  std::optional<ros::Time>& before = waiting_[input].before_jump;
  if (!before || stamp.isZero()) return false;
  // The inputs that went back may be as far again meanwhile.
  const bool caught_up = std::any_of(waiting_.begin(), waiting_.end(), [&](const Waiting& other) {
    return !other.before_jump && other.latest > *before;
  });
  if (caught_up || stamp <= *before) {
    before.reset();
    return false;
  }
  before = stamp;
  return true;
}

void InputWatch::goBack(size_t input) {
  ++jumps_;
  std::vector<ros::Time> latest;
  for (const Waiting& waiting : waiting_) latest.push_back(waiting.latest);
  forget();
  for (size_t i = 0; i < waiting_.size(); ++i)
    if (i != input && !latest[i].isZero()) waiting_[i].before_jump = latest[i];
}

void InputWatch::paired(size_t input, const ros::Time& stamp) {
  std::deque<ros::Time>& stamps = waiting_[input].stamps;
  while (!stamps.empty() && stamps.front() < stamp) {
    stamps.pop_front();
    ++inputs_[input].dropped;
  }
  if (!stamps.empty() && stamps.front() == stamp) stamps.pop_front();
  ++inputs_[input].paired;
}

void InputWatch::forget() {
  for (size_t i = 0; i < inputs_.size(); ++i) {
    inputs_[i].dropped += waiting_[i].stamps.size();
    waiting_[i].stamps.clear();
    waiting_[i].latest = ros::Time();
    waiting_[i].before_jump.reset();
    waiting_[i].order.reset();
  }
}

std::string InputWatch::complaint() {
  bool any_paired = false;
  std::string silent, unstamped, repeating, latest;
  for (size_t i = 0; i < inputs_.size(); ++i) {
    const Input& input = inputs_[i];
    Waiting& waiting = waiting_[i];
    any_paired = any_paired || input.paired > waiting.paired_before;
    if (input.received == waiting.received_before) {
      silent += (silent.empty() ? "" : ", ") + input.topic;
    } else if (input.unstamped - waiting.unstamped_before == input.received - waiting.received_before) {
      unstamped += (unstamped.empty() ? "" : ", ") + input.topic;
    } else if (input.repeated - waiting.repeated_before == input.received - waiting.received_before) {
      repeating += (repeating.empty() ? "" : ", ") + input.topic;
    } else {
      std::ostringstream stamp;
      stamp << waiting.latest;
      latest += (latest.empty() ? "" : ", ") + input.topic + " " + stamp.str();
    }
    waiting.received_before = input.received;
    waiting.paired_before = input.paired;
    waiting.repeated_before = input.repeated;
    waiting.unstamped_before = input.unstamped;
  }
  if (any_paired) return "";
  if (!silent.empty()) return "no message on " + silent;
  if (!unstamped.empty()) return "the stamp (header.stamp) is 0 on " + unstamped;
  if (!repeating.empty()) return "the stamp never changes on " + repeating;
  return "the stamps do not match (approximate_sync pairs cameras without a hardware trigger); latest: " +
         latest;
}

}  // namespace uav_landing
