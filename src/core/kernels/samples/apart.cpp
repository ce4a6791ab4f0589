#include "kernels/samples/apart.h"

#include "kernels/lanes/multiversion.h"

namespace uav_landing {

UAV_LANDING_MULTIVERSION void markApart(const NumberColumns& numbers, std::ptrdiff_t one, float limit,
                                        float by_change, uchar* __restrict apart) {
  const float *values = numbers.values, *variances = numbers.variances;
  const float *x = numbers.derivatives[0], *y = numbers.derivatives[1], *z = numbers.derivatives[2];
  const float value = values[one], variance = variances[one], own_x = x[one], own_y = y[one], own_z = z[one];
  const int count = numbers.count;
  for (int i = 0; i < count; ++i) {
    const float dx = x[i] - own_x, dy = y[i] - own_y, dz = z[i] - own_z, off = values[i] - value;
    const float most = variances[i] + variance + by_change * (dx * dx + dy * dy + dz * dz);
    apart[i] = off * off > limit * most ? 1 : 0;
  }
}

}  // namespace uav_landing
