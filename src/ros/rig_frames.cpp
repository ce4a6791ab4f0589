#include "rig_frames.h"

#include <tf2/exceptions.h>
#include <tf2_eigen/tf2_eigen.h>

#include <cmath>

namespace uav_landing {
namespace {

constexpr size_t kMostFrames = 10000;     // of a whole robot there are hundreds
constexpr double kUnitTolerance = 0.001;  // of a quaternion's length

/// tf2 knows frames without a leading slash.
std::string stripped(const std::string& frame) { return frame.rfind('/', 0) == 0 ? frame.substr(1) : frame; }

/// What tf2 lets pass: lengths that are no number, and quaternions that are not quite of unit length.
bool usable(const geometry_msgs::Transform& transform) {
  const auto& t = transform.translation;
  const Eigen::Quaterniond q(transform.rotation.w, transform.rotation.x, transform.rotation.y,
                             transform.rotation.z);
  return std::isfinite(t.x) && std::isfinite(t.y) && std::isfinite(t.z) &&
         std::abs(q.norm() - 1) <= kUnitTolerance;
}

}  // namespace

RigFrames::RigFrames(const std::string& base_frame, const std::string& runway_frame)
    : base_frame_(stripped(base_frame)), runway_frame_(stripped(runway_frame)) {}

void RigFrames::add(const tf2_msgs::TFMessage& message, bool is_static) {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (const geometry_msgs::TransformStamped& transform : message.transforms) {
    const std::string parent = stripped(transform.header.frame_id);
    const std::string child = stripped(transform.child_frame_id);
    if (parent == child || parent.empty() || child.empty()) continue;
    if (parent == runway_frame_ || !usable(transform.transform)) continue;
    // tf2 never forgets a name, be it of a parent or a child.
    if (names_.size() + 2 > kMostFrames && (names_.count(parent) == 0 || names_.count(child) == 0)) continue;
    names_.insert({parent, child});
    parents_[child] = parent;
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

  const std::optional<Eigen::Isometry3d> left_from_base = look(left, base);
  if (!left_from_base) {
    if (!base_frame_.empty())
      camera.failure = {Reason::kTransformMissing, "no static transform between " + base + " and " + left};
    return camera;
  }
  const bool has_parent = parents_.count(base) > 0;
  // Not the root of the tree: without being told to, the estimate does not interfere with it.
  if (has_parent && base_frame_.empty()) return camera;
  Child child;
  child.frame = base;
  child.left_from_child = left_from_base;
  child.may_broadcast = !has_parent;
  return child;
}

std::optional<Eigen::Isometry3d> RigFrames::leftFrom(const std::string& left_frame,
                                                     const std::string& frame) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return look(stripped(left_frame), stripped(frame));
}

std::optional<Eigen::Isometry3d> RigFrames::look(const std::string& target, const std::string& source) const {
  try {
    Eigen::Isometry3d transform =
        tf2::transformToEigen(static_transforms_.lookupTransform(target, source, ros::Time()));
    transform.linear() = Eigen::Quaterniond(transform.linear()).normalized().toRotationMatrix();
    return transform;
  } catch (const tf2::TransformException&) {
    return std::nullopt;  // not connected, not known, or a loop
  }
}

}  // namespace uav_landing
