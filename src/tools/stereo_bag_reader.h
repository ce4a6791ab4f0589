#pragma once

#include <rosbag/bag.h>

#include <array>
#include <cstddef>
#include <functional>
#include <string>

#include "pairing.h"
#include "uav_landing/failure.h"

namespace uav_landing {

/// Streams the image pairs of a bag, message by message.
class StereoBagReader {
 public:
  /// Throws std::runtime_error with a message for the user when the file cannot be opened as a bag.
  /// camera: namespace of the cameras without a slash in front.
  StereoBagReader(const std::string& path, const std::string& camera);

  /// Which topic is missing or of another type, and what the bag contains instead.
  Failure checkTopics() const;
  /// Left images in the bag.
  std::size_t leftImages() const;
  std::size_t messages() const;
  /// Left image, left camera_info, right image, right camera_info.
  const std::array<std::string, 4>& topics() const { return topics_; }

  /// Hands every message to the pairing, in the order of the bag; after each of them calls progress().
  /// Throws rosbag::BagException where the file is damaged.
  void read(StereoPairing& pairing, const std::function<void()>& progress) const;

 private:
  rosbag::Bag bag_;
  std::array<std::string, 4> topics_;
};

}  // namespace uav_landing
