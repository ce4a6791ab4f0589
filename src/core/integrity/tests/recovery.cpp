#include "integrity/tests/recovery.h"

namespace uav_landing {
namespace {

constexpr double kRounding = 1e-6;  // s, rounding errors of added durations

}  // namespace

void Recovery::follow(double T, Pair pair, bool lost) {
  if (pair == Pair::kContradicts) quiet_ = 0;
  if (pair == Pair::kAgrees && T > 0) quiet_ += T;
  if (lost) pending_ = true;
  if (quiet_ >= needed_ - kRounding) pending_ = false;
}

}  // namespace uav_landing
