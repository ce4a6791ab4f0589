#include "runway/edges/centre_columns.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace uav_landing {
namespace {

struct Centre {
  double centre, variance;
  Eigen::Vector3d by_rotation;
};

/// Up to 30 heights to the sides; known to between a thousandth of their distance and all of it. Every other
/// one is where the one before is but for some sigma.
std::vector<Centre> makeCentres(size_t count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-30, 30), exponent(-3, 0), sigmas(2, 6);
  std::vector<Centre> all;
  for (size_t i = 0; i < count; ++i) {
    const double lateral = place(random), stddev = std::pow(10, exponent(random)) * std::abs(lateral);
    all.push_back({lateral, stddev * stddev, {1 + lateral * lateral, 0.1 * lateral, lateral}});
    if (i % 2 == 0) continue;
    all[i] = all[i - 1];
    all[i].centre += sigmas(random) * std::sqrt(2 * all[i].variance);
  }
  return all;
}

double ratio(const Centre& a, const Centre& b, double spread) {
  const double off = a.centre - b.centre;
  return off * off / (a.variance + b.variance + spread * (a.by_rotation - b.by_rotation).squaredNorm());
}

TEST(CentreColumns, SetsApartWhatIsSurelyFarEnoughAndHardlyLess) {
  constexpr double kGate = 4, kSpread = 1e-5;
  const std::vector<Centre> all = makeCentres(400);
  CentreColumns columns;
  for (const Centre& centre : all) columns.add(centre.centre, centre.variance, centre.by_rotation);
  std::vector<uchar> apart(all.size());
  int set = 0;
  for (size_t one = 0; one < all.size(); ++one) {
    columns.markApart(static_cast<std::ptrdiff_t>(one), kGate, kSpread, apart.data());
    for (size_t i = 0; i < all.size(); ++i) {
      const double share = ratio(all[one], all[i], kSpread) / (kGate * kGate);
      EXPECT_LE(apart[i], share > 1 ? 1 : 0) << one << " " << i << ": " << share;
      EXPECT_GE(apart[i], share > 1.02 ? 1 : 0) << one << " " << i << ": " << share;
      set += apart[i];
    }
  }
  EXPECT_GT(set, 1000);
}

}  // namespace
}  // namespace uav_landing
