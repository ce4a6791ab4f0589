#pragma once

namespace uav_landing {

// visit(): see parameters.h.

/// Pairing and rectification (nodelet rectify).
struct RectifyParameters {
  bool approximate_sync = false;
  double max_skew = 0.01;
  int queue_size = 5;
  double max_late = 0.3;

  template <class Visitor>
  void visit(Visitor&& v) {
    v.flag("approximate_sync", approximate_sync,
           "synchronisation: pair images whose stamps differ, for cameras without a hardware "
           "trigger; else only equal stamps are paired");
    v.number("max_skew", max_skew, 0.0, 0.1, "s", "largest difference of the stamps of an approximate pair");
    v.number("queue_size", queue_size, 1, 100, "pairs", "images kept per input while waiting for the others");
    v.number("max_late", max_late, 0.0, 10.0, "s",
             "largest delay of an image. One that comes after newer ones is dropped when its stamp "
             "is behind theirs by up to this. By more, or three times in a row and in order, the "
             "clock was set back, and everything starts anew. 0: at every step back");
  }
};

}  // namespace uav_landing
