#pragma once

#include <ros/time.h>

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

namespace uav_landing {

/// Counts what arrives on several inputs that are to be paired by stamp, and says in words why nothing pairs
/// up. Not thread safe.
class InputWatch {
 public:
  struct Input {
    std::string topic;
    uint64_t received = 0;  ///< messages
    uint64_t paired = 0;    ///< of them, found all their counterparts
    uint64_t dropped = 0;   ///< of them, given up: a counterpart missing, or the stamp repeated
    uint64_t repeated = 0;  ///< of the dropped, had the stamp of the message before
  };
  enum class Arrival { kNext, kRepeated, kBackwards };

  /// queue_size: messages per input that wait for their counterparts.
  InputWatch(const std::vector<std::string>& topics, size_t queue_size);

  /// To be called for each message. kRepeated: must not be paired. kBackwards: the clock was set back (a bag
  /// that loops, a restarted camera); what waits is to be forgotten, with forget(), before this message is
  /// used.
  Arrival arrived(size_t input, const ros::Time& stamp);
  /// The message of this stamp has found its counterparts; older ones on this input never will.
  void paired(size_t input, const ros::Time& stamp);
  /// Everything that waits is given up; stamps may start anywhere again.
  void forget();

  const std::vector<Input>& inputs() const { return inputs_; }
  uint64_t jumps() const { return jumps_; }  ///< times the clock went back

  /// Why nothing was paired since the last call: "" when something was, else which topics are silent, or how
  /// the stamps differ.
  std::string complaint();

 private:
  struct Waiting {
    std::deque<ros::Time> stamps;
    ros::Time latest;          // zero: none yet
    uint64_t received_before;  // at the last complaint
    uint64_t paired_before;
    uint64_t repeated_before;
  };

  std::vector<Input> inputs_;
  std::vector<Waiting> waiting_;
  size_t queue_size_;
  uint64_t jumps_ = 0;
};

}  // namespace uav_landing
