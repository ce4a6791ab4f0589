#pragma once

#include <opencv2/core.hpp>

namespace uav_landing {
namespace test {

/// While it lives, counts the images that are allocated and still held, and leaves the work to OpenCV.
class CountingAllocator : public cv::MatAllocator {
 public:
  CountingAllocator() : standard_(cv::Mat::getStdAllocator()) { cv::Mat::setDefaultAllocator(this); }
  ~CountingAllocator() override { cv::Mat::setDefaultAllocator(standard_); }
  CountingAllocator(const CountingAllocator&) = delete;
  CountingAllocator& operator=(const CountingAllocator&) = delete;

  cv::UMatData* allocate(int dims, const int* sizes, int type, void* data, size_t* step, cv::AccessFlag flags,
                         cv::UMatUsageFlags usage) const override {
    cv::UMatData* image = standard_->allocate(dims, sizes, type, data, step, flags, usage);
    image->currAllocator = image->prevAllocator = this;
    ++allocated;
    ++held;
    return image;
  }
  bool allocate(cv::UMatData* image, cv::AccessFlag flags, cv::UMatUsageFlags usage) const override {
    return standard_->allocate(image, flags, usage);
  }
  void deallocate(cv::UMatData* image) const override {
    --held;
    standard_->deallocate(image);
  }

  mutable int allocated = 0, held = 0;

 private:
  cv::MatAllocator* standard_;
};

}  // namespace test
}  // namespace uav_landing
