#include "simulation/draw.h"
#include "simulation/random_approach.h"

namespace uav_landing {

void drawRollingShutter(uint64_t seed, SimulatorParameters& flight) {
  Draw draw(hashed(~hashed(seed)));  // separate, so that everything else is the same with it
  SimulatedImageParameters& image = flight.image;
  image.readout_time = draw.scale(0.005, 0.04);
  if (draw.chance(0.2)) image.readout_time *= -1;
  if (draw.chance(0.5)) image.stamp_row = draw.chance(0.5) ? 0 : 1;
}

void drawVibration(uint64_t seed, SimulatorParameters& flight) {
  Draw draw(hashed(hashed(~seed)));
  SimulatedVibrationParameters& vibration = flight.vibration;
  vibration.frequency = draw.scale(15, 120);
  // Displacements shrink with the frequency, as forces of an engine do not grow as fast as inertia resists.
  const double largest = draw.scale(0.01, 0.2) * 15 / vibration.frequency;
  vibration.roll_deg = draw.uniform(0, largest);
  vibration.pitch_deg = draw.uniform(0, largest);
  vibration.yaw_deg = draw.uniform(0, largest);
  if (flight.imu.rate > 0) flight.imu.rate = 8 * vibration.frequency;
}

}  // namespace uav_landing
