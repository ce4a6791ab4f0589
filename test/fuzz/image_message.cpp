#include <sensor_msgs/image_encodings.h>

#include <boost/make_shared.hpp>

#include "fuzz/harnesses.h"
#include "fuzz/input.h"
#include "image_input.h"
#include "uav_landing/image/rectification.h"

namespace uav_landing {
namespace fuzz {
namespace {

constexpr int kWidth = 24, kHeight = 16;

CameraCalibration smallCamera() {
  CameraCalibration camera;
  camera.width = kWidth;
  camera.height = kHeight;
  camera.distortion_model = "plumb_bob";
  camera.D = {-0.1, 0.01, 0, 0, 0};
  camera.K << 20, 0, 12, 0, 20, 8, 0, 0, 1;
  camera.R.setIdentity();
  camera.P << 20, 0, 12, 0, 0, 20, 8, 0, 0, 0, 1, 0;
  return camera;
}

}  // namespace

void fuzzImageMessage(const uint8_t* data, size_t size) {
  namespace encodings = sensor_msgs::image_encodings;
  static const std::vector<std::string> known = {encodings::MONO8,
                                                 encodings::MONO16,
                                                 encodings::BGR8,
                                                 encodings::RGB8,
                                                 encodings::BGRA8,
                                                 encodings::RGBA8,
                                                 encodings::BAYER_RGGB8,
                                                 encodings::BAYER_BGGR8,
                                                 encodings::BAYER_GBRG8,
                                                 encodings::BAYER_GRBG8,
                                                 encodings::YUV422,
                                                 encodings::TYPE_32FC1,
                                                 encodings::TYPE_8UC1,
                                                 encodings::BAYER_RGGB16,
                                                 "8UC",
                                                 "32SC512"};
  static const CameraCalibration camera = smallCamera();
  static const Rectifier rectifier = Rectifier::create(camera).value();

  Input input(data, size);
  const auto image = boost::make_shared<sensor_msgs::Image>();
  const size_t encoding = input.choice(known.size() + 1);
  image->encoding = encoding < known.size() ? known[encoding] : input.text();
  image->width = input.count(kWidth);
  image->height = input.count(kHeight);
  const uint32_t row = kWidth * (input.byte() < 128 ? 1 : 1 + input.byte() % 8);
  image->step = input.count(row);
  image->is_bigendian = input.byte();
  const std::string pixels = input.rest();
  const uint64_t fitting = static_cast<uint64_t>(image->step) * image->height;
  image->data.assign(pixels.begin(), pixels.end());
  // Data of the right length, or a little off, is rare by chance.
  if (fitting < 10000 && pixels.size() % 4 != 0) image->data.resize(fitting + pixels.size() % 4 - 1);

  const auto mono = toMono8(image, camera, "image");
  if (!mono) {
    require(mono.error().detail.rfind("image: ", 0) == 0, "the message begins with the topic");
    return;
  }
  require((*mono)->image.type() == CV_8UC1 && (*mono)->image.size() == camera.imageSize(),
          "an accepted image is mono8 of the announced size");
  cv::Mat rectified;
  require(!rectifier.rectify((*mono)->image, rectified), "an accepted image is rectified");
  require(cv::sum(rectified)[0] >= 0, "every pixel can be read");
}

}  // namespace fuzz
}  // namespace uav_landing
