#include "integrity/tests/recovery.h"

#include <gtest/gtest.h>

namespace uav_landing {
namespace {

TEST(Recovery, NeedsPairsThatAgreeAndNotOnlyTimeWithoutAny) {
  Recovery recovery(1.0);
  recovery.follow(0.1, Recovery::Pair::kContradicts, false);
  EXPECT_FALSE(recovery.pending()) << "the height was not lost";
  recovery.follow(0.1, Recovery::Pair::kContradicts, true);
  for (int i = 0; i < 20; ++i) recovery.follow(0.1, Recovery::Pair::kSilent, false);
  EXPECT_TRUE(recovery.pending());
  for (int i = 0; i < 9; ++i) recovery.follow(0.1, Recovery::Pair::kAgrees, false);
  EXPECT_TRUE(recovery.pending());
  recovery.follow(0.1, Recovery::Pair::kAgrees, false);
  EXPECT_FALSE(recovery.pending());
}

TEST(Recovery, AContradictionBeginsTheTimeAnew) {
  Recovery recovery(1.0);
  recovery.follow(0.1, Recovery::Pair::kContradicts, true);
  for (int i = 0; i < 9; ++i) recovery.follow(0.1, Recovery::Pair::kAgrees, false);
  EXPECT_NEAR(recovery.quiet(), 0.9, 1e-9);
  recovery.follow(0.1, Recovery::Pair::kContradicts, false);
  EXPECT_EQ(recovery.quiet(), 0);
  recovery.follow(0.1, Recovery::Pair::kAgrees, false);
  EXPECT_TRUE(recovery.pending());
  for (int i = 0; i < 9; ++i) recovery.follow(0.1, Recovery::Pair::kAgrees, false);
  EXPECT_FALSE(recovery.pending());
}

}  // namespace
}  // namespace uav_landing
