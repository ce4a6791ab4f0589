#include "kernels/samples/plane_votes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "kernels/lanes/lanes.h"
#include "support/random_values.h"

namespace uav_landing {
namespace {

TEST(PlaneVotes, AreOfEachSample) {
  const VoteRules rules{0.8, 1.0, 2.0, 0.5, 0.1};
  for (const size_t count : {0U, 1U, 3U, 4U, 5U, 64U, 301U}) {
    // What fills up has an expected value that counts, or one that does not.
    const LinearValue plane{0.05, 0.2, count % 2 == 0 ? 0.3 : 1.5};
    VoteColumns columns(count);
    const auto set = [&](std::vector<double>& column, double low, double high, unsigned seed) {
      const std::vector<double> values = test::randomValues<double>(count, low, high, seed);
      std::copy(values.begin(), values.end(), column.begin());
    };
    set(columns.x, -20, 20, 3);
    set(columns.y, 0, 30, 4);
    set(columns.u, 0, 20, 5);
    set(columns.value, 0, 9, 6);
    double agreeing = 0, penalty = 0;
    for (size_t i = 0; i < count; ++i) {
      const double expected = plane.x_slope * columns.x[i] + plane.y_slope * columns.y[i] + plane.constant;
      const double off = columns.value[i] - expected;
      if (expected < rules.least) continue;
      if (std::abs(off) < rules.tolerance) {
        agreeing += 1 - std::pow(off / rules.tolerance, 2);
      } else if (columns.u[i] - expected >= rules.offset) {
        penalty += off < -2 * rules.tolerance ? rules.below : rules.above;
      }
    }
    const Votes votes = voteForPlane(columns, plane, rules);
    EXPECT_NEAR(votes.agreeing, agreeing, 1e-10) << count;
    EXPECT_NEAR(votes.penalty, penalty, 1e-10) << count;
    EXPECT_EQ(votes.net(), votes.agreeing - votes.penalty);
  }
}

TEST(PlaneVotes, AreOfTheNearestOfSeveralValues) {
  const VoteRules rules{0.8, 1.0, 2.0, 0.5, 0.1};
  const LinearValue plane{0.05, 0.2, 1.5};
  constexpr size_t kCount = 37, kTwo = 20, kThree = 8;
  VoteColumns columns(kCount);
  const auto set = [](std::vector<double>& column, size_t count, double low, double high, unsigned seed) {
    const std::vector<double> values = test::randomValues<double>(count, low, high, seed);
    std::copy(values.begin(), values.end(), column.begin());
  };
  set(columns.x, kCount, -20, 20, 3);
  set(columns.y, kCount, 0, 30, 4);
  set(columns.u, kCount, 0, 20, 5);
  set(columns.value, kCount, 0, 9, 6);
  columns.others = {std::vector<double>(wholeDoubleLanes(kTwo), VoteColumns::kNowhere),
                    std::vector<double>(wholeDoubleLanes(kThree), VoteColumns::kNowhere)};
  set(columns.others[0], kTwo, 0, 9, 7);
  set(columns.others[1], kThree, 0, 9, 8);
  double agreeing = 0, penalty = 0;
  for (size_t i = 0; i < kCount; ++i) {
    const double expected = plane.x_slope * columns.x[i] + plane.y_slope * columns.y[i] + plane.constant;
    if (expected < rules.least) continue;
    std::vector<double> values{columns.value[i]};
    if (i < kTwo) values.push_back(columns.others[0][i]);
    if (i < kThree) values.push_back(columns.others[1][i]);
    double nearest = 1e9, largest = -1e9;
    for (const double value : values) {
      nearest = std::min(nearest, std::abs(value - expected));
      largest = std::max(largest, value);
    }
    if (nearest < rules.tolerance) {
      agreeing += 1 - std::pow(nearest / rules.tolerance, 2);
    } else if (columns.u[i] - expected >= rules.offset) {
      penalty += largest < expected - 2 * rules.tolerance ? rules.below : rules.above;
    }
  }
  const Votes votes = voteForPlane(columns, plane, rules);
  EXPECT_NEAR(votes.agreeing, agreeing, 1e-10);
  EXPECT_NEAR(votes.penalty, penalty, 1e-10);
}

}  // namespace
}  // namespace uav_landing
