#include "fuzz/harnesses.h"

#include <console_bridge/console.h>
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
    // All of ROS, not only this package: camera_calibration_parsers has a logger of its own.
    const bool set = ros::console::set_logger_level(ROSCONSOLE_ROOT_LOGGER_NAME, ros::console::levels::Fatal);
    ros::console::notifyLoggerLevelsChanged();
    console_bridge::setLogLevel(console_bridge::CONSOLE_BRIDGE_LOG_NONE);
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
