#pragma once

#include "simulation/draw.h"
#include "uav_landing/simulator/parameters.h"

namespace uav_landing {

constexpr double kFlightRate = 20;  ///< Hz

// What random flights have in common. Everything is drawn in the same order, so that a seed stays the same.

/// Light, both sensors, runway, attitude, wobble, speed and glide. Not where the path starts, nor how long it
/// is.
SimulatorParameters drawFlight(Draw& draw);
/// The markings of a runway of a given size.
void drawMarks(Draw& draw, SimulatedRunwayParameters& runway);
/// Puts the aircraft at this height on its glide to a point beyond the threshold. touchdown: distance of that
/// point from the threshold. y: from the centre line. All in m.
void place(double height, double touchdown, double y, SimulatedPathParameters& path);

}  // namespace uav_landing
