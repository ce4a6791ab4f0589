#include "simulator/approach/sensor.h"

#include <opencv2/imgproc.hpp>

namespace uav_landing {

void expose(const SimulatedImageParameters& image, const SimulatedCameraParameters& camera, uint64_t seed,
            cv::Mat& grey, cv::Mat& mono8) {
  if (image.blur > 0) cv::GaussianBlur(grey, grey, cv::Size(), image.blur, image.blur, cv::BORDER_REPLICATE);
  grey.convertTo(grey, CV_32F, camera.gain, camera.offset);
  if (image.noise > 0) {
    cv::Mat noise(grey.size(), CV_32F);
    cv::RNG(seed).fill(noise, cv::RNG::NORMAL, 0.0, image.noise);
    grey += noise;
  }
  grey.convertTo(mono8, CV_8U);
}

}  // namespace uav_landing
