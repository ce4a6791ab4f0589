#include "image_input.h"

#include <sensor_msgs/image_encodings.h>

#include <algorithm>
#include <boost/endian/conversion.hpp>
#include <boost/make_shared.hpp>
#include <iterator>
#include <sstream>

namespace uav_landing {
namespace {

namespace encodings = sensor_msgs::image_encodings;

/// An encoding and how to read it. OpenCV's names tell the number of channels but not which ones they are.
/// Most drivers that use them have a grey or a blue-green-red image.
struct Encoding {
  const char* name;
  const char* like;  // the name that cv_bridge knows it by
  uint32_t pixel_bytes;

  bool has16Bits() const { return encodings::bitDepth(like) == 16; }
};

// sensor_msgs of Noetic does not know this name.
constexpr const char* kYuy2 = "yuv422_yuy2";

const Encoding kEncodings[] = {
    {"mono8", "mono8", 1},
    {"mono16", "mono16", 2},
    {"8UC1", "mono8", 1},
    {"16UC1", "mono16", 2},
    {"bgr8", "bgr8", 3},
    {"rgb8", "rgb8", 3},
    {"bgra8", "bgra8", 4},
    {"rgba8", "rgba8", 4},
    {"8UC3", "bgr8", 3},
    {"8UC4", "bgra8", 4},
    {"bgr16", "bgr16", 6},
    {"rgb16", "rgb16", 6},
    {"bgra16", "bgra16", 8},
    {"rgba16", "rgba16", 8},
    {"16UC3", "bgr16", 6},
    {"16UC4", "bgra16", 8},
    {"bayer_rggb8", "bayer_rggb8", 1},
    {"bayer_bggr8", "bayer_bggr8", 1},
    {"bayer_gbrg8", "bayer_gbrg8", 1},
    {"bayer_grbg8", "bayer_grbg8", 1},
    {"bayer_rggb16", "bayer_rggb16", 2},
    {"bayer_bggr16", "bayer_bggr16", 2},
    {"bayer_gbrg16", "bayer_gbrg16", 2},
    {"bayer_grbg16", "bayer_grbg16", 2},
    {"yuv422", "yuv422", 2},
    {"uyvy", "yuv422", 2},
    {kYuy2, "8UC2", 2},
    {"yuyv", "8UC2", 2},
};

const Encoding* encodingOf(const sensor_msgs::Image& image) {
  const auto found = std::find_if(std::begin(kEncodings), std::end(kEncodings),
                                  [&](const Encoding& known) { return image.encoding == known.name; });
  return found == std::end(kEncodings) ? nullptr : found;
}

/// Returns what is wrong with the message; "" when nothing is.
std::string checkImage(const sensor_msgs::Image& image, const cv::Size& expected) {
  std::ostringstream problem;
  const Encoding* encoding = encodingOf(image);
  if (encoding == nullptr) {
    problem << "encoding: \"" << image.encoding << "\" is not one of";
    for (const Encoding& known : kEncodings) problem << " " << known.name;
    return problem.str();
  }
  const auto width = static_cast<uint32_t>(std::max(0, expected.width));
  const auto height = static_cast<uint32_t>(std::max(0, expected.height));
  if (image.width != width || image.height != height) {
    problem << "width, height: " << image.width << "x" << image.height << ", but camera_info announces "
            << width << "x" << height;
    return problem.str();
  }
  const size_t pixel_bytes = encoding->pixel_bytes;
  if (image.step < image.width * pixel_bytes) {
    problem << "step: " << image.step << " bytes are fewer than a row of " << image.width << " pixels "
            << image.encoding << " needs (" << image.width * pixel_bytes << ")";
    return problem.str();
  }
  if (encoding->has16Bits() && image.step % 2 != 0) {
    problem << "step: " << image.step << " bytes are no whole number of values of 16 bits";
    return problem.str();
  }
  const size_t size = static_cast<size_t>(image.step) * image.height;
  if (image.data.size() != size) {
    problem << "data: " << image.data.size() << " bytes, but step x height is " << size;
    return problem.str();
  }
  return "";
}

bool isOtherByteOrder(const sensor_msgs::Image& image) {
  const bool native_big = boost::endian::order::native == boost::endian::order::big;
  return encodingOf(image)->has16Bits() && static_cast<bool>(image.is_bigendian) != native_big;
}

/// The same image in this machine's byte order. (cv_bridge 1.16 returns black for mono16 of the other order.)
sensor_msgs::ImageConstPtr inNativeByteOrder(const sensor_msgs::ImageConstPtr& image) {
  if (!isOtherByteOrder(*image)) return image;
  const auto swapped = boost::make_shared<sensor_msgs::Image>(*image);
  swapped->is_bigendian = static_cast<uint8_t>(image->is_bigendian == 0);
  for (size_t i = 0; i + 1 < swapped->data.size(); i += 2) std::swap(swapped->data[i], swapped->data[i + 1]);
  return swapped;
}

/// The message's pixels as they are, under the name that cv_bridge knows. They keep the message alive.
cv_bridge::CvImageConstPtr shared(const sensor_msgs::ImageConstPtr& image, const char* like) {
  if (image->encoding == like) return cv_bridge::toCvShare(image);
  const int depth = encodings::bitDepth(like) == 16 ? CV_16U : CV_8U;
  // The pixels are not written to, as CvImageConstPtr points to a constant image.
  auto* data = const_cast<uint8_t*>(image->data.data());
  const cv::Mat pixels(static_cast<int>(image->height), static_cast<int>(image->width),
                       CV_MAKETYPE(depth, encodings::numChannels(like)), data, image->step);
  const auto keep_alive = [image](cv_bridge::CvImage* view) { delete view; };
  return {new cv_bridge::CvImage(image->header, like, pixels), keep_alive};
}

cv_bridge::CvImageConstPtr inMono16(const cv_bridge::CvImageConstPtr& pixels) {
  return pixels->encoding == encodings::MONO16 ? pixels : cv_bridge::cvtColor(pixels, encodings::MONO16);
}

cv_bridge::CvImageConstPtr grey(const sensor_msgs::ImageConstPtr& image, const GreyRange& range) {
  const Encoding& encoding = *encodingOf(*image);
  const cv_bridge::CvImageConstPtr pixels = shared(inNativeByteOrder(image), encoding.like);
  if (encoding.like == encodings::MONO8) return pixels;
  const auto mono = boost::make_shared<cv_bridge::CvImage>(image->header, encodings::MONO8);
  if (encoding.like == encodings::TYPE_8UC2)
    cv::extractChannel(pixels->image, mono->image, 0);  // YUYV
  else if (encoding.has16Bits())
    range.toMono8(inMono16(pixels)->image, mono->image);
  else
    return cv_bridge::cvtColor(pixels, encodings::MONO8);
  return mono;
}

/// The values of a 16-bit image; empty for others.
cv::Mat valuesOf16Bits(const sensor_msgs::ImageConstPtr& image, const CameraCalibration& calibration) {
  if (!checkImage(*image, calibration.imageSize()).empty() || !encodingOf(*image)->has16Bits()) return {};
  const cv_bridge::CvImageConstPtr pixels = shared(inNativeByteOrder(image), encodingOf(*image)->like);
  return isOtherByteOrder(*image) ? pixels->image.clone() : pixels->image;
}

}  // namespace

std::string PairGreyRange::follow(const sensor_msgs::ImageConstPtr& left,
                                  const CameraCalibration& left_camera,
                                  const sensor_msgs::ImageConstPtr& right,
                                  const CameraCalibration& right_camera) {
  const ros::Time stamp = left->header.stamp;
  if (stamp < last_stamp_) reset();
  last_stamp_ = stamp;
  const bool told = finder_.exceeded();
  finder_.follow(valuesOf16Bits(left, left_camera), valuesOf16Bits(right, right_camera));
  return finder_.exceeded() && !told ? exceededText(bits_) : "";
}

Expected<cv_bridge::CvImageConstPtr> toMono8(const sensor_msgs::ImageConstPtr& image,
                                             const CameraCalibration& calibration, const std::string& topic,
                                             const GreyRange& range) {
  const std::string problem = checkImage(*image, calibration.imageSize());
  if (!problem.empty()) return tl::make_unexpected(Failure{Reason::kInputInvalid, topic + ": " + problem});
  try {
    return grey(image, range);
  } catch (const std::exception& error) {
    return tl::make_unexpected(Failure{Reason::kInputInvalid, topic + ": " + error.what()});
  }
}

}  // namespace uav_landing
