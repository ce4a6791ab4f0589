#pragma once

#include <functional>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "faults/flight.h"

namespace uav_landing {

/// A pair as it reaches the chain. A fault may change the images. time: s, of both stamps.
struct Delivery {
  double time = 0;
  cv::Mat left, right;
  bool delivered = true;
};

/// Knowledge of a fault about the run.
struct FaultRun {
  const Flight& flight;
  int onset = 0;      ///< first frame with the fault
  cv::RNG random;     ///< of what differs between images
  uint64_t seed = 1;  ///< of what stays the same in a run
};

/// One fault. The two faults of a pair are applied in the order of their places between the scene and the
/// chain.
struct Fault {
  enum class Place { kTiming, kScene, kOptics, kSensor };
  std::string name, meaning;
  Place place = Place::kSensor;
  /// Changes a frame from the onset on; empty when the images do not change.
  std::function<void(FaultRun&, int, Delivery&)> spoil;
  /// Wrong calibration, for the whole run; empty: none.
  std::function<void(CameraCalibration&, CameraCalibration&)> calibrate;
  /// Other scene, for the whole run; empty: none. Only when simulated.
  std::function<void(SimulatorParameters&)> build;
  /// A scene that changes at the onset, s since the first pair; empty: none. Only when simulated.
  std::function<void(SimulatorParameters&, double onset)> disturb;
  bool needs_scene = false;  ///< only when simulated
  bool from_first = false;   ///< from the first pair on, so nothing was healthy before
  /// Other parameters of the chain, for the whole run; empty: none.
  std::function<void(Parameters&, const Flight&)> tell = {};

  /// Whether the fault is there from the first pair on.
  bool wholeRun() const { return calibrate || build || from_first; }
};

/// All faults; the first, "none", does nothing. NAME_first is NAME from the first pair on.
const std::vector<Fault>& allFaults();

}  // namespace uav_landing
