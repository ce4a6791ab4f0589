#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "camera_info.h"
#include "image_input.h"
#include "uav_landing/geometry/rig_check.h"
#include "uav_landing/image/rectification.h"

namespace uav_landing {

/// The two calibrations that a nodelet works with. It notices when a camera_info differs from the previous
/// one.
class RigWatch {
 public:
  /// True for the first pair of camera_infos and for each that differs (apart from the stamps).
  bool changed(const sensor_msgs::CameraInfo& left, const sensor_msgs::CameraInfo& right) {
    CameraCalibration new_left = toCalibration(left), new_right = toCalibration(right);
    if (left_ == new_left && right_ == new_right) return false;
    left_ = std::move(new_left);
    right_ = std::move(new_right);
    return true;
  }
  /// Valid after the first call of changed().
  const CameraCalibration& left() const { return *left_; }
  const CameraCalibration& right() const { return *right_; }

 private:
  std::optional<CameraCalibration> left_, right_;
};

/// A stage that works on rectified images. It is made anew whenever the cameras are new or changed.
template <class Stage>
class RigStage {
 public:
  /// Calls work(stage, left, right), with the images as mono8. make(rig model): makes a stage for the rig
  /// with these masks. A failure says what is wrong with the cameras or the images, and names the topics.
  template <class Make, class Work>
  auto run(const sensor_msgs::ImageConstPtr& left, const std::string& left_topic,
           const sensor_msgs::CameraInfo& left_info, const sensor_msgs::ImageConstPtr& right,
           const std::string& right_topic, const sensor_msgs::CameraInfo& right_info,
           const RigParameters& limits, const RigMasks& masks, Make&& make, Work&& work)
      -> Expected<decltype(work(std::declval<Stage&>(), cv::Mat(), cv::Mat()))> {
    const CameraCalibration left_camera = toCalibration(left_info), right_camera = toCalibration(right_info);
    // Images are checked before a stage is made for their size, because it takes memory.
    warnings_ = ofCameraInfo(rigWarnings(left_camera, right_camera, limits));
    const auto rig = makeStereoRig(left_camera, right_camera, limits);
    if (!rig) return tl::make_unexpected(ofCameraInfo(rig.error()));
    const auto left_view = toMono8(left, left_camera, left_topic);
    if (!left_view) return tl::make_unexpected(left_view.error());
    const auto right_view = toMono8(right, right_camera, right_topic);
    if (!right_view) return tl::make_unexpected(right_view.error());
    const Failure wrong_cameras = prepare(left_info, right_info, masks, limits, make);
    if (wrong_cameras) return tl::make_unexpected(wrong_cameras);
    return work(*stage_, (*left_view)->image, (*right_view)->image);
  }

  /// Warnings about the cameras of the last pair.
  const std::vector<std::string>& warnings() const { return warnings_; }

  /// The next pair is treated as the first one.
  void reset() {
    cameras_ = RigWatch();
    stage_.reset();
  }

 private:
  // Returns what is wrong with the cameras. Without a failure there is a stage.
  template <class Make>
  Failure prepare(const sensor_msgs::CameraInfo& left, const sensor_msgs::CameraInfo& right,
                  const RigMasks& masks, const RigParameters& parameters, Make&& make) {
    if (!cameras_.changed(left, right)) return failure_;
    stage_.reset();
    const auto model = makeRigModel(cameras_.left(), cameras_.right(), masks, parameters);
    failure_ = model ? Failure() : ofCameraInfo(model.error());
    if (model) stage_.emplace(make(*model));
    return failure_;
  }

  RigWatch cameras_;
  Failure failure_;
  std::vector<std::string> warnings_;
  std::optional<Stage> stage_;
};

}  // namespace uav_landing
