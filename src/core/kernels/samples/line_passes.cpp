#include "kernels/samples/line_passes.h"

#include <cmath>

#include "kernels/lanes/multiversion.h"

namespace uav_landing {

void LineColumns::reserve(size_t count) {
  for (std::vector<double>* column : {&middle_u, &middle_v, &along_u, &along_v, &across_u, &across_v, &top_u,
                                      &top_v, &half2, &reach, &tolerance2})
    column->reserve(count);
}

UAV_LANDING_MULTIVERSION void fitLines(const LineColumns& lines, double x, double y, double z, double slope,
                                       int count, double* __restrict fit) {
  const double *mu = lines.middle_u.data(), *mv = lines.middle_v.data(), *au = lines.along_u.data(),
               *av = lines.along_v.data(), *nu = lines.across_u.data(), *nv = lines.across_v.data(),
               *tu = lines.top_u.data(), *tv = lines.top_v.data(), *half2 = lines.half2.data(),
               *reach = lines.reach.data(), *tolerance2 = lines.tolerance2.data();
  for (int i = 0; i < count; ++i) {
    const double eu = x - z * mu[i], ev = y - z * mv[i];
    const double ahead = std::abs(au[i] * eu + av[i] * ev), across = nu[i] * eu + nv[i] * ev;
    const double miss2 = half2[i] * across * across / (across * across + ahead * ahead);
    const double passing = ahead < reach[i] * z ? -1.0 : 1 - miss2 / tolerance2[i];
    const double above = (y - z * tv[i]) - slope * std::abs(x - z * tu[i]);
    fit[i] = above > 0 ? kTopAbove : passing;
  }
}

}  // namespace uav_landing
