#include "bags/stamp_epochs.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace uav_landing {
namespace {

constexpr int64_t kSecond = 1000000000;
constexpr double kGap = 0.6;  // of the usual time between stamps; a stamp so far from all others fills a gap
constexpr size_t kInOrder = 3;  // messages in order, among existing stamps: the clock was set back

/// The usual time between two neighbours, ns.
int64_t periodOf(const std::vector<int64_t>& stamps) {
  const std::set<int64_t> sorted(stamps.begin(), stamps.end());
  std::vector<int64_t> steps;
  for (auto next = sorted.begin(), stamp = next == sorted.end() ? next : next++; next != sorted.end();
       stamp = next++)
    if (*stamp != 0) steps.push_back(*next - *stamp);
  if (steps.empty()) return 0;
  std::nth_element(steps.begin(), steps.begin() + steps.size() / 2, steps.end());
  return steps[steps.size() / 2];
}

int64_t distanceTo(const std::set<int64_t>& seen, int64_t stamp) {
  const auto next = seen.lower_bound(stamp);
  int64_t distance = INT64_MAX;
  if (next != seen.end()) distance = *next - stamp;
  if (next != seen.begin()) distance = std::min(distance, stamp - *std::prev(next));
  return distance;
}

class Follower {
 public:
  Follower(const std::vector<int64_t>& stamps, double max_late)
      : stamps_(stamps), max_late_(std::llround(1e9 * max_late)), period_(periodOf(stamps)) {
    epochs_.epoch.resize(stamps.size());
    epochs_.repeated.resize(stamps.size());
    epochs_.late.resize(stamps.size());
  }

  StampEpochs follow() && {
    for (size_t i = 0; i < stamps_.size(); ++i) {
      if (stamps_[i] != 0 && !seen_.empty()) take(i);
      epochs_.epoch[i] = epochs_.jumps;
      if (stamps_[i] == 0 || epochs_.late[i]) continue;
      epochs_.repeated[i] = !seen_.insert(stamps_[i]).second;
    }
    return std::move(epochs_);
  }

 private:
  /// Begins an epoch when the clock was set back.
  void take(size_t i) {
    const int64_t stamp = stamps_[i], newest = *seen_.rbegin();
    if (stamp >= newest) {
      if (stamp > newest) among_.clear();
      return;
    }
    if (stamp < *seen_.begin() - kSecond) return begin({i});
    if (static_cast<double>(distanceTo(seen_, stamp)) >= kGap * static_cast<double>(period_))
      return among_.clear();
    if (newest - stamp > max_late_) return begin({i});
    if (!among_.empty() && stamp <= stamps_[among_.back()]) among_.clear();
    among_.push_back(i);
    epochs_.late[i] = true;
    if (among_.size() == kInOrder) begin(std::vector<size_t>(among_));
  }

  void begin(const std::vector<size_t>& first) {
    ++epochs_.jumps;
    seen_.clear();
    for (const size_t i : first) {
      epochs_.epoch[i] = epochs_.jumps;
      epochs_.late[i] = false;
      if (i != first.back()) seen_.insert(stamps_[i]);  // the last one is added by the caller
    }
    among_.clear();
  }

  const std::vector<int64_t>& stamps_;
  const int64_t max_late_, period_;
  std::set<int64_t> seen_;     // of this epoch
  std::vector<size_t> among_;  // consecutive messages, in order, among existing stamps
  StampEpochs epochs_;
};

}  // namespace

StampEpochs stampEpochs(const std::vector<int64_t>& stamps, double max_late) {
  return Follower(stamps, max_late).follow();
}

}  // namespace uav_landing
