#pragma once

#include <vector>

#include "simulator/ground/ground_footprint.h"
#include "uav_landing/simulator/parameters.h"

namespace uav_landing {

/// Tells which part of a small piece of ground is runway and which part is paint. A mark is the product of an
/// interval along the runway and one across it. So the covered area of an axis-aligned rectangle is exact.
class RunwaySurface {
 public:
  explicit RunwaySurface(const SimulatedRunwayParameters& parameters);

  using Patch = GroundPatch;  ///< in the runway frame
  struct Cover {
    float runway;  ///< share of the patch on the runway's surface, paint included
    float paint;   ///< share of the patch that is painted
    /// True when the patch is of one material.
    bool pure() const { return (runway == 0.0f || runway == 1.0f) && (paint == 0.0f || paint == 1.0f); }
  };
  Cover cover(const Patch& patch) const;

  float length() const { return length_; }

 private:
  struct Interval {
    float from, to;
  };
  /// A mark consists of rectangles with the same interval along the runway.
  struct Mark {
    Interval along;
    std::vector<Interval> across;
  };
  void addArrowShafts(const SimulatedRunwayParameters& parameters);
  float paint(const Patch& patch) const;
  float centreLine(const Patch& patch) const;

  float length_, displaced_, half_width_;
  float centre_half_width_, centre_start_, dash_, period_;
  std::vector<Mark> marks_;  ///< of the near half; the far half is its mirror image
};

}  // namespace uav_landing
