#include <camera_calibration_parsers/parse.h>

#include "camera_info.h"
#include "datasets/dataset.h"
#include "fuzz/harnesses.h"
#include "fuzz/input.h"
#include "fuzz/memory_file.h"
#include "uav_landing/geometry/rig_check.h"
#include "uav_landing/image/rectification.h"

namespace uav_landing {
namespace fuzz {
namespace {

constexpr int kLargest = 64;  // px; larger images are as likely to be wrong, and slow

CameraCalibration anyCalibration(Input& input, bool right) {
  sensor_msgs::CameraInfo info;
  info.width = input.count(32);
  info.height = input.count(24);
  const char* const models[] = {"plumb_bob", "rational_polynomial", "", "equidistant"};
  const size_t lengths[] = {5, 8, 0, 4};
  const size_t model = input.choice(4);
  info.distortion_model = models[model];
  info.D.resize(input.byte() < 200 ? lengths[model] : input.byte());
  for (double& d : info.D) d = input.number(0.01);
  const double K[] = {30, 0, 16, 0, 30, 12, 0, 0, 1};
  const double P[] = {30, 0, 16, right ? -9.0 : 0.0, 0, 30, 12, 0, 0, 0, 1, 0};
  for (size_t i = 0; i < 9; ++i) info.K[i] = input.number(K[i]);
  for (size_t i = 0; i < 9; ++i) info.R[i] = input.number(i % 4 == 0);
  for (size_t i = 0; i < 12; ++i) info.P[i] = input.number(P[i]);
  info.binning_x = input.count(0);
  info.binning_y = input.count(0);
  info.roi.x_offset = input.count(0);
  info.roi.y_offset = input.count(0);
  info.roi.width = input.count(0);
  info.roi.height = input.count(0);
  return toCalibration(info);
}

void useCalibrations(const CameraCalibration& left, const CameraCalibration& right) {
  for (const CameraCalibration* camera : {&left, &right}) {
    if (const Failure failure = checkCalibration(*camera)) {
      require(!failure.detail.empty(), "a refused calibration says why");
      continue;
    }
    const cv::Size size = camera->imageSize();
    if (size.width > kLargest || size.height > kLargest) continue;
    const Expected<Rectifier> rectifier = Rectifier::create(*camera);
    require(rectifier.has_value(), "a calibration that passed the check makes a rectifier");
    cv::Mat rectified;
    require(!rectifier->rectify(cv::Mat(size, CV_8UC1, cv::Scalar(100)), rectified),
            "an image of the announced size is rectified");
  }
  const Expected<StereoRig> likely = makeStereoRig(left, right, RigParameters());
  require(likely || !likely.error().detail.empty(), "a refused rig says why");
  require(likely || rigWarnings(left, right, RigParameters()).empty(), "nobody warns of what is refused");
  const Expected<StereoRig> rig = makeStereoRig(left, right);
  if (!rig) return;
  require(rig->baseline > 0 && std::isfinite(rig->baseline) && rig->fx > 0 && std::isfinite(rig->fb()),
          "a rig has a baseline and a focal length");
  if (rig->size.width <= kLargest && rig->size.height <= kLargest)
    require(makeRigModel(left, right).has_value(), "a rig has a model");
}

}  // namespace

void fuzzCameraInfo(const uint8_t* data, size_t size) {
  Input input(data, size);
  const CameraCalibration left = anyCalibration(input, false);
  useCalibrations(left, input.byte() < 200 ? anyCalibration(input, true) : left);
}

void fuzzCalibrationFile(const uint8_t* data, size_t size) {
  silenceLog();
  const bool ini = size > 0 && data[0] == '#';
  const MemoryFile file(data, size, ini ? ".ini" : ".yaml");
  if (!file.written()) return;
  const Expected<sensor_msgs::CameraInfo> info = readCalibrationFile(file.path());
  if (info) useCalibrations(toCalibration(*info), toCalibration(*info));
}

}  // namespace fuzz
}  // namespace uav_landing
