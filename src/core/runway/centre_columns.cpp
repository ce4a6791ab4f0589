#include "runway/centre_columns.h"

#include "base/multiversion.h"

namespace uav_landing {

void CentreColumns::add(double centre, double variance, const Eigen::Vector3d& by_rotation) {
  centres_.push_back(centre);
  variances_.push_back(variance);
  for (int axis = 0; axis < 3; ++axis) by_rotation_[axis].push_back(by_rotation[axis]);
}

UAV_LANDING_MULTIVERSION void CentreColumns::markApart(std::ptrdiff_t one, double sigmas, double spread,
                                                       uchar* __restrict apart) const {
  constexpr double kSafe = 1.001;
  const double *centres = centres_.data(), *variances = variances_.data();
  const double *x = by_rotation_[0].data(), *y = by_rotation_[1].data(), *z = by_rotation_[2].data();
  const double centre = centres[one], variance = variances[one], own_x = x[one], own_y = y[one],
               own_z = z[one], limit = kSafe * sigmas * sigmas;
  const int count = static_cast<int>(centres_.size());
  for (int i = 0; i < count; ++i) {
    const double dx = x[i] - own_x, dy = y[i] - own_y, dz = z[i] - own_z, off = centres[i] - centre;
    const double most = variances[i] + variance + spread * (dx * dx + dy * dy + dz * dz);
    apart[i] = off * off > limit * most ? 1 : 0;
  }
}

}  // namespace uav_landing
