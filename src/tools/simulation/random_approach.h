#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "uav_landing/parameters/parameters.h"
#include "uav_landing/simulator/parameters.h"

namespace uav_landing {

/// 1 sigma of what the estimator is told to expect of its calibration.
struct CalibrationPrior {
  double baseline = 0;            ///< share of the baseline
  double rx = 0, ry = 0, rz = 0;  ///< rotation of the right camera in rectified axes, rad
  double lens_rows = 0;           ///< by which its rows lie too low, px
  double lens_tilt = 0;           ///< by which they are inclined, and its columns are not, rad
  double imu_attitude = 0;        ///< of an inertial sensor, with the ground's slope, which is flat here, rad
  double imu_rate_bias = 0;       ///< rad/s
  double imu_rate = 0;            ///< of each message, rad/s
};
CalibrationPrior calibrationPrior(const Parameters& parameters, double focal_length);

// A random full-scale flight: runway, marks, light, both sensors, path, attitude and wobble are drawn. The
// seed decides everything.

/// A short piece of a glide that ends near this height, m; as many frames as asked for, at 20 Hz. The
/// calibration's errors are drawn, too, from what the estimator is told of them. imu: an inertial sensor
/// flies along; everything else is the same with it.
SimulatorParameters drawSnippet(uint64_t seed, double height, int frames, const Parameters& parameters,
                                bool imu = false);
/// Lets the slope of a snippet's ground change once, as the estimator is told to expect (slope_change_deg
/// over 100 m, in the shares and as often as surface_profile.h says; mostly it stays flat), somewhere from
/// 100 m before the place where the snippet ends to 300 m beyond it. The height over the ground there stays.
void bendGround(uint64_t seed, const Parameters& parameters, SimulatorParameters& snippet);
/// Puts scenery around the runway of a snippet or an approach: each element with a chance of its own, at a
/// place and of a size that are drawn. Everything else stays as it was.
void drawScenery(uint64_t seed, SimulatorParameters& flight);
/// What there is of a landscape besides grass. kRandom: each element with a chance, as above.
enum class SceneryKind { kRandom, kTown, kFields, kShore, kAirport, kHills };
/// All of them by their names.
const std::map<std::string, SceneryKind>& sceneryKinds();
/// Puts the elements of such a landscape around the runway of a flight, at places and of sizes that are
/// drawn. A hill of kHills is never in the aircraft's way.
void drawScenery(SceneryKind kind, uint64_t seed, SimulatorParameters& flight);
/// Gives both cameras a rolling shutter of 5 to 40 ms, a fifth of them from bottom to top, whose stamp is
/// that of the middle row or of one at an edge. Everything else stays as it was.
void drawRollingShutter(uint64_t seed, SimulatorParameters& flight);
/// Shakes the rig at 15 to 120 Hz, by 0.2 degrees at the most and by less when it is faster. An inertial
/// sensor that flies along becomes fast enough to follow. Everything else stays as it was.
void drawVibration(uint64_t seed, SimulatorParameters& flight);
/// An approach from 60 m down to the end of the flare, with a gust on half of them and an exact calibration.
SimulatorParameters drawApproach(uint64_t seed, const Parameters& parameters = {}, bool imu = false);

}  // namespace uav_landing
