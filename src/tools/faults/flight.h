#pragma once

#include <memory>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "faults/output_score.h"
#include "simulation/random_approach.h"
#include "uav_landing/geometry/calibration.h"
#include "uav_landing/parameters/parameters.h"
#include "uav_landing/results/truth.h"
#include "uav_landing/simulator/approach_simulator.h"
#include "uav_landing/simulator/parameters.h"

namespace uav_landing {

/// A healthy sequence of raw pairs with truth, from the simulator or a dataset.
struct Flight {
  struct Frame {
    double time = 0;  ///< s
    cv::Mat left, right;
    Truth truth;
    CameraPose pose;  ///< of the rectified left camera; only when simulated
  };
  CameraCalibration left, right;
  const CameraRig* rig = nullptr;  ///< null when not simulated; then nothing can be painted on the ground
  std::vector<Frame> frames;
  double settled = 1.0;            ///< s at the start that do not count
  double runway_width = kUnknown;  ///< m; only when simulated
  bool runway_is_level = false;    ///< the whole of it lies at z = 0; only when simulated
};

/// A flight, and the rig that it points to.
struct SimulatedFlight {
  SimulatedFlight(const ApproachSimulator& simulator, const SimulatorParameters& parameters);
  SimulatedFlight(const SimulatedFlight&) = delete;
  SimulatedFlight& operator=(const SimulatedFlight&) = delete;
  CameraRig rig;
  Flight flight;
};

/// Draws a rig and heights for a small image: 320 x 240 with a baseline of 2 m is as good as 640 x 480 with 1
/// m. Over scenery the flight is higher, so that more of it is in view. scenery: around the runway, or null.
SimulatorParameters drawFlight(uint64_t seed, int frames, const Parameters& parameters,
                               const SceneryKind* scenery = nullptr);
/// Draws a flight in images of 640 x 480 that crosses the threshold in its later half. There x and the height
/// above the runway are known, which need to see the threshold well.
SimulatorParameters drawThresholdFlight(uint64_t seed, int frames, const Parameters& parameters);
/// Null when the scene is in the aircraft's way.
std::unique_ptr<SimulatedFlight> simulateFlight(const SimulatorParameters& drawn);
/// The flight of a dataset folder. Throws std::runtime_error with what cannot be read.
Flight readFlight(const std::string& folder);
/// A number of its frames, from `first` on.
Flight cutFlight(const Flight& whole, int first, int frames);
/// The truth at any time between the frames, of which there must be two. Stamps and images may belong to
/// different times.
FaultTruth truthAt(const Flight& flight, double time);

}  // namespace uav_landing
