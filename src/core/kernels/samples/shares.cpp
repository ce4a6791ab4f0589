#include "kernels/samples/shares.h"

#include "kernels/lanes/lanes.h"
#include "kernels/lanes/multiversion.h"

namespace uav_landing {

UAV_LANDING_MULTIVERSION float sumOfShares(const float* us, const float* vs, size_t first, size_t count,
                                           const Square& square) {
  const float at_u = square.u, at_v = square.v, share = 1 / square.extent;
  const Lanes none{};
  Lanes sums{}, index;
  progress(0, 1, index);
  index -= static_cast<float>(count - first);  // below zero where it counts
  for (size_t i = first; i < count; i += kLanes, index += kLanes) {
    Lanes u, v;
    load(us + i, u);
    load(vs + i, v);
    u -= at_u;
    v -= at_v;
    const Lanes across = 1 - share * (u < 0 ? -u : u), down = 1 - share * (v < 0 ? -v : v);
    sums += ((across > 0) & (down > 0) & (index < 0)) ? across * down : none;
  }
  return sum(sums);
}

}  // namespace uav_landing
