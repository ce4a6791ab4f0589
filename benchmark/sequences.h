#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "uav_landing/base/failure.h"
#include "uav_landing/geometry/calibration.h"

namespace uav_landing {
namespace benchmark {

/// Raw pairs in memory, so that only the work on them is measured.
struct Sequence {
  struct Pair {
    double stamp;         ///< s
    cv::Mat left, right;  ///< mono8
  };
  std::string name;
  CameraCalibration left, right;
  std::vector<Pair> pairs;
};

/// Consecutive pairs of a simulated approach, seen by cameras of this width whose lenses need rectification.
/// config: file of the simulator; its focal lengths are scaled with the width.
Expected<Sequence> simulatedSequence(const std::string& config, int width, int pairs);

/// The same with images of this size, whose upper and lower rows are cut off or added.
Expected<Sequence> simulatedSequence(const std::string& config, const cv::Size& size, int pairs);

/// All pairs of a simulated approach as its file describes them.
Expected<Sequence> wholeApproach(const std::string& config);

/// The first pairs of a dataset folder.
Expected<Sequence> recordedSequence(const std::string& folder, int pairs);

}  // namespace benchmark
}  // namespace uav_landing
