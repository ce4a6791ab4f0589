#pragma once

#include <ros/time.h>

#include <string>

#include "uav_landing/pipeline.h"

namespace uav_landing {

/// One image pair of a bag and the chain's results.
struct ProcessedPair {
  ros::Time stamp;         ///< of the left image
  std::string left_frame;  ///< frame_id of the left image
  double skew;             ///< right minus left stamp, s
  /// Set when an image could not be used. Then only output.landing has a meaning (nothing is valid).
  Failure unusable;
  const StereoRig& rig;
  const Pipeline::Output& output;
};

/// Makes something from the pairs of a bag. take() and finish() throw std::exception with a message for the
/// user when they cannot write.
class PairSink {
 public:
  virtual ~PairSink() = default;
  virtual void take(const ProcessedPair& pair) = 0;
  /// Completes the files; without it they are removed.
  virtual void finish() = 0;
};

}  // namespace uav_landing
