#include "input_watch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "time_difference.h"

namespace uav_landing {

namespace {

constexpr size_t kLongestQueue = 100;  // largest possible queue_size
constexpr size_t kGivenUp = 200;       // stamps that are remembered; more than the longest queue
constexpr double kMostDelay = 0.5;     // s that messages may take; a longer delay rather means that the
                                       // clocks differ

/// Time between a stamp and the nearest of others, s.
double distance(const ros::Time& stamp, const std::deque<ros::Time>& others) {
  double least = std::numeric_limits<double>::infinity();
  for (const ros::Time& other : others) least = std::min(least, std::abs(secondsBetween(stamp, other)));
  return least;
}

std::string milliseconds(double seconds) {
  std::ostringstream text;
  const double ms = 1e3 * seconds;
  text.precision(ms < 1000 ? 3 : 15);
  text << (ms < 1000 ? ms : std::round(ms)) << " ms";
  return text.str();
}

}  // namespace

InputWatch::InputWatch(const std::vector<std::string>& topics, size_t queue_size, double max_late,
                       std::optional<double> max_skew)
    : waiting_(topics.size(), Waiting(max_late)), queue_size_(queue_size), max_skew_(max_skew) {
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
  lookForGivenUp(input, stamp);
  waiting.stamps.push_back(stamp);
  if (waiting.stamps.size() > queue_size_) {
    waiting.given_up.push_back(waiting.stamps.front());
    if (waiting.given_up.size() > kGivenUp) waiting.given_up.pop_front();
    waiting.stamps.pop_front();
    ++inputs_[input].dropped;
  }
  return arrival;
}

void InputWatch::lookForGivenUp(size_t input, const ros::Time& stamp) {
  for (size_t i = 0; i < waiting_.size(); ++i) {
    const Waiting& other = waiting_[i];
    if (i == input || other.given_up.empty()) continue;
    const auto nearest = std::min_element(
        other.given_up.begin(), other.given_up.end(), [&](const ros::Time& a, const ros::Time& b) {
          return std::abs(secondsBetween(a, stamp)) < std::abs(secondsBetween(b, stamp));
        });
    const double apart = std::abs(secondsBetween(*nearest, stamp));
    // When a waiting message is nearer, none was given up too early, because a large max_skew reaches older
    // ones, too.
    if (apart > max_skew_.value_or(0) || distance(stamp, other.stamps) <= apart) continue;
    const size_t behind = queue_size_ + static_cast<size_t>(other.given_up.end() - nearest);
    waiting_[input].queue_needed = std::max(waiting_[input].queue_needed, behind);
  }
}

std::string InputWatch::shortQueue() {
  std::string late;
  size_t needed = 0;
  double behind = 0;
  for (size_t i = 0; i < inputs_.size(); ++i) {
    if (waiting_[i].queue_needed == 0) continue;
    late += (late.empty() ? "" : ", ") + inputs_[i].topic;
    needed = std::max(needed, waiting_[i].queue_needed);
    for (const Waiting& other : waiting_)
      if (!waiting_[i].latest.isZero())
        behind = std::max(behind, secondsBetween(waiting_[i].latest, other.latest));
    waiting_[i].queue_needed = 0;
  }
  if (late.empty()) return "";
  const std::string at_least = "rectify/queue_size has to be at least " + std::to_string(needed);
  if (behind <= kMostDelay && needed <= kLongestQueue)
    return "the queue of " + std::to_string(queue_size_) + " pairs is too short: " + late +
           " came after the others of their stamps had been given up; " + at_least;
  return "the stamps are " + milliseconds(behind) + " apart: the clocks differ, or " + late +
         " came that late" + (needed <= kLongestQueue ? "; then " + at_least : "");
}

bool InputWatch::differs() const {
  const Waiting& first = waiting_.front();
  return std::any_of(waiting_.begin(), waiting_.end(), [&](const Waiting& other) {
    // An input that is behind, whichever it is, finds its stamps among those that the other one had.
    return std::min(nearestOf(first.latest, other), nearestOf(other.latest, first)) > *max_skew_;
  });
}

double InputWatch::nearestOf(const ros::Time& stamp, const Waiting& other) {
  return std::min(distance(stamp, other.stamps), distance(stamp, other.given_up));
}

std::string InputWatch::difference() const {
  double apart = 0;
  for (const Waiting& waiting : waiting_)
    apart = std::max(apart, nearestOf(waiting.latest, waiting_.front()));
  if (!std::isfinite(apart)) return "";
  if (max_skew_ && apart > *max_skew_)
    return "the stamps are " + milliseconds(apart) + " apart, more than max_skew, " +
           milliseconds(*max_skew_);
  return max_skew_ ? "" : "nearest stamps are " + milliseconds(apart) + " apart";
}

std::string InputWatch::shortage(const std::vector<Input>& now, const std::vector<Input>& before) {
  std::string missing, topics;
  uint64_t most = 0, received = 0;
  for (size_t i = 0; i < now.size(); ++i) {
    const Input old = i < before.size() ? before[i] : Input{};
    const auto refused = [](const Input& input) { return input.repeated + input.late + input.unstamped; };
    const uint64_t lost = now[i].dropped - refused(now[i]) - (old.dropped - refused(old));
    received = std::max(received, now[i].received - old.received);
    if (lost > most) most = lost;
    if (lost == 0) missing += (missing.empty() ? "" : ", ") + now[i].topic;
    topics += (topics.empty() ? "" : ", ") + now[i].topic;
  }
  // Single messages are lost now and then.
  if (5 * most < received || most < 2) return "";
  const std::string count = std::to_string(most) + " of " + std::to_string(received);
  if (missing.empty()) return count + " messages have no counterpart: the stamps differ on " + topics;
  return count + " stamps have no message on " + missing;
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
  // The inputs that went back may have caught up meanwhile.
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
    waiting_[i].given_up.clear();
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
  const std::string too_short = shortQueue();
  if (any_paired) return "";
  if (!silent.empty()) return "no message on " + silent;
  if (!unstamped.empty()) return "the stamp (header.stamp) is 0 on " + unstamped;
  if (!repeating.empty()) return "the stamp never changes on " + repeating;
  // A longer queue would not help when stamps differ by more than max_skew.
  if (!too_short.empty() && !(max_skew_ && differs())) return too_short;
  const std::string apart = difference();
  if (max_skew_) return (apart.empty() ? "the stamps do not match" : apart) + "; latest: " + latest;
  return "the stamps do not match (approximate_sync pairs cameras without a hardware trigger); latest: " +
         latest + (apart.empty() ? "" : "; " + apart);
}

}  // namespace uav_landing
