#include "kernels/window/shifts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/random_values.h"

namespace uav_landing {
namespace {

TEST(CorrelateShifts, IsTheCorrelationAtEachShift) {
  for (const int size : {3, 5, 11, 15})
    for (const int count : {1, 3, 7, 9, 21}) {
      const int stride = (wholeLanes(count) + size - 1 + 3) / 4 * 4, rows = size + count - 1;
      std::vector<float> window = test::randomValues<float>(size * size, -50, 50, size);
      double mean = 0, energy = 0;
      for (const float value : window) mean += value / (size * size);
      for (float& value : window) value -= static_cast<float>(mean);
      for (const float value : window) energy += static_cast<double>(value) * value;
      std::vector<float> area = test::randomValues<float>(wholeLanes(stride * rows) + kLanes, -70, 60, count);
      if (count > 3)  // no contrast at the last shift
        for (int j = 0; j < size; ++j)
          for (int i = 0; i < size; ++i) area[(count - 1 + j) * stride + count - 1 + i] = -3;
      ShiftRows memory;
      std::vector<float> scores(count * count);
      correlateShifts({window.data(), size, energy}, area.data(), stride, count, memory, scores.data());
      for (int y = 0; y < count; ++y)
        for (int x = 0; x < count; ++x) {
          double cross = 0, sum = 0, squares = 0;
          for (int j = 0; j < size; ++j)
            for (int i = 0; i < size; ++i) {
              const double value = area[(y + j) * stride + x + i];
              cross += window[j * size + i] * value;
              sum += value;
              squares += value * value;
            }
          const double other = squares - sum * sum / (size * size);
          const double expected = other < 1e-3 * energy ? kNoScore : cross / std::sqrt(other * energy);
          ASSERT_NEAR(scores[y * count + x], expected, 1e-4) << size << ' ' << count << ' ' << x << ' ' << y;
        }
      if (count > 3) {
        EXPECT_EQ(scores.back(), kNoScore);
      }
    }
}

}  // namespace
}  // namespace uav_landing
