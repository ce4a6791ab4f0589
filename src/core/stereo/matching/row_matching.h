#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "image/windows/window_template.h"
#include "kernels/window/strip.h"
#include "stereo/matching/row_warp.h"
#include "uav_landing/parameters/stereo_depth_parameters.h"

namespace uav_landing {

/// A place along the row where the window fits.
struct RowCandidate {
  double position = 0;  ///< column in the other image
  double score = 0;     ///< correlation, 1 at best
};

/// Similarity of one window to places along a row of the other image.
class RowSearch {
 public:
  /// Both images are CV_32F, have the same number of rows, and must outlive the search.
  RowSearch(const cv::Mat& reference, const cv::Mat& other, int radius, MatchingCost cost);

  /// Scores the positions centre + k scale, k = -steps..steps, for the window around (u, v). False when the
  /// window leaves the reference image or has no contrast.
  bool run(int u, int v, double centre, int steps, const RowWarp& warp);

  /// Best peak of the last run, with a score of -1 when there is none. second_score gets the score of the
  /// second best peak that is more than two steps away.
  RowCandidate best(double* second_score) const;
  /// All local maxima of at least min_score, best first, at most count.
  std::vector<RowCandidate> peaks(double min_score, int count) const;

 private:
  RowCandidate interpolated(int index) const;

  const cv::Mat& reference_;
  const cv::Mat& other_;
  int radius_;
  MatchingCost cost_;
  int steps_ = 0;
  double centre_ = 0, scale_ = 1;
  WindowTemplate template_;
  std::vector<float> strip_;  // rows of the other image around all positions, less the template's mean
  StripColumns columns_;
  std::vector<float> scores_;
};

}  // namespace uav_landing
