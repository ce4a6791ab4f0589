#include "runway/centre_columns.h"

#include "kernels/lanes/multiversion.h"

namespace uav_landing {

void CentreColumns::add(double centre, double variance, const Eigen::Vector3d& by_rotation) {
  constexpr double kFloatError = 1e-6;  // of the centre, several times
  centres_.push_back(static_cast<float>(centre));
  variances_.push_back(static_cast<float>(variance + kFloatError * kFloatError * centre * centre));
  for (int axis = 0; axis < 3; ++axis) by_rotation_[axis].push_back(static_cast<float>(by_rotation[axis]));
}

UAV_LANDING_MULTIVERSION void CentreColumns::markApart(std::ptrdiff_t one, double sigmas, double spread,
                                                       uchar* __restrict apart) const {
  constexpr double kSafe = 1.01;
  const float *centres = centres_.data(), *variances = variances_.data();
  const float *x = by_rotation_[0].data(), *y = by_rotation_[1].data(), *z = by_rotation_[2].data();
  const float centre = centres[one], variance = variances[one], own_x = x[one], own_y = y[one],
              own_z = z[one], limit = static_cast<float>(kSafe * sigmas * sigmas),
              by_turn = static_cast<float>(spread);
  const int count = static_cast<int>(centres_.size());
  for (int i = 0; i < count; ++i) {
    const float dx = x[i] - own_x, dy = y[i] - own_y, dz = z[i] - own_z, off = centres[i] - centre;
    const float most = variances[i] + variance + by_turn * (dx * dx + dy * dy + dz * dz);
    apart[i] = off * off > limit * most ? 1 : 0;
  }
}

}  // namespace uav_landing
