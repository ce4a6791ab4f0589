#pragma once

#include <fstream>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "offline/processed_pair.h"
#include "pending_file.h"
#include "uav_landing/parameters/overlay_parameters.h"

namespace uav_landing {

/// Writes what `evaluate --report` needs besides the estimates, in one folder. timing.csv has stamp_s and,
/// for each part of the stages, its time in ms. Its column overlay is the time to draw the image. Images of
/// five frames are spread over the bag: lines_left_N.png, lines_right_N.png (the paper's Figure 4),
/// matches_N.png (Figure 5), overlay_N.png.
class ReportData : public PairSink {
 public:
  /// Makes the folder. pairs: expected number, to choose the frames.
  ReportData(const std::string& folder, std::size_t pairs, const OverlayParameters& overlay);
  void take(const ProcessedPair& pair) override;
  void finish() override;

 private:
  std::size_t column(const std::string& part);
  void writePictures(const ProcessedPair& pair, const cv::Mat& overlay) const;

  std::string folder_;
  std::size_t expected_pairs_, pairs_ = 0;
  OverlayParameters overlay_;
  PendingFile rows_, table_;
  std::ofstream rows_file_;
  std::vector<std::string> columns_;  ///< in the order in which they first appeared
};

}  // namespace uav_landing
