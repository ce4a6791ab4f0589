#pragma once

#include <cmath>

namespace uav_landing {

/// What an aircraft that lands can do. Estimators use these values for what they cannot measure.
namespace aircraft {

constexpr double kDegree = M_PI / 180;

/// 1 sigma of an unknown turn, rad/s. A standard turn is 3 degrees per second (ICAO Doc 8168); corrections on
/// final approach in gusts are faster.
constexpr double kTurnRate = 5 * kDegree;
/// A faster turn may as well be a wrong measurement, rad/s: five sigma of kTurnRate.
constexpr double kUnusualTurnRate = 5 * kTurnRate;
/// 1 sigma of the change of an angular acceleration when nothing has told it yet, rad/s^3. It is that of a
/// small aircraft in gusts, which rolls by 2 degrees to and fro once a second.
constexpr double kTurnJerk = 500 * kDegree;
/// Largest turn between two images of a pair that are not taken at the same time, rad/s: a bound, not a
/// sigma.
constexpr double kTurnRateWithinPair = 0.3;
/// No aircraft turns faster, rad/s: one roll a second, by an aerobatic aircraft.
constexpr double kFastestTurnRate = 6;

/// 1 sigma of the random acceleration, m/s^2: half a g, as in gusts and when the wheels touch down.
constexpr double kAcceleration = 5.0;
/// The same for an acceleration that lasts. The limit of a test, about 5 sigma, is then 1 g, which no
/// aircraft exceeds for that time.
constexpr double kLastingAcceleration = 1.8;

/// 1 sigma of the speed of a small aircraft along its axis and across it, m/s.
constexpr double kSpeed = 20, kSideways = 2;

}  // namespace aircraft
}  // namespace uav_landing
