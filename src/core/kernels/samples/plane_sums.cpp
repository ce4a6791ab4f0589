#include "kernels/samples/plane_sums.h"

#include <limits>

#include "kernels/lanes/lanes.h"
#include "kernels/lanes/multiversion.h"

namespace uav_landing {

void PlaneColumns::resize(size_t count) {
  const size_t filled = wholeDoubleLanes(count);
  for (std::vector<double>* column : {&x, &y, &value, &precision, &expected, &weight, &ratio})
    column->resize(filled);
  for (size_t i = count; i < filled; ++i) x[i] = y[i] = value[i] = precision[i] = 0;
}

UAV_LANDING_MULTIVERSION void expectValues(const LinearValue& plane, PlaneColumns& columns) {
  const double x_slope = plane.x_slope, y_slope = plane.y_slope, constant = plane.constant;
  const double *x = columns.x.data(), *y = columns.y.data();
  double* __restrict expected = columns.expected.data();
  const size_t count = columns.x.size();
  for (size_t i = 0; i < count; ++i) expected[i] = x_slope * x[i] + y_slope * y[i] + constant;
}

UAV_LANDING_MULTIVERSION NearbyCount measureBelow(double farthest, double per_ratio, PlaneColumns& columns) {
  const DoubleLanes none{}, one = none + 1, infinity = none + std::numeric_limits<double>::infinity();
  const double lowest = -farthest;
  DoubleLanes all{}, small{};
  for (size_t i = 0; i < columns.x.size(); i += kDoubleLanes) {
    DoubleLanes precision, value, expected;
    load(&columns.precision[i], precision);
    load(&columns.value[i], value);
    load(&columns.expected[i], expected);
    const DoubleLanes residual = value - expected;
    const auto near = (residual <= 0) & (residual > lowest) & (precision > 0);
    const DoubleLanes ratio = near ? -residual * precision : infinity;
    store(ratio, &columns.ratio[i]);
    all += near ? one : none;
    small += per_ratio * ratio <= 1 ? one : none;
  }
  return {static_cast<size_t>(sum(all)), static_cast<size_t>(sum(small))};
}

UAV_LANDING_MULTIVERSION PlaneSums addUpTukey(double unit, PlaneColumns& columns) {
  const DoubleLanes none{}, one = none + 1;
  DoubleLanes w{}, wx{}, wy{}, wxx{}, wxy{}, wyy{}, wd{}, wxd{}, wyd{}, squares{}, count{};
  for (size_t i = 0; i < columns.x.size(); i += kDoubleLanes) {
    DoubleLanes x, y, precision, value, expected;
    load(&columns.x[i], x);
    load(&columns.y[i], y);
    load(&columns.precision[i], precision);
    load(&columns.value[i], value);
    load(&columns.expected[i], expected);
    const DoubleLanes residual = value - expected, information = precision * precision;
    const DoubleLanes missing = 1 - residual * residual * information * unit;
    const auto inside = (missing > 0) & (expected > 0) & (information > 0);
    const DoubleLanes weight = inside ? missing * missing * information : none;
    const DoubleLanes weight_x = weight * x, weight_y = weight * y;
    store(weight, &columns.weight[i]);
    count += inside ? one : none;
    w += weight;
    wx += weight_x;
    wy += weight_y;
    wxx += weight_x * x;
    wxy += weight_x * y;
    wyy += weight_y * y;
    wd += weight * value;
    wxd += weight_x * value;
    wyd += weight_y * value;
    squares += weight * residual * residual;
  }
  return {sum(w),
          sum(wx),
          sum(wy),
          sum(wxx),
          sum(wxy),
          sum(wyy),
          sum(wd),
          sum(wxd),
          sum(wyd),
          sum(squares),
          static_cast<int>(sum(count))};
}

}  // namespace uav_landing
