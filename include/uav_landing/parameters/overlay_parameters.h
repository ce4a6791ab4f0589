#pragma once

namespace uav_landing {

// visit(): see parameters.h.

/// The overlay image (nodelet overlay).
struct OverlayParameters {
  int scale = 0;

  template <class Visitor>
  void visit(Visitor&& v) {
    v.number("scale", scale, 0, 4, "", "the overlay is enlarged by this factor; 0: at least 640 pixels wide");
  }
};

}  // namespace uav_landing
