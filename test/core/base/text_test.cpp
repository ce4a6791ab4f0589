#include "base/text.h"

#include <gtest/gtest.h>

namespace uav_landing {
namespace {

TEST(Text, JoinsWordsAndNumbers) { EXPECT_EQ(text("no pair for ", 0.5, " s"), "no pair for 0.5 s"); }

TEST(Text, MeasuredNumbersHaveFourDigits) {
  EXPECT_EQ(rounded(18.9593), "18.96");
  EXPECT_EQ(rounded(0.947966), "0.948");
  EXPECT_EQ(rounded(-1.5), "-1.5");
}

}  // namespace
}  // namespace uav_landing
