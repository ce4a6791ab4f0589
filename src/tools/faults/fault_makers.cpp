#include "faults/fault_makers.h"

namespace uav_landing {

const CameraPose& poseOf(const FaultRun& run, int frame) {
  return run.flight.frames[static_cast<size_t>(frame)].pose;
}

double sinceOnset(const FaultRun& run, int frame) {
  return run.flight.frames[frame].time - run.flight.frames[run.onset].time;
}

Fault spoils(const std::string& name, Place place, const std::string& meaning, Spoil spoil) {
  return {name, meaning, place, std::move(spoil), {}, {}, {}, false, false};
}

Fault both(const char* name, Place place, const char* meaning, Effect effect) {
  return spoils(name, place, meaning, [effect](FaultRun& run, int frame, Delivery& pair) {
    effect(run, frame, pair.left);
    effect(run, frame, pair.right);
  });
}

Fault changesGround(const char* name, const char* meaning, GroundChange change) {
  Fault fault = spoils(name, Place::kScene, meaning, [change](FaultRun& run, int frame, Delivery& pair) {
    change(run, frame, pair.left, run.flight.rig->left);
    change(run, frame, pair.right, run.flight.rig->right);
    addNoise(pair.left, 1, run.random);
    addNoise(pair.right, 1, run.random);
  });
  fault.needs_scene = true;
  return fault;
}

Fault onGround(const char* name, const char* meaning, std::function<GroundPaint(FaultRun&, int)> paint) {
  return changesGround(name, meaning, [paint](FaultRun& run, int frame, cv::Mat& image, const auto& camera) {
    paintGround(image, camera, poseOf(run, frame), paint(run, frame));
  });
}

Fault built(const char* name, const char* meaning, std::function<void(SimulatorParameters&)> build) {
  Fault fault{name, meaning, Place::kScene, {}, {}, std::move(build), {}, true, false};
  return fault;
}

Fault disturbed(const char* name, const char* meaning,
                std::function<void(SimulatorParameters&, double)> disturb) {
  Fault fault{name, meaning, Place::kScene, {}, {}, {}, std::move(disturb), true, false};
  return fault;
}

}  // namespace uav_landing
