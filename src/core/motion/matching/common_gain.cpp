#include "motion/matching/common_gain.h"

#include <algorithm>
#include <cmath>

namespace uav_landing {
namespace {

class MeansLine {
 public:
  // Least squares over the windows that are within limit (grey levels) of the line so far. Returns false when
  // they do not determine a line.
  bool fit(const std::vector<WindowMeans>& windows, double limit) {
    Sums sums;
    for (const WindowMeans& means : windows)
      if (std::abs(means.now - slope_ * means.then - offset_) <= limit) sums.add(means);
    constexpr int kFewest = 4;
    if (sums.count < kFewest) return false;
    const double count = sums.count;
    spread_ = (sums.xx - sums.x * sums.x / count) / count;
    if (!(spread_ > 0)) return false;
    const double covariance = (sums.xy - sums.x * sums.y / count) / count;
    slope_ = covariance / spread_;
    offset_ = (sums.y - slope_ * sums.x) / count;
    const double own = (sums.yy - sums.y * sums.y / count) / count;
    residual_ = std::max(0.0, own - slope_ * covariance) * count / (count - 2);
    return true;
  }
  double slope() const { return slope_; }
  double residual() const { return residual_; }  // variance of a window's mean about the line
  double spread() const { return spread_; }      // variance of the windows' means

 private:
  struct Sums {
    int count = 0;
    double x = 0, y = 0, xx = 0, xy = 0, yy = 0;

    void add(const WindowMeans& means) {
      ++count;
      x += means.then;
      y += means.now;
      xx += means.then * means.then;
      xy += means.then * means.now;
      yy += means.now * means.now;
    }
  };
  double slope_ = 1, offset_ = 0, residual_ = 0, spread_ = 0;
};

}  // namespace

CommonGain commonGain(const std::vector<WindowMeans>& windows) {
  constexpr int kPasses = 3;
  constexpr double kOutlier = 3, kLeastLimit = 0.1;  // stddevs; grey levels
  MeansLine line;
  double limit = std::numeric_limits<double>::infinity();
  for (int pass = 0; pass < kPasses; ++pass) {
    if (!line.fit(windows, limit)) return {};
    limit = std::max(kLeastLimit, kOutlier * std::sqrt(line.residual()));
  }
  return {line.slope(), line.residual() / line.spread()};
}

}  // namespace uav_landing
