#pragma once

#include <optional>

#include "camera_info.h"
#include "uav_landing/rectification.h"

namespace uav_landing {

/// The two calibrations a nodelet works with; notices when a camera_info differs from the one before.
class RigWatch {
 public:
  /// True for the first pair of camera_infos and for each that differs (stamps aside).
  bool changed(const sensor_msgs::CameraInfo& left, const sensor_msgs::CameraInfo& right) {
    CameraCalibration new_left = toCalibration(left), new_right = toCalibration(right);
    if (left_ == new_left && right_ == new_right) return false;
    left_ = std::move(new_left);
    right_ = std::move(new_right);
    return true;
  }
  /// After the first call of changed().
  const CameraCalibration& left() const { return *left_; }
  const CameraCalibration& right() const { return *right_; }

 private:
  std::optional<CameraCalibration> left_, right_;
};

/// A stage that works on rectified images, made anew whenever the cameras are new or changed.
template <class Stage, class Parameters>
class RigStage {
 public:
  /// What is wrong with the cameras; without a failure there is a stage.
  Failure prepare(const sensor_msgs::CameraInfo& left, const sensor_msgs::CameraInfo& right,
                  const Parameters& parameters) {
    if (!cameras_.changed(left, right)) return failure_;
    stage_.reset();
    const auto model = makeRigModel(cameras_.left(), cameras_.right());
    failure_ = model ? Failure() : model.error();
    if (model) stage_.emplace(*model, parameters);
    return failure_;
  }
  const RigWatch& cameras() const { return cameras_; }
  Stage& operator*() { return *stage_; }
  Stage* operator->() { return &*stage_; }

 private:
  RigWatch cameras_;
  Failure failure_;
  std::optional<Stage> stage_;
};

}  // namespace uav_landing
