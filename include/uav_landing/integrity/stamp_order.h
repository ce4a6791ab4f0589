#pragma once

#include <cstdint>

namespace uav_landing {

/// What the stamp of a pair says, or of one camera's image, against those before. One that came a little
/// late, after the one behind it, is of no use any more, and what is known stays. Larger steps back are those
/// of a clock that was set back (a bag that loops, a restarted camera). So are late ones alone, many in a
/// row, or three in a row that come in order: then everything starts anew.
class StampOrder {
 public:
  enum class Arrival { kNext, kRepeated, kLate, kBackwards, kUnstamped };

  /// max_late: s behind the newest stamp; 0: every step back is that of a clock.
  explicit StampOrder(double max_late);

  /// stamp: ns; 0 is none. kRepeated, kLate and kUnstamped: to be left out. kBackwards: what waits and what
  /// is remembered is to be forgotten first.
  Arrival follow(int64_t stamp);
  /// Whether such a pair, or image, is to be used.
  static bool isUsed(Arrival arrival) { return arrival == Arrival::kNext || arrival == Arrival::kBackwards; }
  /// Stamps may start anywhere again.
  void reset();

 private:
  void startAt(int64_t stamp);

  int64_t max_late_;       // ns
  int64_t newest_ = 0;     // ns; 0: none yet
  int late_ = 0;           // in a row
  int64_t last_late_ = 0;  // ns, of those
  int in_order_ = 0;       // late ones in a row, each after the one before
};

}  // namespace uav_landing
