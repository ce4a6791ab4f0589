#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "uav_landing/parameters/parameters.h"
#include "uav_landing/simulator/parameters.h"

namespace uav_landing {

/// 1 sigma of the calibration's errors that the estimator expects.
struct CalibrationPrior {
  double baseline = 0;            ///< share of the baseline
  double rx = 0, ry = 0, rz = 0;  ///< rotation of the right camera in rectified axes, rad
  double lens_rows = 0;           ///< by which the right camera's rows lie too low, px
  double lens_tilt = 0;           ///< by which they are inclined while its columns are not, rad
  double imu_attitude = 0;        ///< of an inertial sensor; contains the ground's slope, which is flat here,
                                  ///< rad
  double imu_rate_bias = 0;       ///< rad/s
  double imu_rate = 0;            ///< of each message, rad/s
};
CalibrationPrior calibrationPrior(const Parameters& parameters, double focal_length);

// Random full-scale flights: runway, marks, light, both sensors, path, attitude and wobble are drawn. The
// seed decides everything.

/// A short piece of a glide at 20 Hz, with this many frames, that ends near this height (m). The
/// calibration's errors are also drawn, from what the estimator expects of them. imu: an inertial sensor
/// flies along. Everything else stays the same with it.
SimulatorParameters drawSnippet(uint64_t seed, double height, int frames, const Parameters& parameters,
                                bool imu = false);
/// Changes the slope of a snippet's ground once, as the estimator expects it: by slope_change_deg over 100 m,
/// with the shares and probabilities of surface_profile.h. Mostly the ground stays flat. The place lies
/// between 100 m before the end of the snippet and 300 m beyond it. The height over the ground there stays.
void bendGround(uint64_t seed, const Parameters& parameters, SimulatorParameters& snippet);
/// Puts scenery around the runway of a snippet or an approach. Each element has its own chance, and its place
/// and size are drawn. Everything else stays as it was.
void drawScenery(uint64_t seed, SimulatorParameters& flight);
/// Kinds of landscape besides grass. kRandom: each element with a chance, as above.
enum class SceneryKind { kRandom, kTown, kFields, kShore, kAirport, kHills };
/// All kinds by their names.
const std::map<std::string, SceneryKind>& sceneryKinds();
/// Puts the elements of such a landscape around the runway of a flight, with random places and sizes. A hill
/// of kHills is never in the aircraft's way.
void drawScenery(SceneryKind kind, uint64_t seed, SimulatorParameters& flight);
/// Gives both cameras a rolling shutter of 5 to 40 ms. A fifth of them read from bottom to top. The stamp is
/// that of the middle row or of one at an edge. Everything else stays as it was.
void drawRollingShutter(uint64_t seed, SimulatorParameters& flight);
/// Shakes the rig at 15 to 120 Hz, by at most 0.2 degrees, and less at higher frequencies. An inertial sensor
/// that flies along becomes fast enough to follow. Everything else stays as it was.
void drawVibration(uint64_t seed, SimulatorParameters& flight);
/// An approach from 60 m down to the end of the flare, with an exact calibration. Half of them have a gust.
SimulatorParameters drawApproach(uint64_t seed, const Parameters& parameters = {}, bool imu = false);
/// An approach from 3 to 5 km before the threshold down to 20 m, at 10 Hz. Runways are from 600 x 18 m to
/// 4000 x 60 m, and a quarter has a hill before the threshold. The calibration is exact.
SimulatorParameters drawFarApproach(uint64_t seed);

}  // namespace uav_landing
