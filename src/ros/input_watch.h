#pragma once

#include <ros/time.h>

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "integrity/tests/stamp_order.h"

namespace uav_landing {

/// Counts what arrives on several inputs that are paired by stamp, and explains why nothing is paired. Not
/// thread safe.
class InputWatch {
 public:
  struct Input {
    std::string topic;
    uint64_t received = 0;   ///< messages
    uint64_t paired = 0;     ///< number of them that found all their counterparts
    uint64_t dropped = 0;    ///< number of them given up: no counterpart, or the stamp is 0, repeated or late
    uint64_t repeated = 0;   ///< number of the dropped ones that had the stamp of the previous message
    uint64_t late = 0;       ///< number of the dropped ones that came after newer ones
    uint64_t unstamped = 0;  ///< number of the dropped ones that had no stamp: 0
  };
  using Arrival = StampOrder::Arrival;

  /// queue_size: number of messages per input that wait for their counterparts. max_late: s, see StampOrder.
  /// max_skew: largest difference of stamps that are paired, s; none: only equal stamps are paired.
  InputWatch(const std::vector<std::string>& topics, size_t queue_size, double max_late,
             std::optional<double> max_skew = std::nullopt);

  /// Call it for each message. Do not pair a message that is kRepeated, kLate or kUnstamped. kBackwards means
  /// that the clock was set back. Waiting messages have been forgotten here, and callers must forget theirs
  /// before they use this message.
  Arrival arrived(size_t input, const ros::Time& stamp);
  /// Call it when the message of this stamp has found its counterparts. Older ones on this input never will.
  void paired(size_t input, const ros::Time& stamp);
  /// Gives up everything that waits. Stamps may start anywhere again.
  void forget();

  const std::vector<Input>& inputs() const { return inputs_; }
  uint64_t jumps() const { return jumps_; }  ///< times that the clock went back

  /// Says why nothing was paired since the last call; "" when something was. It names the topics that are
  /// silent or have no stamps, the difference of the stamps, or a queue that is too short.
  std::string complaint();
  /// Topics that lack a message at stamps of the others since earlier counts, although pairs were made; "":
  /// none.
  static std::string shortage(const std::vector<Input>& now, const std::vector<Input>& before);

 private:
  struct Waiting {
    explicit Waiting(double max_late) : order(max_late) {}
    StampOrder order;
    std::deque<ros::Time> stamps;
    std::deque<ros::Time> given_up;  // the last ones for which the queue was too short
    size_t queue_needed = 0;  // queue length that would have found the others' messages, since the last
                              // complaint; 0: it is long enough
    ros::Time latest;
    // Set when another input has shown that the clock went back. It is the latest stamp before that, and is
    // kept until this input goes back, too.
    std::optional<ros::Time> before_jump;
    uint64_t received_before = 0;  // at the last complaint
    uint64_t paired_before = 0;
    uint64_t repeated_before = 0;
    uint64_t unstamped_before = 0;
  };

  Arrival refused(size_t input, Arrival arrival);
  /// Whether the message was sent before the clock went back, and was still on its way when another input
  /// showed that.
  bool isLeftOver(size_t input, const ros::Time& stamp);
  void goBack(size_t input);
  /// Checks whether others of this stamp were given up before because the queue was full.
  void lookForGivenUp(size_t input, const ros::Time& stamp);
  std::string shortQueue();
  /// Whether the latest stamps of inputs differ by more than max_skew from all stamps of the others.
  bool differs() const;
  /// Time between a stamp and the nearest one that an input had, s.
  static double nearestOf(const ros::Time& stamp, const Waiting& other);
  std::string difference() const;

  std::vector<Input> inputs_;
  std::vector<Waiting> waiting_;
  size_t queue_size_;
  std::optional<double> max_skew_;
  uint64_t jumps_ = 0;
};

}  // namespace uav_landing
