#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "image/windows/window_template.h"
#include "kernels/window/shifts.h"

namespace uav_landing {

/// Correlation, blind to gain and offset, of one window with a neighbourhood of another image. The window's
/// pixel at (dx, dy) from its centre is looked for at centre + warp (dx + i, dy + j), for all shifts -steps
/// <= i, j <= steps.
class PatchSearch {
 public:
  /// Both images are CV_32F and must outlive the search.
  PatchSearch(const cv::Mat& reference, const cv::Mat& other, int radius);

  struct Best {
    bool found = false;        ///< a peak inside the range (not at its border), with contrast on both sides
    Eigen::Vector2d position;  ///< in the other image, whole shifts
    double score = -1;         ///< correlation
    double second = -1;        ///< best correlation more than two shifts away
  };
  Best run(int u, int v, const Eigen::Vector2d& centre, const Eigen::Matrix2d& warp, int steps);

 private:
  bool sample(const Eigen::Vector2d& centre, const Eigen::Matrix2d& warp, int steps);
  void score(int steps);

  const cv::Mat& reference_;
  const cv::Mat& other_;
  int radius_;
  WindowTemplate template_;
  int stride_ = 0;  // of the rows of the area
  std::vector<float> area_, scores_;
  ShiftRows rows_;  // memory
};

}  // namespace uav_landing
