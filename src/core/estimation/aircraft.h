#pragma once

#include <cmath>

namespace uav_landing {

/// What an aircraft that lands can do. Estimators take what they cannot measure for as large as this.
namespace aircraft {

constexpr double kDegree = M_PI / 180;

/// 1 sigma of the turn where nothing tells it, rad/s: a standard turn is 3 degrees per second (ICAO Doc
/// 8168), corrections on final approach in gusts are faster.
constexpr double kTurnRate = 5 * kDegree;
/// From here on a turn may as well be a wrong one, rad/s: five sigma of that.
constexpr double kUnusualTurnRate = 5 * kTurnRate;
/// The largest turn between two images that are not taken at the same time, rad/s: a bound, not a sigma.
constexpr double kTurnRateWithinPair = 0.3;
/// Faster turns none, rad/s: one roll a second, of an aerobatic aircraft.
constexpr double kFastestTurnRate = 6;

/// 1 sigma of the random acceleration, m/s^2: half a g, as in gusts and when the wheels touch down.
constexpr double kAcceleration = 5.0;
/// The same of one that lasts: a test's limit of some 5 sigma is 1 g then, more than an aircraft gains or
/// loses in that time.
constexpr double kLastingAcceleration = 1.8;

/// Of a small aircraft along its axis and across it, m/s.
constexpr double kSpeed = 20, kSideways = 2;

}  // namespace aircraft
}  // namespace uav_landing
