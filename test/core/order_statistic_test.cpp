#include "order_statistic.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace uav_landing {
namespace {

constexpr int kMost = 320;

/// Asks for each rank and compares with the sorted values.
void expectInOrder(std::vector<float> values, float guess) {
  PaddedValues<kMost> padded;
  std::copy(values.begin(), values.end(), padded.values.begin());
  padded.count = static_cast<int>(values.size());
  padded.pad();
  std::sort(values.begin(), values.end());
  for (int rank = 0; rank < padded.count; ++rank)
    ASSERT_EQ(orderStatistic(padded, rank, guess), values[rank]) << rank << " of " << values.size();
}

TEST(OrderStatistic, IsTheValueOfThatRank) {
  std::mt19937 random(3);
  std::exponential_distribution<float> some(0.5F);
  for (int count = 1; count <= kMost; count += count < 20 ? 1 : 37) {
    std::vector<float> values(count);
    for (float& value : values) value = some(random);
    for (const float guess : {1e-6F, 0.7F, 2.F, 1e6F}) expectInOrder(values, guess);
  }
}
TEST(OrderStatistic, CountsEqualValuesOneByOne) {
  std::mt19937 random(5);
  for (const int different : {1, 2, 5}) {
    std::vector<float> values(100);
    for (float& value : values) value = static_cast<float>(random() % different);
    expectInOrder(values, 1);
  }
}
TEST(OrderStatistic, StandsValuesFarApart) {
  std::vector<float> values;
  for (int i = -30; i < 30; ++i) values.push_back(std::ldexp(1.F, 2 * i));
  std::reverse(values.begin(), values.end());
  expectInOrder(values, 1);
  std::vector<float> few_large(80, 1e-3F);
  few_large[7] = few_large[50] = std::numeric_limits<float>::max();
  expectInOrder(few_large, 1e20F);
}
TEST(OrderStatistic, EndsWhereNothingCanBePutInOrder) {
  PaddedValues<8> padded;
  padded.values.fill(std::numeric_limits<float>::quiet_NaN());
  padded.count = 8;
  EXPECT_FALSE(orderStatistic(padded, 4, 1) < std::numeric_limits<float>::infinity());
}

}  // namespace
}  // namespace uav_landing
