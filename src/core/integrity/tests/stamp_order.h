#pragma once

#include <cstdint>

namespace uav_landing {

/// Compares the stamp of a pair, or of one camera's image, with those before. A stamp that is slightly behind
/// the newest one is late: it is of no use, and nothing changes. A larger step back means that the clock was
/// set back (a bag that loops, a restarted camera). Many late stamps in a row mean the same, and so do three
/// late ones in a row that come in order. Then everything starts anew.
class StampOrder {
 public:
  enum class Arrival { kNext, kRepeated, kLate, kBackwards, kUnstamped };

  /// max_late: s behind the newest stamp; 0: every step back means that the clock was set back.
  explicit StampOrder(double max_late);

  /// stamp: ns; 0 means that there is none. Do not use a stamp that is kRepeated, kLate or kUnstamped. After
  /// kBackwards, first forget what waits and what is remembered.
  Arrival follow(int64_t stamp);
  /// Whether such a pair or image is used.
  static bool isUsed(Arrival arrival) { return arrival == Arrival::kNext || arrival == Arrival::kBackwards; }
  /// After this, stamps may start anywhere.
  void reset();

 private:
  void startAt(int64_t stamp);

  int64_t max_late_;       // ns
  int64_t newest_ = 0;     // ns; 0: none yet
  int late_ = 0;           // in a row
  int64_t last_late_ = 0;  // ns, of the last late one
  int in_order_ = 0;       // late ones in a row that each come after the one before
};

}  // namespace uav_landing
