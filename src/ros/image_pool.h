#pragma once

#include <sensor_msgs/Image.h>

#include <boost/shared_ptr.hpp>
#include <memory>
#include <mutex>
#include <vector>

namespace uav_landing {

/// Image messages whose memory is used again when nobody holds them any more. Thread safe.
class ImagePool {
 public:
  /// kept: largest number of unused messages.
  explicit ImagePool(size_t kept) : store_(std::make_shared<Store>(kept)) {}

  /// A message to fill in. Its old contents are still there.
  boost::shared_ptr<sensor_msgs::Image> take() {
    std::unique_ptr<sensor_msgs::Image> image = store_->take();
    // The deleter holds the store, because subscribers may keep a message longer than the pool lives.
    return {image.release(), [store = store_](sensor_msgs::Image* used) { store->give(used); }};
  }

 private:
  class Store {
   public:
    explicit Store(size_t kept) : kept_(kept) {}
    std::unique_ptr<sensor_msgs::Image> take() {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (unused_.empty()) return std::make_unique<sensor_msgs::Image>();
      std::unique_ptr<sensor_msgs::Image> image = std::move(unused_.back());
      unused_.pop_back();
      return image;
    }
    void give(sensor_msgs::Image* used) {
      std::unique_ptr<sensor_msgs::Image> image(used);
      const std::lock_guard<std::mutex> lock(mutex_);
      if (unused_.size() < kept_) unused_.push_back(std::move(image));
    }

   private:
    const size_t kept_;
    std::mutex mutex_;
    std::vector<std::unique_ptr<sensor_msgs::Image>> unused_;
  };

  std::shared_ptr<Store> store_;
};

}  // namespace uav_landing
