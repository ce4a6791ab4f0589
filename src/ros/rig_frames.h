#pragma once

#include <tf2/buffer_core.h>
#include <tf2_msgs/TFMessage.h>

#include <Eigen/Geometry>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>

#include "uav_landing/base/failure.h"

namespace uav_landing {

/// Finds the frame that is estimated, and its lever arm, in the rig's own tf tree. Lever arms come from
/// static tf only. Thread safe.
class RigFrames {
 public:
  struct Child {
    std::string frame;
    /// Child frame seen from the left camera as it is mounted (its optical frame): x_left = T x_child. None:
    /// the child is the rectified left camera itself.
    std::optional<Eigen::Isometry3d> left_from_child;
    bool may_broadcast = true;  ///< the frame has no other parent
    Failure failure;            ///< the configured base frame is not known (yet)
  };

  /// base_frame: the configured one, or "" for base_link if static tf knows it.
  RigFrames(const std::string& base_frame, const std::string& runway_frame);

  /// A message of /tf_static or /tf. Transforms that are none (lengths or rotations that are no numbers) are
  /// left out.
  void add(const tf2_msgs::TFMessage& message, bool is_static);

  /// left_frame: frame_id of the left camera.
  Child find(const std::string& left_frame) const;
  /// x_left = T x_frame for any frame that static tf connects with the left camera; none: it does not.
  std::optional<Eigen::Isometry3d> leftFrom(const std::string& left_frame, const std::string& frame) const;

 private:
  std::optional<Eigen::Isometry3d> look(const std::string& target, const std::string& source) const;

  const std::string base_frame_, runway_frame_;
  mutable std::mutex mutex_;
  tf2::BufferCore static_transforms_;
  std::map<std::string, std::string> parents_;  // of every frame on tf; our own transform aside
  std::set<std::string> names_;                 // of all frames
};

}  // namespace uav_landing
