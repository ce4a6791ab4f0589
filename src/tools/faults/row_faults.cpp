#include "faults/fault_lists.h"
#include "faults/fault_makers.h"

namespace uav_landing {
namespace {

/// A motor that begins to shake the rig.
void shake(SimulatorParameters& p, double onset) {
  p.vibration.frequency = 47;
  p.vibration.pitch_deg = 0.1;
  p.vibration.roll_deg = 0.05;
  p.vibration.yaw_deg = 0.03;
  p.vibration.start = onset;
}

}  // namespace

void addRowFaults(std::vector<Fault>& all) {
  all.push_back(built("readout_untold", "a rolling shutter of 10 ms that nobody told the chain of",
                      [](SimulatorParameters& p) { p.image.readout_time = 0.01; }));
  Fault told = built("readout_told", "a rolling shutter of 30 ms, and the chain is told 20 ms",
                     [](SimulatorParameters& p) { p.image.readout_time = 0.03; });
  told.tell = [](Parameters& p, const Flight&) { p.rig.readout_time = 0.02; };
  all.push_back(told);
  all.push_back(disturbed("vibration", "pitch shakes by 0.1 deg at 47 Hz, roll and yaw by less", shake));
  Fault rows =
      disturbed("vibration_rows", "the same with a rolling shutter of 10 ms, which the chain is told",
                [](SimulatorParameters& p, double onset) {
                  shake(p, onset);
                  p.image.readout_time = 0.01;
                });
  rows.tell = [](Parameters& p, const Flight&) { p.rig.readout_time = 0.01; };
  all.push_back(rows);
}

}  // namespace uav_landing
