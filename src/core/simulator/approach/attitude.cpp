#include "uav_landing/simulator/attitude.h"

#include <Eigen/Geometry>

namespace uav_landing {

Eigen::Matrix3d bodyFromOptical() {
  Eigen::Matrix3d rotation;
  rotation << 0, 0, 1,  //
      -1, 0, 0,         //
      0, -1, 0;
  return rotation;
}

Eigen::Matrix3d runwayFromOptical(const Attitude& attitude) {
  const Eigen::Quaterniond body = Eigen::AngleAxisd(attitude.yaw, Eigen::Vector3d::UnitZ()) *
                                  Eigen::AngleAxisd(-attitude.pitch, Eigen::Vector3d::UnitY()) *
                                  Eigen::AngleAxisd(attitude.roll, Eigen::Vector3d::UnitX());
  return body.toRotationMatrix() * bodyFromOptical();
}

}  // namespace uav_landing
