#include <algorithm>
#include <cmath>

#include "faults/fault_lists.h"
#include "faults/fault_makers.h"

namespace uav_landing {
namespace {

constexpr double kMinute = 60;  // s

/// Small seeds would begin with the same numbers.
cv::RNG randomOf(const FaultRun& run) { return cv::RNG(run.seed * 0x9E3779B97F4A7C15ULL + 1); }

/// Time since something slow began, s: a run of seconds is a random piece of it. within: how long ago at
/// most.
double sinceBeginning(const FaultRun& run, int frame, double within) {
  return randomOf(run).uniform(0.0, within) + run.flight.frames[static_cast<size_t>(frame)].time;
}

Fault slowly(Fault fault) {
  fault.from_first = true;
  return fault;
}

Fault propeller() {
  return spoils("propeller", Place::kOptics, "blades of a propeller that pass in front of both lenses",
                [](FaultRun& run, int frame, Delivery& pair) {
                  // Anything but a whole part of a turn between two images.
                  const double angle = 2.3 * frame + static_cast<double>(run.seed % 7);
                  const double below = 1.1 * pair.left.rows;
                  spinPropeller(pair.left, {0.7 * pair.left.cols, below}, angle);
                  spinPropeller(pair.right, {0.3 * pair.right.cols, below}, angle);
                });
}

}  // namespace

void addLensFaults(std::vector<Fault>& all) {
  all.push_back(spoils("rain", Place::kOptics, "20 drops of water that run down the left lens",
                       [](FaultRun& run, int frame, Delivery& pair) {
                         const double speed = 0.25 * pair.left.rows;  // px/s
                         wet(pair.left, run.seed, speed * sinceOnset(run, frame));
                       }));
  all.push_back(spoils("insects", Place::kOptics, "insects hit the right lens, two a second",
                       [](FaultRun& run, int frame, Delivery& pair) {
                         hitByInsects(pair.right, run.seed, 1 + static_cast<int>(2 * sinceOnset(run, frame)));
                       }));
  all.push_back(slowly(both("condensation", Place::kOptics, "water condenses on both lenses for a minute",
                            [](FaultRun& run, int frame, cv::Mat& image) {
                              condense(image, std::min(1.0, sinceBeginning(run, frame, kMinute) / kMinute));
                            })));
  all.push_back(propeller());
  all.push_back(spoils("wiper", Place::kOptics, "a wiper crosses the left lens and comes back within 1.2 s",
                       [](FaultRun& run, int frame, Delivery& pair) {
                         wipe(pair.left, std::sin(2 * M_PI * sinceOnset(run, frame) / 1.2));
                       }));
  all.push_back(spoils("lens_hit", Place::kOptics, "the left lens moves by 2 px in its mount",
                       [](FaultRun& run, int, Delivery& pair) {
                         const double towards = randomOf(run).uniform(0.0, 2 * M_PI);
                         displace(pair.left, 2 * Eigen::Vector2d(std::cos(towards), std::sin(towards)));
                       }));
  all.push_back(spoils("autofocus", Place::kOptics, "each focal length breathes by 0.5 % in 2 s",
                       [](FaultRun& run, int frame, Delivery& pair) {
                         const double phase = M_PI * sinceOnset(run, frame);
                         zoomCamera(pair.left, run.flight.left, 1 + 0.005 * std::sin(phase));
                         zoomCamera(pair.right, run.flight.right, 1 + 0.005 * std::sin(phase + 1));
                       }));
  all.push_back(
      slowly(spoils("bent_warm", Place::kOptics, "the rig bends by 0.05 deg a minute, for up to two minutes",
                    [](FaultRun& run, int frame, Delivery& pair) {
                      const double degrees = 0.05 * sinceBeginning(run, frame, 2 * kMinute) / kMinute;
                      const Eigen::Vector3d axis = Eigen::Vector3d::Unit(static_cast<int>(run.seed % 3));
                      turnCamera(pair.right, run.flight.right, degrees * M_PI / 180 * axis);
                    })));
}

}  // namespace uav_landing
