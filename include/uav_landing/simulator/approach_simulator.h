#pragma once

#include <memory>
#include <opencv2/core.hpp>
#include <utility>

#include "uav_landing/results/truth.h"
#include "uav_landing/simulator/camera_rig.h"
#include "uav_landing/simulator/imu.h"
#include "uav_landing/simulator/parameters.h"
#include "uav_landing/simulator/trajectory.h"

namespace uav_landing {

/// A simulated approach, frame by frame. The same parameters give the same frames, in any order.
class ApproachSimulator {
 public:
  /// Fails when a parameter is wrong. The detail names the section and the parameter.
  static Expected<ApproachSimulator> create(const SimulatorParameters& parameters);

  struct Frame {
    double time = 0;      ///< since the start, s
    cv::Mat left, right;  ///< raw, mono8
    Truth truth;
  };
  int frames() const;
  Frame frame(int index) const;

  /// The light on the two sensors for one frame. To render it is the costly part of a frame.
  struct Light {
    int index = 0;
    cv::Mat left, right;  ///< grey levels before gain, noise and the rest of the lens blur; 32-bit float
  };
  Light light(int index) const;
  /// The frame that sensors with this noise (1 sigma, grey levels) make from this light.
  Frame expose(const Light& light, double noise) const;

  double timeOf(int index) const;
  CameraPose pose(double time) const;
  const CameraRig& rig() const;
  SimulatedImu imu() const;
  double duration() const { return timeOf(frames() - 1); }

 private:
  struct World;
  explicit ApproachSimulator(std::shared_ptr<const World> world) : world_(std::move(world)) {}

  std::shared_ptr<const World> world_;
};

}  // namespace uav_landing
