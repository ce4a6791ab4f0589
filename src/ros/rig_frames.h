#pragma once

#include <tf2/buffer_core.h>
#include <tf2_msgs/TFMessage.h>

#include <Eigen/Geometry>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "uav_landing/base/failure.h"

namespace uav_landing {

/// Name of the rectified left camera's frame; "" for a camera without a frame_id.
std::string rectifiedFrame(const std::string& left_frame);

/// Finds the frame that is estimated, and its lever arm, in the rig's own tf tree. Lever arms come from
/// static tf only. Thread safe.
class RigFrames {
 public:
  struct Child {
    std::string frame;
    /// Pose of the child frame in the optical frame of the left camera as it is mounted: x_left = T x_child.
    /// None: the child is the rectified left camera itself.
    std::optional<Eigen::Isometry3d> left_from_child;
    bool may_broadcast = true;  ///< the frame has a name and no other parent
    Failure failure;            ///< why the configured base frame is not known (yet)
    std::string complaint;      ///< why it may be another frame than intended, for the log; "": it is not
    /// True when base_frame names the left camera's own frame, which has the axes of a camera.
    bool is_left_camera = false;
    /// Whether the frame should have the axes of an aircraft: forward, left, up.
    bool isAircraft() const { return left_from_child.has_value() && !is_left_camera; }
  };

  /// base_frame: the configured one, or "" for base_link if static tf knows it.
  RigFrames(const std::string& base_frame, const std::string& runway_frame);

  /// Takes a message of /tf_static or /tf. Of the latter only the names of connected frames are used.
  /// Transforms with lengths or rotations that are not numbers are ignored.
  void add(const tf2_msgs::TFMessage& message, bool is_static);

  /// left_frame: frame_id of the left camera.
  Child find(const std::string& left_frame) const;
  /// x_left = T x_frame for any frame that static tf connects with the left camera; none if it does not.
  std::optional<Eigen::Isometry3d> leftFrom(const std::string& left_frame, const std::string& frame) const;
  /// Says why leftFrom() has nothing: a frame without a name, a transform that is on /tf, or else the given
  /// text.
  Failure whyNotConnected(const std::string& left_frame, const std::string& frame,
                          const std::string& otherwise) const;

 private:
  struct Link {
    std::string parent;
    bool is_static = false;
  };

  std::optional<Eigen::Isometry3d> look(const std::string& target, const std::string& source) const;
  std::string whyUnknown(const std::string& left, const std::string& frame,
                         const std::string& otherwise) const;
  std::string movingLink(const std::string& a, const std::string& b) const;
  std::vector<std::string> towardsRoot(const std::string& frame) const;

  const std::string base_frame_, runway_frame_;
  mutable std::mutex mutex_;
  tf2::BufferCore static_transforms_;
  std::map<std::string, Link> parents_;  // of every frame on tf, except our own transform
  std::set<std::string> names_;          // of all frames
};

}  // namespace uav_landing
