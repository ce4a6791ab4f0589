#include <cmath>

#include "faults/fault_lists.h"
#include "faults/fault_makers.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;

Fault bent(const char* axis, int index, double degrees) {
  std::string size = std::to_string(degrees);
  size.erase(size.find_last_not_of('0') + 1);
  if (size.back() == '.') size.pop_back();
  const std::string name = std::string("bent_") + axis + "_" + size;
  const std::string meaning = std::string("right camera turns in ") + axis + " by " + size + " deg";
  return spoils(name, Place::kOptics, meaning, [=](FaultRun& run, int, Delivery& pair) {
    turnCamera(pair.right, run.flight.right, degrees * kDegree * Eigen::Vector3d::Unit(index));
  });
}

Fault calibrated(const char* name, const char* meaning,
                 std::function<void(CameraCalibration&, CameraCalibration&)> calibrate) {
  Fault fault{name, meaning, Place::kSensor, {}, std::move(calibrate), {}, {}, false, false};
  return fault;
}

}  // namespace

void addRigFaults(std::vector<Fault>& all) {
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

}  // namespace uav_landing
