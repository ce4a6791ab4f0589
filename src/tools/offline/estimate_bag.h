#pragma once

#include <rosbag/bag.h>

#include <string>

#include "offline/processed_pair.h"
#include "pending_file.h"

namespace uav_landing {

/// Writes the messages that the nodelets would publish, on the same topics, at the stamps of the images.
/// Pairs with an unusable image have none, because the nodelets drop them.
class EstimateBag : public PairSink {
 public:
  explicit EstimateBag(const std::string& path);
  void take(const ProcessedPair& pair) override;
  void finish() override;

 private:
  PendingFile pending_;
  rosbag::Bag bag_;
};

}  // namespace uav_landing
