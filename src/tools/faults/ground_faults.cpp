#include <cmath>

#include "faults/fault_lists.h"
#include "faults/fault_makers.h"

namespace uav_landing {
namespace {

double halfWidth(const FaultRun& run) { return 0.5 * run.flight.runway_width; }

void reflectInRunway(FaultRun& run, int frame, cv::Mat& image, const SimulatedCamera& camera) {
  const double half = halfWidth(run);
  mirrorSky(image, camera, poseOf(run, frame),
            [half](double x, double y) { return x > 0 && std::abs(y) < half ? 0.5 : 0.0; });
}

/// Lamps at both edges, 30 m apart. An image has those whose light falls into the time of its exposure.
void lightLamps(FaultRun& run, int frame, cv::Mat& image, const SimulatedCamera& camera) {
  constexpr double kApart = 30, kRadius = 0.4, kLight = 120;  // m, m, grey levels
  const double offset = halfWidth(run) + 1.5;
  const CameraPose& pose = poseOf(run, frame);
  const double pixel = 1 / camera.calibration.K(0, 0);
  const bool right = &camera == &run.flight.rig->right;
  cv::RNG shutter(run.seed + 2 * static_cast<uint64_t>(frame) + (right ? 1 : 0));
  const int phase = shutter.uniform(0, 3);
  paintGround(image, camera, pose, [=](double x, double y, double grey) {
    const double lamp = std::round(x / kApart);
    if (x < 0 || (static_cast<int>(lamp) + (y > 0 ? 1 : 0)) % 3 == phase) return grey;
    const double distance = std::hypot(x - pose.position.x(), pose.position.z());
    // As large as a pixel at least, and then with less light.
    const double across = std::hypot(kRadius, distance * pixel);
    const double along = std::hypot(kRadius, distance * distance * pixel / pose.position.z());
    const double u = (x - kApart * lamp) / along, v = (std::abs(y) - offset) / across;
    return grey + kLight * kRadius / across * std::exp(-0.5 * (u * u + v * v));
  });
}

GroundPaint sandOnTheLeft(FaultRun& run, int) {
  const double half = halfWidth(run);
  return [half](double x, double y, double grey) {
    const bool covered = x > 0 && y > 0 && y < half + 1;
    return covered ? 105 + 8 * std::sin(3.1 * x) * std::sin(2.7 * y) : grey;
  };
}

}  // namespace

void addGroundFaults(std::vector<Fault>& all) {
  all.push_back(onGround("fog", "visibility of 60 m", [](FaultRun& run, int frame) {
    const Eigen::Vector3d at = poseOf(run, frame).position;
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
  all.push_back(changesGround("water", "the ground farther than 15 m ahead mirrors the sky",
                              [](FaultRun& run, int frame, cv::Mat& image, const SimulatedCamera& camera) {
                                const CameraPose& pose = poseOf(run, frame);
                                const double from = pose.position.x() + 15 + 3 * pose.position.z();
                                mirrorSky(image, camera, pose, [from](double x, double) {
                                  return x > from && x < 1e5 ? 1.0 : 0.0;
                                });
                              }));
  all.push_back(changesGround("wet_runway", "a wet runway mirrors the sky by half", reflectInRunway));
  all.push_back(
      changesGround("lamps", "lamps along the runway's edges that flicker with the shutter", lightLamps));
  all.push_back(onGround("half_runway", "sand on the left half of the runway", sandOnTheLeft));
  Fault told =
      onGround("half_runway_told", "the same, and the chain is told the runway's width", sandOnTheLeft);
  told.tell = [](Parameters& p, const Flight& flight) { p.runway.width = flight.runway_width; };
  all.push_back(told);
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

}  // namespace uav_landing
