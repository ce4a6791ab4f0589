#include <rosbag/bag.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "bags/stereo_bag_reader.h"
#include "datasets/dataset.h"
#include "fuzz/harnesses.h"
#include "fuzz/memory_file.h"
#include "image_input.h"
#include "imu_input.h"
#include "rig_watch.h"

namespace uav_landing {
namespace fuzz {
namespace {

namespace fs = std::filesystem;

/// A folder of this process, emptied at the end.
struct Folder {
  fs::path path = memoryFolder() / ("uav_landing_fuzz_" + std::to_string(getpid()));
  Folder() {
    fs::create_directories(path / "left");
    fs::create_directories(path / "right");
  }
  /// Writes a file unless that is its content already.
  void write(const std::string& name, const std::string& content) {
    const auto last = written_.find(name);
    if (last != written_.end() && last->second == content) return;
    std::ofstream(path / name) << content;
    written_[name] = content;
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }

 private:
  std::map<std::string, std::string> written_;
};

/// The part of the input up to the next mark.
std::string section(std::string& rest) {
  const size_t end = rest.find("\n---\n");
  const std::string part = rest.substr(0, end);
  rest = end == std::string::npos ? "" : rest.substr(end + 5);
  return part;
}

/// A bag that stays open: with the last one rosbag unloads its plugin for encryption, which takes longer to
/// load again than all else that a bag takes.
class OpenBag {
 public:
  OpenBag() { bag_.open(file_.path(), rosbag::bagmode::Write); }

 private:
  const MemoryFile file_{nullptr, 0, ".open.bag"};
  rosbag::Bag bag_;
};

}  // namespace

void fuzzBag(const uint8_t* data, size_t size) {
  silenceLog();
  static const OpenBag keeps_the_plugin;
  const MemoryFile file(data, size, ".bag");
  if (!file.written()) return;
  try {
    StereoBagReader reader({file.path()}, "stereo", "/imu/data");
    if (const Failure failure = reader.checkTopics(false)) {
      require(!failure.detail.empty(), "a bag that lacks a topic says which");
      return;
    }
    ImuInput imu{ApproachAngleParameters()};
    reader.readStaticTransforms([&](const tf2_msgs::TFMessage& message) { imu.addTransforms(message); });
    const PairPlan plan = reader.plan({}, [] {});
    require(!plan.pairs.empty() || !plan.complaint().empty(), "a bag without a pair says why");
    reader.read(
        plan,
        [](const auto& left, const auto& left_info, const auto&, const auto&) {
          toMono8(left, toCalibration(*left_info), "left");
        },
        [&](const sensor_msgs::Imu& message) { imu.add(message); });
  } catch (const std::exception&) {
    // What the programs say on stderr, with exit status 1.
  }
}

void fuzzDataset(const uint8_t* data, size_t size) {
  silenceLog();
  static Folder folder;
  std::string rest(reinterpret_cast<const char*>(data), size);
  const std::string left = section(rest), right = section(rest), frames = section(rest);
  folder.write("left.yaml", left);
  folder.write("right.yaml", right.empty() ? left : right);
  folder.write("frames.csv", frames);
  folder.write("left/0.png", rest);
  folder.write("right/0.png", rest);
  const Expected<Dataset> dataset = readDataset(folder.path.string());
  if (!dataset) {
    require(!dataset.error().detail.empty(), "a dataset that cannot be used says why");
    return;
  }
  const cv::Size image_size(static_cast<int>(dataset->left.width), static_cast<int>(dataset->left.height));
  const Expected<cv::Mat> image = readImage(dataset->frames.front().left, image_size);
  require(!image || image->size() == image_size, "an image has the size of the calibration");
}

}  // namespace fuzz
}  // namespace uav_landing
