#include "uav_landing/integrity/stamp_order.h"

#include <cmath>

namespace uav_landing {
namespace {

// Late stamps in a row that are those of a clock set back by little: half a second of 20 Hz.
constexpr int kMostLate = 10;

}  // namespace

StampOrder::StampOrder(double max_late) : max_late_(std::llround(1e9 * max_late)) {}

StampOrder::Arrival StampOrder::follow(int64_t stamp) {
  if (stamp == 0) return Arrival::kUnstamped;
  if (newest_ != 0 && stamp == newest_) return Arrival::kRepeated;
  if (newest_ != 0 && stamp < newest_) {
    if (newest_ - stamp <= max_late_ && ++late_ < kMostLate) return Arrival::kLate;
    newest_ = stamp;
    late_ = 0;
    return Arrival::kBackwards;
  }
  newest_ = stamp;
  late_ = 0;
  return Arrival::kNext;
}

void StampOrder::reset() {
  newest_ = 0;
  late_ = 0;
}

}  // namespace uav_landing
