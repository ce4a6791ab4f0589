#include "rig_frames.h"

#include <tf2/exceptions.h>
#include <tf2_eigen/tf2_eigen.h>

#include <algorithm>
#include <cmath>

namespace uav_landing {
namespace {

constexpr size_t kMostFrames = 10000;     // a whole robot has hundreds
constexpr size_t kMostLinks = 100;        // from a frame to the root
constexpr double kUnitTolerance = 0.001;  // of a quaternion's length

constexpr char kAircraft[] = "base_link";

/// Returns the name without the leading slash, as tf2 knows frames.
std::string stripped(const std::string& frame) { return frame.rfind('/', 0) == 0 ? frame.substr(1) : frame; }

/// Rejects what tf2 lets pass: lengths that are not numbers, and quaternions that are not quite of unit
/// length.
bool usable(const geometry_msgs::Transform& transform) {
  const auto& t = transform.translation;
  const Eigen::Quaterniond q(transform.rotation.w, transform.rotation.x, transform.rotation.y,
                             transform.rotation.z);
  return std::isfinite(t.x) && std::isfinite(t.y) && std::isfinite(t.z) &&
         std::abs(q.norm() - 1) <= kUnitTolerance;
}

}  // namespace

std::string rectifiedFrame(const std::string& left_frame) {
  const std::string left = stripped(left_frame);
  return left.empty() ? "" : left + "_rect";
}

RigFrames::RigFrames(const std::string& base_frame, const std::string& runway_frame)
    : base_frame_(stripped(base_frame)), runway_frame_(stripped(runway_frame)) {}

void RigFrames::add(const tf2_msgs::TFMessage& message, bool is_static) {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (const geometry_msgs::TransformStamped& transform : message.transforms) {
    const std::string parent = stripped(transform.header.frame_id);
    const std::string child = stripped(transform.child_frame_id);
    if (parent == child || parent.empty() || child.empty()) continue;
    if (parent == runway_frame_ || !usable(transform.transform)) continue;
    // tf2 never forgets a name, be it of a parent or of a child.
    if (names_.size() + 2 > kMostFrames && (names_.count(parent) == 0 || names_.count(child) == 0)) continue;
    names_.insert({parent, child});
    Link& link = parents_[child];
    // A link that is on both topics is static, whichever message came last.
    link.is_static = is_static || (link.is_static && link.parent == parent);
    link.parent = parent;
    if (is_static) static_transforms_.setTransform(transform, "tf_static", true);
  }
}

RigFrames::Child RigFrames::find(const std::string& left_frame) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  const std::string left = stripped(left_frame);
  const std::string base = base_frame_.empty() ? kAircraft : base_frame_;
  Child camera;
  camera.frame = rectifiedFrame(left);
  camera.may_broadcast = !camera.frame.empty() && parents_.count(camera.frame) == 0;

  const std::optional<Eigen::Isometry3d> left_from_base = look(left, base);
  const bool has_parent = parents_.count(base) > 0;
  if (!left_from_base) {
    if (!base_frame_.empty())
      camera.failure = {Reason::kTransformMissing,
                        whyUnknown(left, base, "no static transform between " + base + " and " + left)};
    else if (left.empty() || (!has_parent && !movingLink(left, base).empty()))
      camera.complaint = whyUnknown(left, base, "") + ": the left camera is estimated";
    return camera;
  }
  // The frame is not the root of the tree. The estimate changes such a tree only if base_frame asks for it.
  if (has_parent && base_frame_.empty()) return camera;
  Child child;
  child.frame = base;
  child.left_from_child = left_from_base;
  child.may_broadcast = !has_parent;
  // A camera that calls itself base_link is meant to be the aircraft.
  child.is_left_camera = base == left && base != kAircraft;
  return child;
}

std::optional<Eigen::Isometry3d> RigFrames::leftFrom(const std::string& left_frame,
                                                     const std::string& frame) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return look(stripped(left_frame), stripped(frame));
}

Failure RigFrames::whyNotConnected(const std::string& left_frame, const std::string& frame,
                                   const std::string& otherwise) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return {Reason::kTransformMissing, whyUnknown(stripped(left_frame), stripped(frame), otherwise)};
}

std::string RigFrames::whyUnknown(const std::string& left, const std::string& frame,
                                  const std::string& otherwise) const {
  if (left.empty()) return "the frame_id of the left camera_info is empty";
  const std::string moving = movingLink(left, frame);
  if (!moving.empty()) return moving + " is on /tf, only /tf_static is used for the rig";
  return otherwise;
}

/// "parent -> child" of the first transform between two frames that is only on /tf; "" when there is none.
std::string RigFrames::movingLink(const std::string& a, const std::string& b) const {
  const std::vector<std::string> from_a = towardsRoot(a), from_b = towardsRoot(b);
  const auto common = std::find_first_of(from_a.begin(), from_a.end(), from_b.begin(), from_b.end());
  if (common == from_a.end()) return "";
  for (const std::vector<std::string>* way : {&from_a, &from_b}) {
    for (const std::string& child : *way) {
      if (child == *common) break;
      const Link& link = parents_.at(child);
      if (!link.is_static) return link.parent + " -> " + child;
    }
  }
  return "";
}

/// The frame, its parent, the parent's parent and so on.
std::vector<std::string> RigFrames::towardsRoot(const std::string& frame) const {
  std::vector<std::string> way{frame};
  for (auto link = parents_.find(frame); link != parents_.end() && way.size() < kMostLinks;
       link = parents_.find(way.back()))
    way.push_back(link->second.parent);
  return way;
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
