#include "integrity/tests/stamp_order.h"

#include <cmath>

namespace uav_landing {
namespace {

// So many late stamps in a row mean that the clock was set back by little. Ten are half a second of 20 Hz.
// Three are enough when they come in order, as those of a clock do.
constexpr int kMostLate = 10, kMostInOrder = 3;

}  // namespace

StampOrder::StampOrder(double max_late) : max_late_(std::llround(1e9 * max_late)) {}

StampOrder::Arrival StampOrder::follow(int64_t stamp) {
  if (stamp == 0) return Arrival::kUnstamped;
  if (newest_ != 0 && stamp == newest_) return Arrival::kRepeated;
  if (newest_ != 0 && stamp < newest_) {
    in_order_ = late_ == 0 || stamp > last_late_ ? in_order_ + 1 : 1;
    last_late_ = stamp;
    ++late_;
    if (newest_ - stamp <= max_late_ && late_ < kMostLate && in_order_ < kMostInOrder) return Arrival::kLate;
    startAt(stamp);
    return Arrival::kBackwards;
  }
  startAt(stamp);
  return Arrival::kNext;
}

void StampOrder::startAt(int64_t stamp) {
  newest_ = stamp;
  late_ = in_order_ = 0;
}

void StampOrder::reset() { startAt(0); }

}  // namespace uav_landing
