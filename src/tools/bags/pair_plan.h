#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "uav_landing/parameters/rectify_parameters.h"

namespace uav_landing {

/// Properties of a message that pairing uses.
struct MessageStamp {
  int64_t stamp;  ///< header.stamp, ns; 0: none
  size_t place;   ///< index among all messages of the recording
};

/// The messages of a recording that belong together. Inputs are in this order: left image, left camera_info,
/// right image, right camera_info.
struct PairPlan {
  struct Pair {
    std::array<size_t, 4> messages;  ///< index in the list of each input
    size_t place;                    ///< index of the image that comes first, among all messages
  };
  struct Input {
    std::string topic;
    size_t received = 0, paired = 0;
    size_t unstamped = 0, repeated = 0, late = 0;  ///< messages without a partner for this reason
    size_t held = 0;                               ///< camera_info: pairs that took one of another stamp
    /// Median time from a message without a partner to the nearest one of the other camera, ms; NaN: there is
    /// none.
    double nearest_ms = 0;
    int64_t first = 0, last = 0;  ///< stamps, ns
  };

  std::vector<Pair> pairs;  ///< in the order of their stamps; after the clock was set back, behind the
                            ///< earlier ones
  std::array<Input, 4> inputs;
  int jumps = 0;  ///< times that the clock was set back
  bool approximate = false;
  double max_skew = 0;  ///< s

  /// Says why there is no pair.
  std::string complaint() const;
  /// Messages for people about messages without a partner, one line each.
  std::vector<std::string> notes() const;
  /// Whether more than half of a camera's images are in no pair.
  bool mostLeftOut() const;
};

using StereoStamps = std::array<std::vector<MessageStamp>, 4>;

/// Pairs by header.stamp, whatever the order of the messages. Stamps are equal or, with approximate_sync,
/// those of two images that are each other's nearest within max_skew. An image takes the camera_info with its
/// own stamp, else the last one before it, else the first one.
PairPlan planPairs(const StereoStamps& messages, const std::array<std::string, 4>& topics,
                   const RectifyParameters& parameters);

}  // namespace uav_landing
