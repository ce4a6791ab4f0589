#pragma once

#include "faults/faults.h"
#include "faults/lens_effects.h"
#include "faults/sensor_effects.h"
#include "faults/view_effects.h"

// What the lists of faults are written with (timing_faults.cpp and its neighbours).
namespace uav_landing {

using Place = Fault::Place;
using Spoil = std::function<void(FaultRun&, int frame, Delivery&)>;
/// Changes one image of a pair.
using Effect = std::function<void(FaultRun&, int frame, cv::Mat&)>;

/// Of the left camera, in a simulated flight.
const CameraPose& poseOf(const FaultRun& run, int frame);
/// s since the fault began.
double sinceOnset(const FaultRun& run, int frame);

/// A fault of the pair.
Fault spoils(const std::string& name, Place place, const std::string& meaning, Spoil spoil);
/// The same fault of both cameras' images.
Fault both(const char* name, Place place, const char* meaning, Effect effect);
/// Both images, with noise of their own, of ground that was changed in them. change: see paintGround().
using GroundChange = std::function<void(FaultRun&, int frame, cv::Mat&, const SimulatedCamera&)>;
Fault changesGround(const char* name, const char* meaning, GroundChange change);
/// Another surface of the ground. paint: makes it for a frame.
Fault onGround(const char* name, const char* meaning, std::function<GroundPaint(FaultRun&, int frame)> paint);
/// Another scene, for the whole run.
Fault built(const char* name, const char* meaning, std::function<void(SimulatorParameters&)> build);
/// A scene that changes at the onset.
Fault disturbed(const char* name, const char* meaning,
                std::function<void(SimulatorParameters&, double onset)> disturb);

}  // namespace uav_landing
