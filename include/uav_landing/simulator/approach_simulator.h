#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

#include "uav_landing/results/truth.h"
#include "uav_landing/simulator/camera_rig.h"
#include "uav_landing/simulator/imu.h"
#include "uav_landing/simulator/renderer.h"
#include "uav_landing/simulator/trajectory.h"

namespace uav_landing {

/// A simulated approach, frame by frame. The same parameters give the same frames, in any order.
class ApproachSimulator {
 public:
  /// Or what is wrong with the parameters; the detail names section and parameter.
  static Expected<ApproachSimulator> create(const SimulatorParameters& parameters);

  struct Frame {
    double time = 0;      ///< since the start, s
    cv::Mat left, right;  ///< raw, mono8
    Truth truth;
  };
  int frames() const { return frames_; }
  Frame frame(int index) const;

  /// What falls on the two sensors of one frame: rendering it is the costly part of the frame.
  struct Light {
    int index = 0;
    cv::Mat left, right;  ///< grey levels before the rest of the lens blur, gain and noise; 32-bit float
  };
  Light light(int index) const;
  /// The frame that sensors of this noise (1 sigma, grey levels) make of it.
  Frame expose(const Light& light, double noise) const;

  double timeOf(int index) const { return index / parameters_.path.rate; }
  CameraPose pose(double time) const { return trajectory_.pose(time); }
  const CameraRig& rig() const { return rig_; }
  SimulatedImu imu() const {
    return {parameters_.imu, trajectory_, static_cast<uint64_t>(parameters_.random.seed)};
  }
  double duration() const { return timeOf(frames_ - 1); }

 private:
  ApproachSimulator(const SimulatorParameters& parameters, CameraRig rig);
  Failure checkHeights() const;
  cv::Mat lightIn(const SimulatedCamera& camera, int index) const;
  cv::Mat picture(const cv::Mat& light, const SimulatedCameraParameters& sensor, int index, int camera_number,
                  double noise) const;

  SimulatorParameters parameters_;
  CameraRig rig_;
  Trajectory trajectory_;
  GroundProfile profile_;
  Renderer renderer_;
  int frames_;
};

}  // namespace uav_landing
