#include "rig_frames.h"

#include <tf2_eigen/tf2_eigen.h>

namespace uav_landing {
namespace {

constexpr size_t kMostFrames = 10000;  // of a whole robot there are hundreds

/// tf2 knows frames without a leading slash.
std::string stripped(const std::string& frame) { return frame.rfind('/', 0) == 0 ? frame.substr(1) : frame; }

}  // namespace

RigFrames::RigFrames(const std::string& base_frame, const std::string& runway_frame)
    : base_frame_(stripped(base_frame)), runway_frame_(stripped(runway_frame)) {}

void RigFrames::add(const tf2_msgs::TFMessage& message, bool is_static) {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (const geometry_msgs::TransformStamped& transform : message.transforms) {
    const std::string parent = stripped(transform.header.frame_id);
    if (parent == runway_frame_) continue;
    if (parents_.size() >= kMostFrames && parents_.count(stripped(transform.child_frame_id)) == 0) continue;
    parents_[stripped(transform.child_frame_id)] = parent;
    if (is_static) static_transforms_.setTransform(transform, "tf_static", true);
  }
}

RigFrames::Child RigFrames::find(const std::string& left_frame) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  const std::string left = stripped(left_frame);
  const std::string base = base_frame_.empty() ? "base_link" : base_frame_;
  Child camera;
  camera.frame = left + "_rect";
  camera.may_broadcast = parents_.count(camera.frame) == 0;

  if (!static_transforms_.canTransform(left, base, ros::Time())) {
    if (!base_frame_.empty())
      camera.failure = {Reason::kTransformMissing, "no static transform between " + base + " and " + left};
    return camera;
  }
  const bool has_parent = parents_.count(base) > 0;
  // Not the root of the tree: without being told to, the estimate does not interfere with it.
  if (has_parent && base_frame_.empty()) return camera;
  Child child;
  child.frame = base;
  child.left_from_child = tf2::transformToEigen(static_transforms_.lookupTransform(left, base, ros::Time()));
  child.may_broadcast = !has_parent;
  return child;
}

std::optional<Eigen::Isometry3d> RigFrames::leftFrom(const std::string& left_frame,
                                                     const std::string& frame) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  const std::string left = stripped(left_frame), other = stripped(frame);
  if (!static_transforms_.canTransform(left, other, ros::Time())) return std::nullopt;
  return tf2::transformToEigen(static_transforms_.lookupTransform(left, other, ros::Time()));
}

}  // namespace uav_landing
