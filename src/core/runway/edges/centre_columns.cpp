#include "runway/edges/centre_columns.h"

#include "kernels/samples/apart.h"

namespace uav_landing {

void CentreColumns::add(double centre, double variance, const Eigen::Vector3d& by_rotation) {
  constexpr double kFloatError = 1e-6;  // rounding error as a share of the centre, several times over
  centres_.push_back(static_cast<float>(centre));
  variances_.push_back(static_cast<float>(variance + kFloatError * kFloatError * centre * centre));
  for (int axis = 0; axis < 3; ++axis) by_rotation_[axis].push_back(static_cast<float>(by_rotation[axis]));
}

void CentreColumns::markApart(std::ptrdiff_t one, double sigmas, double spread, uchar* apart) const {
  constexpr double kSafe = 1.01;
  const NumberColumns centres{centres_.data(),
                              variances_.data(),
                              {by_rotation_[0].data(), by_rotation_[1].data(), by_rotation_[2].data()},
                              static_cast<int>(centres_.size())};
  uav_landing::markApart(centres, one, static_cast<float>(kSafe * sigmas * sigmas),
                         static_cast<float>(spread), apart);
}

}  // namespace uav_landing
