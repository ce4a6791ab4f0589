#include "kernels/lanes/order_statistic.h"

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

/// The same of doubles, for some of the ranks.
void expectInOrder(const std::vector<double>& values) {
  std::vector<double> sorted = values;
  std::sort(sorted.begin(), sorted.end());
  for (size_t rank = 0; rank < values.size(); rank += 1 + values.size() / 50)
    ASSERT_EQ(orderStatistic(values.data(), values.size(), rank), sorted[rank])
        << rank << " of " << values.size();
}

TEST(OrderStatisticOfDoubles, IsTheValueOfThatRank) {
  std::mt19937 random(7);
  std::normal_distribution<double> some;
  for (const size_t count : {1, 2, 15, 63, 64, 65, 66, 67, 300, 1001}) {
    std::vector<double> values(count);
    for (double& value : values) value = some(random);
    expectInOrder(values);
    for (double& value : values) value = std::exp(20 * value);
    expectInOrder(values);
  }
}
TEST(OrderStatisticOfDoubles, CountsEqualValuesOneByOne) {
  std::mt19937 random(9);
  for (const int different : {1, 2, 5, 40}) {
    std::vector<double> values(500);
    for (double& value : values) value = static_cast<double>(random() % different) - 2;
    expectInOrder(values);
  }
}
TEST(OrderStatisticOfDoubles, FindsValuesThatSamplesMiss) {
  std::vector<double> values(640, 1e-300);
  for (size_t i = 1; i < values.size(); i += 40) values[i] = -1e300 + 1e290 * static_cast<double>(i);
  for (size_t i = 2; i < values.size(); i += 40) values[i] = 1e300;
  expectInOrder(values);
}
TEST(OrderStatisticOfDoubles, EndsWhereNothingCanBePutInOrder) {
  const std::vector<double> values(100, std::numeric_limits<double>::quiet_NaN());
  EXPECT_TRUE(std::isnan(orderStatistic(values.data(), values.size(), 50)));
  const std::vector<double> endless(17, std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(orderStatistic(endless.data(), endless.size(), 8)));
}

}  // namespace
}  // namespace uav_landing
