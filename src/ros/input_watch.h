#pragma once

#include <ros/time.h>

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "uav_landing/integrity/stamp_order.h"

namespace uav_landing {

/// Counts what arrives on several inputs that are to be paired by stamp, and says in words why nothing pairs
/// up. Not thread safe.
class InputWatch {
 public:
  struct Input {
    std::string topic;
    uint64_t received = 0;   ///< messages
    uint64_t paired = 0;     ///< of them, found all their counterparts
    uint64_t dropped = 0;    ///< of them, given up: a counterpart missing, or the stamp 0, repeated or late
    uint64_t repeated = 0;   ///< of the dropped, had the stamp of the message before
    uint64_t late = 0;       ///< of the dropped, came after newer ones
    uint64_t unstamped = 0;  ///< of the dropped, had no stamp: 0
  };
  using Arrival = StampOrder::Arrival;

  /// queue_size: messages per input that wait for their counterparts. max_late: s, see StampOrder. max_skew:
  /// of stamps that are paired though they differ, s; none: only equal ones are.
  InputWatch(const std::vector<std::string>& topics, size_t queue_size, double max_late,
             std::optional<double> max_skew = std::nullopt);

  /// To be called for each message. kRepeated, kLate, kUnstamped: must not be paired. kBackwards: the clock
  /// was set back; what waits has been forgotten, and is to be so by others, before this message is used.
  Arrival arrived(size_t input, const ros::Time& stamp);
  /// The message of this stamp has found its counterparts; older ones on this input never will.
  void paired(size_t input, const ros::Time& stamp);
  /// Everything that waits is given up; stamps may start anywhere again.
  void forget();

  const std::vector<Input>& inputs() const { return inputs_; }
  uint64_t jumps() const { return jumps_; }  ///< times the clock went back

  /// Why nothing was paired since the last call: "" when something was, else which topics are silent or have
  /// no stamps, how the stamps differ, or that the queue is too short.
  std::string complaint();
  /// What is missing since the counts before, of pairs that were made all the same: "" or the topics without
  /// a message at the stamps of the others.
  static std::string shortage(const std::vector<Input>& now, const std::vector<Input>& before);

 private:
  struct Waiting {
    explicit Waiting(double max_late) : order(max_late) {}
    StampOrder order;
    std::deque<ros::Time> stamps;
    std::deque<ros::Time> given_up;  // the last ones for which the queue was too short
    size_t queue_needed = 0;  // to find those of the others, since the last complaint; 0: it is long enough
    ros::Time latest;
    // When another input has shown that the clock went back, until this one has: its latest before that.
    std::optional<ros::Time> before_jump;
    uint64_t received_before = 0;  // at the last complaint
    uint64_t paired_before = 0;
    uint64_t repeated_before = 0;
    uint64_t unstamped_before = 0;
  };

  Arrival refused(size_t input, Arrival arrival);
  /// Sent before the clock went back, and still under way when another input showed that.
  bool isLeftOver(size_t input, const ros::Time& stamp);
  void goBack(size_t input);
  /// Whether others of this stamp were given up before, for want of room.
  void lookForGivenUp(size_t input, const ros::Time& stamp);
  std::string shortQueue();
  /// Whether the latest stamps of inputs are farther than max_skew from all that others had.
  bool differs() const;
  /// s between a stamp and the nearest that an input had.
  static double nearestOf(const ros::Time& stamp, const Waiting& other);
  std::string difference() const;

  std::vector<Input> inputs_;
  std::vector<Waiting> waiting_;
  size_t queue_size_;
  std::optional<double> max_skew_;
  uint64_t jumps_ = 0;
};

}  // namespace uav_landing
