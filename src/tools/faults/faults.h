#pragma once

#include <functional>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "faults/flight.h"

namespace uav_landing {

/// A pair as it reaches the chain. images are the fault's own to change; time: s, of both stamps.
struct Delivery {
  double time = 0;
  cv::Mat left, right;
  bool delivered = true;
};

/// What a fault knows of the run that it spoils.
struct FaultRun {
  const Flight& flight;
  int onset = 0;  ///< first frame with the fault that spoils it
  cv::RNG random;
};

/// One fault. Faults of a pair of faults are applied in the order of their places on the way from the scene
/// to the chain.
struct Fault {
  enum class Place { kTiming, kScene, kOptics, kSensor };
  std::string name, meaning;
  Place place = Place::kSensor;
  /// Of a frame from the onset on; empty when there is nothing to do to the images.
  std::function<void(FaultRun&, int, Delivery&)> spoil;
  /// Wrong calibration, for the whole run; empty otherwise.
  std::function<void(CameraCalibration&, CameraCalibration&)> calibrate;
  /// Another scene, for the whole run; empty otherwise. Only when simulated.
  std::function<void(SimulatorParameters&)> build;
  /// A scene that becomes another one at the onset, s since the first pair; empty otherwise. Only when
  /// simulated.
  std::function<void(SimulatorParameters&, double onset)> disturb;
  bool needs_scene = false;  ///< only when simulated
  bool from_first = false;   ///< from the first pair on: nothing was healthy before
  /// Other parameters of the chain, for the whole run; empty: none.
  std::function<void(Parameters&)> tell = {};

  /// There from the first pair on.
  bool wholeRun() const { return calibrate || build || from_first; }
};

/// All of them; the first, "none", does nothing. NAME_first is NAME from the first pair on.
const std::vector<Fault>& allFaults();

}  // namespace uav_landing
