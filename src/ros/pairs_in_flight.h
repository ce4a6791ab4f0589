#pragma once

#include <ros/time.h>

#include <chrono>
#include <condition_variable>
#include <deque>
#include <list>
#include <memory>
#include <mutex>
#include <string>

namespace uav_landing {

/// Counts how far the stages are behind rectify. Only rectify may drop a pair, so that everything behind it
/// stays exactly synchronised. So it has to know when the stages cannot keep up, before their queues
/// overflow. The stages of one rig in one process share this object; stages in other processes are not seen.
/// Thread safe.
class PairsInFlight {
 public:
  /// A stage that works through the pairs.
  class Consumer {
   public:
    ~Consumer();
    Consumer(const Consumer&) = delete;
    Consumer& operator=(const Consumer&) = delete;
    /// The stage has finished the pair of this stamp, and all pairs before it.
    void finished(const ros::Time& stamp);

   private:
    friend class PairsInFlight;
    struct Pair {
      ros::Time stamp;
      std::chrono::steady_clock::time_point since;
    };
    explicit Consumer(std::shared_ptr<PairsInFlight> owner) : owner_(std::move(owner)) {}

    std::shared_ptr<PairsInFlight> owner_;
    // Guarded by the owner's mutex:
    std::deque<Pair> pairs_;
    std::chrono::steady_clock::time_point last_finished_;
  };

  /// The object that all users of the same topic share.
  static std::shared_ptr<PairsInFlight> of(const std::string& topic);

  /// A stage begins to listen; it stops when the consumer is destroyed.
  static std::unique_ptr<Consumer> join(const std::string& topic);

  /// rectify has handed on the pair of this stamp.
  void handedOn(const ros::Time& stamp);
  /// Waits until every stage has fewer than this many pairs to do, but not longer than the timeout. Returns
  /// whether this is so. When a stage finishes nothing for a second, the pairs that it has had for a second
  /// count as lost on their way.
  bool waitUntilBelow(size_t limit, std::chrono::milliseconds timeout);

 private:
  void forgetLost();  // with the mutex held
  bool below(size_t limit) const;

  std::mutex mutex_;
  std::condition_variable changed_;
  std::list<Consumer*> consumers_;
};

}  // namespace uav_landing
