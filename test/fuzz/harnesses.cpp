#include "fuzz/harnesses.h"

#include <ros/console.h>

#include <cstdio>
#include <cstdlib>

namespace uav_landing {
namespace fuzz {

const std::vector<NamedHarness>& harnesses() {
  static const std::vector<NamedHarness> all = {{"calibration_file", fuzzCalibrationFile},
                                                {"camera_info", fuzzCameraInfo},
                                                {"config", fuzzConfig},
                                                {"image_message", fuzzImageMessage},
                                                {"image_pair", fuzzImagePair},
                                                {"imu", fuzzImu},
                                                {"messages", fuzzMessages},
                                                {"bag", fuzzBag},
                                                {"dataset", fuzzDataset}};
  return all;
}

void silenceLog() {
  static const bool silent = [] {
    const bool set = ros::console::set_logger_level(ROSCONSOLE_DEFAULT_NAME, ros::console::levels::Fatal);
    ros::console::notifyLoggerLevelsChanged();
    return set;
  }();
  require(silent, "the log can be silenced");
}

void require(bool kept, const char* text) {
  if (kept) return;
  std::fprintf(stderr, "broken promise: %s\n", text);
  std::abort();
}

}  // namespace fuzz
}  // namespace uav_landing
