#include "image_input.h"

#include <sensor_msgs/image_encodings.h>

#include <algorithm>
#include <array>
#include <boost/endian/conversion.hpp>
#include <boost/make_shared.hpp>
#include <sstream>

namespace uav_landing {
namespace {

namespace encodings = sensor_msgs::image_encodings;

const std::array<std::string, 10> kEncodings{
    encodings::MONO8,       encodings::MONO16,     encodings::BGR8,        encodings::RGB8,
    encodings::BGRA8,       encodings::RGBA8,      encodings::BAYER_RGGB8, encodings::BAYER_BGGR8,
    encodings::BAYER_GBRG8, encodings::BAYER_GRBG8};

/// What is wrong with the message, "" when nothing is.
std::string checkImage(const sensor_msgs::Image& image, const cv::Size& expected) {
  std::ostringstream problem;
  if (std::find(kEncodings.begin(), kEncodings.end(), image.encoding) == kEncodings.end()) {
    problem << "encoding: \"" << image.encoding << "\" is not one of";
    for (const std::string& known : kEncodings) problem << " " << known;
    return problem.str();
  }
  const auto width = static_cast<uint32_t>(std::max(0, expected.width));
  const auto height = static_cast<uint32_t>(std::max(0, expected.height));
  if (image.width != width || image.height != height) {
    problem << "width, height: " << image.width << "x" << image.height << ", but camera_info announces "
            << width << "x" << height;
    return problem.str();
  }
  const size_t pixel_bytes =
      static_cast<size_t>(encodings::numChannels(image.encoding) * encodings::bitDepth(image.encoding) / 8);
  if (image.step < image.width * pixel_bytes) {
    problem << "step: " << image.step << " bytes are fewer than a row of " << image.width << " pixels "
            << image.encoding << " needs (" << image.width * pixel_bytes << ")";
    return problem.str();
  }
  const size_t size = static_cast<size_t>(image.step) * image.height;
  if (image.data.size() != size) {
    problem << "data: " << image.data.size() << " bytes, but step x height is " << size;
    return problem.str();
  }
  return "";
}

/// The same image in this machine's byte order. (cv_bridge 1.16 returns black for mono16 of the other order.)
sensor_msgs::ImageConstPtr inNativeByteOrder(const sensor_msgs::ImageConstPtr& image) {
  const bool native_big = boost::endian::order::native == boost::endian::order::big;
  if (image->encoding != encodings::MONO16 || static_cast<bool>(image->is_bigendian) == native_big)
    return image;
  const auto swapped = boost::make_shared<sensor_msgs::Image>(*image);
  swapped->is_bigendian = native_big;
  for (size_t i = 0; i + 1 < swapped->data.size(); i += 2) std::swap(swapped->data[i], swapped->data[i + 1]);
  return swapped;
}

}  // namespace

Expected<cv_bridge::CvImageConstPtr> toMono8(const sensor_msgs::ImageConstPtr& image,
                                             const CameraCalibration& calibration, const std::string& topic) {
  const std::string problem = checkImage(*image, calibration.imageSize());
  if (!problem.empty()) return tl::make_unexpected(Failure{Reason::kInputInvalid, topic + ": " + problem});
  try {
    return cv_bridge::toCvShare(inNativeByteOrder(image), encodings::MONO8);
  } catch (const std::exception& error) {
    return tl::make_unexpected(Failure{Reason::kInputInvalid, topic + ": " + error.what()});
  }
}

}  // namespace uav_landing
