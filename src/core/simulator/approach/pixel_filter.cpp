#include "simulator/approach/pixel_filter.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace uav_landing {
namespace {

constexpr double kPixelVariance = 1.0 / 12;  // variance of a square of 1 px along each side

/// Weights along one axis of pieces that divide the support evenly, and the variance of the whole.
struct Profile {
  std::vector<double> at, weight;
  double side, variance;

  Profile(int pieces, double support, bool tent) : side(support / pieces), variance(side * side / 12) {
    for (int i = 0; i < pieces; ++i) {
      at.push_back((i + 0.5) * side - 0.5 * support);
      weight.push_back(tent ? 1 - std::abs(at.back()) : 1);
    }
    const double sum = std::accumulate(weight.begin(), weight.end(), 0.0);
    for (size_t i = 0; i < at.size(); ++i) variance += (weight[i] /= sum) * at[i] * at[i];
  }
};

}  // namespace

PixelFilter::PixelFilter(int samples, double blur)
    : PixelFilter(samples, blur, blur * blur >= Profile(2 * samples, 2, true).variance - kPixelVariance) {}

PixelFilter::PixelFilter(int samples, double blur, bool tent)
    : side_samples_(samples), blur_(blur), tent_(tent), support_(tent ? 2 : 1) {
  const Profile profile(tent ? 2 * samples : samples, support_, tent);
  for (size_t j = 0; j < profile.at.size(); ++j)
    for (size_t i = 0; i < profile.at.size(); ++i)
      samples_.push_back({static_cast<float>(profile.at[i]), static_cast<float>(profile.at[j]),
                          static_cast<float>(profile.weight[i] * profile.weight[j])});
  sample_side_ = static_cast<float>(profile.side);
  equivalent_side_ = static_cast<float>(std::sqrt(12 * profile.variance));
  blur_left_ = std::sqrt(std::max(0.0, blur * blur - (profile.variance - kPixelVariance)));
}

double PixelFilter::share(double offset) const {
  // A point between two pixels belongs to the one after it.
  if (!tent_) return offset >= -0.5 && offset < 0.5 ? 1 : 0;
  return std::max(0.0, 1 - std::abs(offset));
}

}  // namespace uav_landing
