#include <cmath>
#include <vector>

#include "body_pose.h"
#include "body_twist.h"
#include "fuzz/harnesses.h"
#include "fuzz/input.h"
#include "landing_markers.h"
#include "pose_covariance.h"
#include "ros/approach_messages.h"
#include "ros/message_fields.h"
#include "runway_path.h"
#include "uav_landing/overlay/overlay.h"
#include "uav_landing/stages/kalman_height_stage.h"

namespace uav_landing {
namespace fuzz {
namespace {

/// Changes fields here and there.
template <class Message>
void spoil(Input& input, Message& message) {
  FieldVisitor visitor;
  const bool all = input.byte() > 250;
  const double everywhere = input.number(0);
  visitor.on_number = [&](double& number) { number = all ? everywhere : input.number(number); };
  visitor.on_count = [&](uint32_t& count) { count = input.count(count); };
  visitor.on_length = [&](size_t length) {
    return input.byte() < 240 ? length : input.take<uint16_t>() % (2 * length + 2);
  };
  visitor.on_text = [&](std::string& text) {
    if (input.byte() > 230) text = input.byte() < 128 ? "too_few_matches: " : input.text();
  };
  visitor.visit(message);
}

/// What the nodelet does with an estimate.
void useResult(const ApproachMessages& messages, const LandingResult& camera) {
  const StereoDepthResult stereo = toResult(messages.stereo);
  const ApproachAngleResult approach = toResult(messages.approach);
  const Eigen::Vector3d arm(0.1, -0.5, 2);
  const LandingResult body = referTo(arm, camera, stereo.plane, approach.step, {});
  require(!body.height_valid || std::isfinite(body.height), "a valid height of the body is finite");
  static RunwayPath path;
  const auto place = path.update(camera);
  if (place) {
    const Matrix6d covariance = poseCovariance(camera, stereo.plane, arm, place->variance);
    require(covariance.rows() == 6, "a place has a covariance");
  }
  const auto twist =
      bodyTwist(camera, approach.step.duration, 1, Eigen::Isometry3d(Eigen::Translation3d(arm)));
  if (twist && camera.height_valid)
    require(twist->covariance.allFinite() && twist->covariance.diagonal().minCoeff() > 0,
            "a velocity has a covariance");
  std::optional<DrawnAircraft> aircraft;
  if (place)
    aircraft = {
        place->position,
        {std::sqrt(place->variance.x()), std::sqrt(place->variance.y()), std::sqrt(camera.height_variance)},
        runwayFromCamera(camera)};
  drawLanding(messages.stereo.header, {}, body, aircraft, Eigen::Vector2d(20, 0), path.track(),
              path.runwayWidth());
  static const cv::Mat grey(messages.rig.size.height, messages.rig.size.width, CV_8UC1, cv::Scalar(100));
  static int turn = 0;
  if (++turn % 64 == 0) drawOverlay(messages.rig, grey, {stereo, approach, camera}, {});
}

void expectHonest(const LandingResult& result) {
  require(!result.height_valid || (result.height > 0 && std::isfinite(result.height) &&
                                   std::isfinite(result.height_variance) && result.height_variance > 0),
          "a valid height is positive and has a variance");
  require(!result.angle_valid ||
              (std::isfinite(result.approach_angle) && std::isfinite(result.approach_angle_variance) &&
               result.approach_angle_variance > 0),
          "a valid angle is finite and has a variance");
}

constexpr int kBefore = 40, kBad = 2, kAfter = 22;  // pairs; after the bad ones a second of good ones
constexpr int kRecovered =
    3;  // pairs, valid and right, after which few inputs wait for the end of that second

/// Good messages of a pair, as the stage takes them.
struct Pair {
  StereoDepthResult stereo;
  ApproachAngleResult approach;
  double height;  // m
};

Pair goodPair(int pair) {
  ApproachMessages messages;
  messages.make(pair);
  return {toResult(messages.stereo), toResult(messages.approach), messages.height(pair)};
}

/// A stage in flight.
KalmanHeightStage settledStage() {
  KalmanHeightStage stage(ApproachMessages().rig, {});
  for (int i = 0; i < kBefore; ++i) {
    const Pair pair = goodPair(i);
    stage.process(pair.stereo, pair.approach);
  }
  return stage;
}

std::vector<Pair> pairsAfterwards() {
  std::vector<Pair> pairs;
  for (int i = 0; i < kAfter; ++i) pairs.push_back(goodPair(kBefore + kBad + i));
  return pairs;
}

}  // namespace

void fuzzMessages(const uint8_t* data, size_t size) {
  // Every input begins with a copy of the stage.
  static const KalmanHeightStage settled = settledStage();
  static const std::vector<Pair> afterwards = pairsAfterwards();
  KalmanHeightStage stage = settled;
  Input input(data, size);
  ApproachMessages messages;
  // Two bad pairs, not more: who publishes wrong planes for long is believed, like any ground.
  for (int i = 0; i < kBad; ++i) {
    messages.make(kBefore + i);
    if (input.byte() < 200) spoil(input, messages.stereo);
    if (input.byte() < 200) spoil(input, messages.approach);
    const LandingResult result = stage.process(toResult(messages.stereo), toResult(messages.approach));
    expectHonest(result);
    useResult(messages, result);
  }
  const bool whole_second = input.byte() % 16 == 15;
  int right = 0;  // pairs in a row
  for (const Pair& pair : afterwards) {
    const LandingResult result = stage.process(pair.stereo, pair.approach);
    expectHonest(result);
    right = result.valid() && std::abs(result.height - pair.height) < 0.5 ? right + 1 : 0;
    if (right == kRecovered && !whole_second) break;
  }
  require(right > 0, "a second of good messages makes the estimate valid again, and right");
}

}  // namespace fuzz
}  // namespace uav_landing
