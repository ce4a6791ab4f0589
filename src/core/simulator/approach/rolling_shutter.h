#pragma once

#include <opencv2/core.hpp>

#include "uav_landing/simulator/parameters.h"

namespace uav_landing {

/// Tells when a camera exposes which part of its raw image. A rolling shutter exposes line by line: rows from
/// the top, or columns from the left. Times are relative to the stamp, s.
class RollingShutter {
 public:
  explicit RollingShutter(const SimulatedImageParameters& image) : image_(image) {}

  bool atOnce() const { return image_.readout_time == 0; }
  int lines() const { return alongColumns() ? image_.width : image_.height; }
  /// Middle of the line's exposure, s.
  double timeOf(int line) const { return ((line + 0.5) / lines() - image_.stamp_row) * image_.readout_time; }
  double first() const { return timeOf(0); }
  double last() const { return timeOf(lines() - 1); }
  cv::Rect part(int line) const {
    return alongColumns() ? cv::Rect(line, 0, 1, image_.height) : cv::Rect(0, line, image_.width, 1);
  }

 private:
  bool alongColumns() const {
    return image_.row_direction == SimulatedImageParameters::RowDirection::kColumns;
  }

  SimulatedImageParameters image_;
};

}  // namespace uav_landing
