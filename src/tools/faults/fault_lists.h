#pragma once

#include <vector>

#include "faults/faults.h"

// The lists that allFaults() is made of.
namespace uav_landing {

/// Of stamps, of the order of images, and of what repeats.
void addTimingFaults(std::vector<Fault>& all);
/// Of light, noise and focus.
void addLightFaults(std::vector<Fault>& all);
/// Of sensors, and of the way of their images.
void addSensorFaults(std::vector<Fault>& all);
/// Of what is on the lenses or before them, and of lenses that move.
void addLensFaults(std::vector<Fault>& all);
/// Of the ground and what stands on it.
void addGroundFaults(std::vector<Fault>& all);
/// Of a rolling shutter, and of a rig that shakes.
void addRowFaults(std::vector<Fault>& all);
/// Of the rig and of its calibration.
void addRigFaults(std::vector<Fault>& all);

}  // namespace uav_landing
