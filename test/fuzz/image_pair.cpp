#include <cmath>
#include <opencv2/imgproc.hpp>

#include "fuzz/harnesses.h"
#include "fuzz/input.h"
#include "support/ground_renderer.h"
#include "uav_landing/overlay/overlay.h"
#include "uav_landing/pipeline.h"

namespace uav_landing {
namespace fuzz {
namespace {

// Of the smallest size at which an unspoiled approach has heights and angles; three frames until it has them.
// An input is one to three frames.
constexpr int kWidth = 64, kHeight = 48, kFrames = 3;
constexpr double kStep = 0.1;  // s

CameraCalibration idealCamera(const StereoRig& rig, bool right) {
  CameraCalibration camera;
  camera.width = rig.size.width;
  camera.height = rig.size.height;
  camera.distortion_model = "plumb_bob";
  camera.K = rig.K();
  if (right) camera.K(0, 2) = rig.cx_right;
  camera.R.setIdentity();
  camera.P.leftCols<3>() = camera.K;
  if (right) camera.P(0, 3) = -rig.fb();
  return camera;
}

struct Scene {
  StereoRig rig = test::makeRig(kWidth, kHeight, 0.4);
  cv::Mat left[kFrames], right[kFrames];
  Scene() {
    test::GroundRenderer renderer(3);
    renderer.line_offset = 0.6;
    renderer.bar_period = 0.2;
    renderer.bar_from = 4;
    renderer.bar_to = 6;
    renderer.bar_reach = 0.5;
    for (int i = 0; i < kFrames; ++i) {
      test::Pose pose;
      pose.position = {0.2 * i, 0.05, 1.5 - 0.02 * i};
      pose.pitch = -0.25;
      left[i] = renderer.left(rig, pose);
      right[i] = renderer.right(rig, pose);
    }
  }
};

/// What can happen to a picture on its way.
void spoil(Input& input, cv::Mat& image) {
  const int size = 1 + input.byte() % 64, x = input.byte() % kWidth, y = input.byte() % kHeight;
  const cv::Rect area = cv::Rect(x, y, size, size) & cv::Rect(0, 0, kWidth, kHeight);
  switch (input.choice(10)) {
    case 0:
      image(area).setTo(input.byte());
      break;
    case 1:
      image = image * (input.byte() / 64.0) + (input.byte() - 128);
      break;
    case 2:
      cv::blur(image, image, {1 + input.byte() % 16, 1 + input.byte() % 16});
      break;
    case 3:
      cv::flip(image, image, static_cast<int>(input.choice(3)) - 1);
      break;
    case 4:
      for (int v = area.y; v < area.br().y; ++v)
        for (int u = area.x; u < area.br().x; ++u) image.at<uchar>(v, u) = input.byte();
      break;
    case 5:
      cv::line(image, {x, y}, {input.byte(), input.byte()}, input.byte(), 1 + input.byte() % 8);
      break;
    case 6:
      image.forEach<uchar>([p = 1 + input.byte() % 32](uchar& grey, const int* at) {
        if ((at[0] / p + at[1] / p) % 2 != 0) grey = static_cast<uchar>(255 - grey);
      });
      break;
    case 7:
      image.forEach<uchar>([p = 1 + input.byte() % 32](uchar& grey, const int* at) {
        grey = static_cast<uchar>(128 + 100 * ((at[1] / p) % 2));
      });
      break;
    case 8: {
      const cv::Mat shift =
          (cv::Mat_<double>(2, 3) << 1, 0, input.byte() - 128, 0, 1, input.byte() % 32 - 16);
      cv::warpAffine(image.clone(), image, shift, image.size());
      break;
    }
    default:
      break;
  }
}

void expectHonest(const LandingResult& landing) {
  require(!landing.height_valid ||
              (landing.height > 0 && std::isfinite(landing.height) && landing.height_variance > 0),
          "a valid height is positive and has a variance");
  require(
      !landing.angle_valid || (std::isfinite(landing.approach_angle) && landing.approach_angle_variance > 0),
      "a valid angle is finite and has a variance");
  require(landing.valid() || !landing.failure.message().empty(), "what is not valid says why");
}

}  // namespace

void fuzzImagePair(const uint8_t* data, size_t size) {
  static const Scene scene;
  Input input(data, size);
  Parameters parameters;
  if (input.byte() % 8 == 0) parameters.approach_angle.use_stereo = false;
  // Pictures for people take longer than all stages.
  const bool draw = input.byte() % 8 == 0;
  const int frames = kFrames - static_cast<int>(input.choice(kFrames));
  auto pipeline =
      Pipeline::create(idealCamera(scene.rig, false), idealCamera(scene.rig, true), parameters).value();
  double stamp = 1;
  for (int i = 0; i < frames; ++i) {
    cv::Mat left = scene.left[i].clone(), right = scene.right[i].clone();
    for (int times = static_cast<int>(input.choice(4)); times > 0; --times) {
      const size_t which = input.choice(3);
      if (which == 2)
        cv::swap(left, right);
      else
        spoil(input, which == 0 ? left : right);
    }
    const Pipeline::Output& output = pipeline.process(stamp, left, right, 0);
    expectHonest(output.landing);
    if (draw) drawOverlay(scene.rig, output.left, {output.stereo, output.approach, output.landing}, {});
    stamp += input.byte() < 220 ? kStep : input.number(kStep);
  }
}

}  // namespace fuzz
}  // namespace uav_landing
