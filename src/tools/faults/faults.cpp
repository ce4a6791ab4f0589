#include "faults/faults.h"

#include <algorithm>
#include <cmath>

#include "faults/fault_effects.h"

namespace uav_landing {
namespace {

using Place = Fault::Place;
using Spoil = std::function<void(FaultRun&, int, Delivery&)>;
constexpr double kDegree = M_PI / 180;

Fault spoils(const char* name, Place place, const char* meaning, Spoil spoil) {
  return {name, meaning, place, std::move(spoil), {}, {}, {}, false, false};
}

/// A fault of both cameras' images, or of the left one only.
Fault both(const char* name, Place place, const char* meaning,
           std::function<void(FaultRun&, int, cv::Mat&)> effect) {
  return spoils(name, place, meaning, [effect](FaultRun& run, int frame, Delivery& pair) {
    effect(run, frame, pair.left);
    effect(run, frame, pair.right);
  });
}

Fault onGround(const char* name, const char* meaning, std::function<GroundPaint(FaultRun&, int)> paint) {
  Fault fault = spoils(name, Place::kScene, meaning, [paint](FaultRun& run, int frame, Delivery& pair) {
    const GroundPaint painted = paint(run, frame);
    const CameraPose& pose = run.flight.frames[frame].pose;
    paintGround(pair.left, run.flight.rig->left, pose, painted);
    paintGround(pair.right, run.flight.rig->right, pose, painted);
    addNoise(pair.left, 1, run.random);
    addNoise(pair.right, 1, run.random);
  });
  fault.needs_scene = true;
  return fault;
}

Fault bent(const char* axis, int index, double degrees) {
  std::string size = std::to_string(degrees);
  size.erase(size.find_last_not_of('0') + 1);
  if (size.back() == '.') size.pop_back();
  const std::string name = std::string("bent_") + axis + "_" + size;
  const std::string meaning = std::string("right camera turns in ") + axis + " by " + size + " deg";
  return spoils(name.c_str(), Place::kOptics, meaning.c_str(), [=](FaultRun& run, int, Delivery& pair) {
    turnCamera(pair.right, run.flight.right, degrees * kDegree * Eigen::Vector3d::Unit(index));
  });
}

Fault calibrated(const char* name, const char* meaning,
                 std::function<void(CameraCalibration&, CameraCalibration&)> calibrate) {
  Fault fault{name, meaning, Place::kSensor, {}, std::move(calibrate), {}, {}, false, false};
  return fault;
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

double sinceOnset(const FaultRun& run, int frame) {
  return run.flight.frames[frame].time - run.flight.frames[run.onset].time;
}

void addTiming(std::vector<Fault>& all) {
  const auto frameOf = [](FaultRun& run, int frame) -> const Flight::Frame& {
    return run.flight.frames[static_cast<size_t>(std::max(0, frame))];
  };
  all.push_back(spoils(
      "frozen_left", Place::kTiming, "left camera repeats its last image",
      [=](FaultRun& run, int, Delivery& pair) { pair.left = frameOf(run, run.onset - 1).left.clone(); }));
  all.push_back(spoils(
      "frozen_right", Place::kTiming, "right camera repeats its last image",
      [=](FaultRun& run, int, Delivery& pair) { pair.right = frameOf(run, run.onset - 1).right.clone(); }));
  all.push_back(spoils("frozen_both", Place::kTiming, "both cameras repeat their last images",
                       [=](FaultRun& run, int, Delivery& pair) {
                         pair.left = frameOf(run, run.onset - 1).left.clone();
                         pair.right = frameOf(run, run.onset - 1).right.clone();
                       }));
  all.push_back(spoils("frozen_noisy", Place::kTiming, "left camera's scene stands still, its noise does not",
                       [=](FaultRun& run, int, Delivery& pair) {
                         pair.left = frameOf(run, run.onset - 1).left.clone();
                         addNoise(pair.left, 2, run.random);
                       }));
  all.push_back(spoils("swapped", Place::kTiming, "left and right exchanged",
                       [](FaultRun&, int, Delivery& pair) { std::swap(pair.left, pair.right); }));
  all.push_back(spoils("copied_right", Place::kTiming, "right image is the left one",
                       [](FaultRun&, int, Delivery& pair) { pair.right = pair.left.clone(); }));
  all.push_back(
      spoils("dropped", Place::kTiming, "every second pair missing at random",
             [](FaultRun& run, int, Delivery& pair) { pair.delivered = run.random.uniform(0, 2) == 0; }));
  all.push_back(spoils(
      "gap", Place::kTiming, "no pair for 0.6 s",
      [](FaultRun& run, int frame, Delivery& pair) { pair.delivered = sinceOnset(run, frame) > 0.6; }));
  all.push_back(
      spoils("late", Place::kTiming, "stamps late by up to 40 ms at random",
             [](FaultRun& run, int, Delivery& pair) { pair.time += run.random.uniform(0.0, 0.04); }));
  all.push_back(spoils("repeated", Place::kTiming, "every second pair is the one before once more",
                       [=](FaultRun& run, int frame, Delivery& pair) {
                         if ((frame - run.onset) % 2 != 0) return;
                         pair.left = frameOf(run, frame - 1).left.clone();
                         pair.right = frameOf(run, frame - 1).right.clone();
                       }));
  all.push_back(spoils("out_of_order", Place::kTiming, "every fourth pair comes after the one behind it",
                       [=](FaultRun& run, int frame, Delivery& pair) {
                         const int phase = (frame - run.onset) % 4;
                         const int other = phase == 0 ? frame + 1 : phase == 1 ? frame - 1 : frame;
                         if (other == frame || other >= static_cast<int>(run.flight.frames.size())) return;
                         const Flight::Frame& instead = frameOf(run, other);
                         pair.time = instead.time;
                         pair.left = instead.left.clone();
                         pair.right = instead.right.clone();
                       }));
  all.push_back(spoils(
      "unsynchronised", Place::kTiming, "right image is the one of the pair before",
      [=](FaultRun& run, int frame, Delivery& pair) { pair.right = frameOf(run, frame - 1).right.clone(); }));
}

void addLight(std::vector<Fault>& all) {
  all.push_back(both("exposure_jump", Place::kSensor, "gain jumps between 0.5 and 1.6 every 0.3 s",
                     [](FaultRun& run, int frame, cv::Mat& image) {
                       const bool dark = static_cast<int>(sinceOnset(run, frame) / 0.3) % 2 == 0;
                       changeExposure(image, dark ? 0.5 : 1.6, 0);
                     }));
  all.push_back(both("overexposed", Place::kSensor, "gain 3, saturated",
                     [](FaultRun&, int, cv::Mat& image) { changeExposure(image, 3, 0); }));
  all.push_back(both("underexposed", Place::kSensor, "gain 0.1",
                     [](FaultRun&, int, cv::Mat& image) { changeExposure(image, 0.1, 0); }));
  all.push_back(spoils("gain_drift", Place::kSensor, "right camera's gain falls to 0.3 within 2 s",
                       [](FaultRun& run, int frame, Delivery& pair) {
                         changeExposure(pair.right, std::max(0.3, 1 - 0.35 * sinceOnset(run, frame)), 0);
                       }));
  all.push_back(both("noise", Place::kSensor, "noise of 15 grey levels",
                     [](FaultRun& run, int, cv::Mat& image) { addNoise(image, 15, run.random); }));
  all.push_back(spoils("bands", Place::kSensor, "brightness bands that roll through both images",
                       [](FaultRun& run, int frame, Delivery& pair) {
                         band(pair.left, 9 * sinceOnset(run, frame));
                         band(pair.right, 9 * sinceOnset(run, frame) + 0.5);
                       }));
  all.push_back(both("defocus", Place::kOptics, "both lenses out of focus, 1 sigma of 3 px",
                     [](FaultRun&, int, cv::Mat& image) { blur(image, 3); }));
  all.push_back(spoils("defocus_right", Place::kOptics, "right lens out of focus, 1 sigma of 2 px",
                       [](FaultRun&, int, Delivery& pair) { blur(pair.right, 2); }));
  all.push_back(spoils("black_right", Place::kSensor, "right image is black",
                       [](FaultRun&, int, Delivery& pair) { pair.right.setTo(0); }));
  all.push_back(spoils("fogged_right", Place::kOptics, "right lens is fogged: a veil, 1 sigma of 8 px",
                       [](FaultRun& run, int, Delivery& pair) { fogLens(pair.right, run.random); }));
  all.push_back(both("motion_blur", Place::kOptics, "9 px along the rows",
                     [](FaultRun&, int, cv::Mat& image) { smear(image, 9); }));
  all.push_back(spoils("dirt", Place::kOptics, "25 dark spots on the left lens",
                       [](FaultRun& run, int, Delivery& pair) { soil(pair.left, 7 + run.onset); }));
  all.push_back(spoils("droplets", Place::kOptics, "20 drops of water on the left lens",
                       [](FaultRun& run, int, Delivery& pair) { wet(pair.left, 7 + run.onset); }));
  all.push_back(both("glare", Place::kOptics, "the sun near the horizon, with veiling glare",
                     [](FaultRun&, int, cv::Mat& image) { glare(image); }));
  all.push_back(both("night", Place::kOptics, "light of 4 %, noise of 2 grey levels",
                     [](FaultRun& run, int frame, cv::Mat& image) { night(image, 31 * run.onset + frame); }));
}

void addGround(std::vector<Fault>& all) {
  all.push_back(onGround("fog", "visibility of 60 m", [](FaultRun& run, int frame) {
    const Eigen::Vector3d at = run.flight.frames[frame].pose.position;
    return [at](double x, double, double grey) {
      const double seen = std::exp(-std::hypot(x - at.x(), at.z()) / 60);
      return seen * grey + (1 - seen) * 170;
    };
  }));
  all.push_back(onGround("snow", "markings and texture under snow", [](FaultRun&, int) {
    return [](double, double, double grey) { return 200 + 0.06 * (grey - 100); };
  }));
  all.push_back(onGround("featureless", "no texture on the runway or beside it",
                         [](FaultRun&, int) { return [](double, double, double) { return 90.0; }; }));
  all.push_back(
      onGround("repeated_pattern", "the ground is stripes along and across, 2 m apart", [](FaultRun&, int) {
        return [](double x, double y, double) {
          return 100 + 40 * std::sin(M_PI * y) + 25 * std::sin(M_PI * x);
        };
      }));
  all.push_back(
      onGround("taxiway", "bright lines of another strip that runs off at 2 degrees", [](FaultRun&, int) {
        return [](double x, double y, double grey) {
          const double across = y + 25 - 0.035 * x;
          return std::abs(std::abs(across) - 8) < 0.6 ? 215.0 : grey;
        };
      }));
  all.push_back(onGround(
      "shadows", "shadows of clouds that drift over the ground at 8 m/s", [](FaultRun& run, int frame) {
        const double time = sinceOnset(run, frame);
        return [time](double x, double y, double grey) {
          const double pattern = std::sin(0.13 * (x - 8 * time)) + std::sin(0.21 * (y + 5 * time) + 0.05 * x);
          return pattern > 0.6 ? 0.45 * grey : grey;
        };
      }));
  Fault water = spoils("water", Place::kScene, "the ground farther than 15 m ahead mirrors the sky",
                       [](FaultRun& run, int frame, Delivery& pair) {
                         const CameraPose& pose = run.flight.frames[frame].pose;
                         const double from = pose.position.x() + 15 + 3 * pose.position.z();
                         mirrorSky(pair.left, run.flight.rig->left, pose, from, 1e5);
                         mirrorSky(pair.right, run.flight.rig->right, pose, from, 1e5);
                         addNoise(pair.left, 1, run.random);
                         addNoise(pair.right, 1, run.random);
                       });
  water.needs_scene = true;
  all.push_back(water);
  all.push_back(built("slope", "ground that rises by 1.5 deg up to 60 m before the place below",
                      [](SimulatorParameters& p) {
                        p.profile.slope_before_deg = 1.5;
                        p.profile.change_start = p.path.start_x + 40;
                        p.profile.change_length = 20;
                        // The path keeps its height over the ground at the change.
                      }));
  all.push_back(
      built("vehicles", "30 boxes of up to 6 m on and beside the runway", [](SimulatorParameters& p) {
        p.objects.boxes = 30;
        p.objects.box_size = 6;
        p.objects.clearance = 0;
        p.objects.band = 25;
        p.objects.first = p.path.start_x;
        p.objects.last = p.path.start_x + 150;
      }));
}

/// A motor that begins to shake the rig.
void shake(SimulatorParameters& p, double onset) {
  p.vibration.frequency = 47;
  p.vibration.pitch_deg = 0.1;
  p.vibration.roll_deg = 0.05;
  p.vibration.yaw_deg = 0.03;
  p.vibration.start = onset;
}

void addRows(std::vector<Fault>& all) {
  all.push_back(built("readout_untold", "a rolling shutter of 10 ms that nobody told the chain of",
                      [](SimulatorParameters& p) { p.image.readout_time = 0.01; }));
  Fault told = built("readout_told", "a rolling shutter of 30 ms, and the chain is told 20 ms",
                     [](SimulatorParameters& p) { p.image.readout_time = 0.03; });
  told.tell = [](Parameters& p) { p.rig.readout_time = 0.02; };
  all.push_back(told);
  all.push_back(disturbed("vibration", "pitch shakes by 0.1 deg at 47 Hz, roll and yaw by less", shake));
  Fault rows =
      disturbed("vibration_rows", "the same with a rolling shutter of 10 ms, which the chain is told",
                [](SimulatorParameters& p, double onset) {
                  shake(p, onset);
                  p.image.readout_time = 0.01;
                });
  rows.tell = [](Parameters& p) { p.rig.readout_time = 0.01; };
  all.push_back(rows);
}

void addRig(std::vector<Fault>& all) {
  const char* const axes[] = {"pitch", "yaw", "roll"};
  for (int axis = 0; axis < 3; ++axis)
    for (const double degrees : {0.05, 0.2, 1.0}) all.push_back(bent(axes[axis], axis, degrees));
  all.push_back(
      spoils("focal_right", Place::kOptics, "right camera's focal length grows by 1 %",
             [](FaultRun& run, int, Delivery& pair) { zoomCamera(pair.right, run.flight.right, 1.01); }));
  all.push_back(spoils("focal_both", Place::kOptics, "both focal lengths grow by 1 %",
                       [](FaultRun& run, int, Delivery& pair) {
                         zoomCamera(pair.left, run.flight.left, 1.01);
                         zoomCamera(pair.right, run.flight.right, 1.01);
                       }));
  all.push_back(calibrated("baseline_2", "baseline 2 % shorter than calibrated",
                           [](CameraCalibration&, CameraCalibration& right) { right.P(0, 3) *= 1.02; }));
  all.push_back(calibrated("baseline_8", "baseline 8 % shorter than calibrated",
                           [](CameraCalibration&, CameraCalibration& right) { right.P(0, 3) *= 1.08; }));
  all.push_back(calibrated("camera_info",
                           "camera_info of the left camera used for both, principal point 8 px off",
                           [](CameraCalibration& left, CameraCalibration& right) {
                             const double tx = right.P(0, 3);
                             right = left;
                             right.P(0, 3) = tx;
                             left.K(0, 2) += 8;
                             left.P(0, 2) += 8;
                           }));
}

/// Adds variants of some faults that are there from the first pair on.
void addFromFirst(std::vector<Fault>& all) {
  for (const char* name : {"swapped", "unsynchronised", "bent_pitch_0.2", "bent_yaw_0.2", "bent_roll_0.2",
                           "bent_yaw_1", "focal_right"}) {
    Fault fault = *std::find_if(all.begin(), all.end(), [&](const Fault& f) { return f.name == name; });
    fault.name += "_first";
    fault.meaning += ", from the first pair on";
    fault.from_first = true;
    all.push_back(std::move(fault));
  }
}

}  // namespace

const std::vector<Fault>& allFaults() {
  static const std::vector<Fault> faults = [] {
    std::vector<Fault> all;
    all.push_back(spoils("none", Place::kTiming, "healthy", [](FaultRun&, int, Delivery&) {}));
    addTiming(all);
    addLight(all);
    addGround(all);
    addRows(all);
    addRig(all);
    addFromFirst(all);
    return all;
  }();
  return faults;
}

}  // namespace uav_landing
