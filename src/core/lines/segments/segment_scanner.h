#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "base/image_memory.h"
#include "lines/segments/line_segment.h"

namespace uav_landing {

/// Limits of an edge, and of the length of a straight one.
struct EdgeLimits {
  double low, high;   ///< weak edges, and edges from which a line starts: |gu| + |gv| of 3x3 Sobel responses
  double min_length;  ///< px
  double max_gap;     ///< px, within a line
};

/// Finds straight edges without looking at every pixel. An edge as long as min_length crosses scan lines that
/// lie a third of this length apart. From there a straight line follows it, row by row (column by column when
/// it is flat), and is fitted as it grows. Keeps its memory.
class SegmentScanner {
 public:
  /// image: mono8. ground: mono8; edges count only where it is not 0.
  std::vector<RoughSegment> find(const cv::Mat& image, const cv::Mat& ground, const EdgeLimits& limits);
  /// The last image with its columns as rows, until the next call of find().
  const cv::Mat& transposed() const { return transposed_; }

 private:
  cv::Mat transposed_;
  ImageMemory memory_, taken_;         // of transposed_, and of the scan
  std::vector<short> across_, along_;  // of one row
  std::vector<uchar> starts_;
};

}  // namespace uav_landing
