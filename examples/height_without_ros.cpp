// The core without ROS: a pair of images and a stamp in, height and approach angle out. The simulator stands
// in for two cameras; yours give images (mono8) and what camera_info says of each.
//
// height_without_ros [PAIRS], 20 by default.

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "uav_landing/geometry/camera_pair.h"
#include "uav_landing/pipeline.h"
#include "uav_landing/simulator/approach_simulator.h"

namespace ul = uav_landing;

int main(int argc, char** argv) {
  const int pairs = argc > 1 ? std::atoi(argv[1]) : 20;
  const auto cameras = ul::ApproachSimulator::create({});
  if (!cameras) return std::fprintf(stderr, "%s\n", cameras.error().message().c_str()), 1;

  const ul::Parameters parameters;
  const auto pair =
      ul::workingPair(cameras->rig().left.calibration, cameras->rig().right.calibration, parameters.rig);
  if (!pair) return std::fprintf(stderr, "%s\n", pair.error().message().c_str()), 1;
  auto chain = ul::Pipeline::create(pair->left, pair->right, parameters);
  if (!chain) return std::fprintf(stderr, "%s\n", chain.error().message().c_str()), 1;
  for (const std::string& warning : chain->warnings()) std::fprintf(stderr, "%s\n", warning.c_str());

  std::printf("  time s  height m  1 sigma   true m  angle deg  valid\n");
  for (int i = 0; i < pairs && i < cameras->frames(); ++i) {
    const ul::ApproachSimulator::Frame frame = cameras->frame(i);
    const ul::LandingResult& landing = chain->process(frame.time, frame.left, frame.right).landing;
    std::printf("%8.3f %9.3f %8.3f %8.3f %10.3f  %s\n", frame.time, landing.height,
                std::sqrt(landing.height_variance), frame.truth.height, landing.approach_angle * 180 / M_PI,
                landing.valid() ? "yes" : landing.failure.message().c_str());
  }
}
