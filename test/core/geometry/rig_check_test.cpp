#include "uav_landing/geometry/rig_check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace uav_landing {
namespace {

using Texts = std::vector<std::string>;

/// Two cameras of 640 x 480, principal point in the middle.
struct Pair {
  CameraCalibration left = camera(0), right = camera(-0.5);
  RigParameters limits;

  static CameraCalibration camera(double Tx_over_f) {
    CameraCalibration c;
    c.width = 640;
    c.height = 480;
    c.distortion_model = "plumb_bob";
    c.D = {0, 0, 0, 0, 0};
    c.K << 500, 0, 320, 0, 500, 240, 0, 0, 1;
    c.R.setIdentity();
    c.P << 500, 0, 320, 500 * Tx_over_f, 0, 500, 240, 0, 0, 0, 1, 0;
    return c;
  }
  void both(const std::function<void(CameraCalibration&)>& change) {
    change(left);
    change(right);
  }
};

std::string refusal(const Pair& pair) {
  const Expected<StereoRig> rig = makeStereoRig(pair.left, pair.right, pair.limits);
  return rig ? "accepted" : rig.error().message();
}

Texts warnings(const Pair& pair) { return rigWarnings(pair.left, pair.right, pair.limits); }

const char* const kHint =
    ": is this the calibration of another image size? If the image is cropped off the middle, raise "
    "rig/max_principal_point_offset";

TEST(RigCheck, AcceptsACameraThatLooksThroughItsMiddleWithoutAWord) {
  EXPECT_EQ(refusal(Pair()), "accepted");
  EXPECT_EQ(warnings(Pair()), Texts());
}

TEST(RigCheck, MakesTheSameRigAsWithoutLimits) {
  const Pair pair;
  const StereoRig with = makeStereoRig(pair.left, pair.right, pair.limits).value(),
                  without = makeStereoRig(pair.left, pair.right).value();
  EXPECT_EQ(with.K(), without.K());
  EXPECT_EQ(with.baseline, without.baseline);
}

TEST(PrincipalPoint, OfAPictureTwiceAsLargeIsRefused) {
  Pair pair;
  pair.both([](CameraCalibration& c) { c.K.topRows(2) *= 2; });
  EXPECT_EQ(
      refusal(pair),
      std::string("input_invalid: left K[2]: 640, expected 192 to 448 in an image 640 px wide") + kHint);
  EXPECT_EQ(warnings(pair), Texts()) << "the refusal says it";
}

TEST(PrincipalPoint, OfAPictureHalfAsLargeIsRefused) {
  Pair pair;
  pair.both([](CameraCalibration& c) { c.K.topRows(2) *= 0.5; });
  EXPECT_EQ(
      refusal(pair),
      std::string("input_invalid: left K[2]: 160, expected 192 to 448 in an image 640 px wide") + kHint);
}

TEST(PrincipalPoint, OfABinnedPictureIsRefusedWhereBinningIsAnnouncedAsWell) {
  Pair pair;
  pair.both([](CameraCalibration& c) {
    c.width = 1280;
    c.height = 960;
    c.binning_x = c.binning_y = 2;
  });
  EXPECT_EQ(
      refusal(pair),
      std::string("input_invalid: left K[2]: 320, expected 384 to 896 in an image 1280 px wide") + kHint);
}

TEST(PrincipalPoint, OfAWholeWidthIsRefusedForTheHalvesOfASideBySidePicture) {
  Pair pair;
  pair.both([](CameraCalibration& c) { c.width = 320; });
  EXPECT_EQ(refusal(pair),
            std::string("input_invalid: left K[2]: 320, expected 96 to 224 in an image 320 px wide") + kHint);
}

TEST(PrincipalPoint, OfTheWholePictureIsRefusedForACropWhoseCentreWasNotMoved) {
  Pair pair;
  pair.both([](CameraCalibration& c) { c.height = 240; });
  EXPECT_EQ(refusal(pair),
            std::string("input_invalid: left K[5]: 240, expected 72 to 168 in an image 240 px high") + kHint);
}

TEST(PrincipalPoint, OfTheRightCameraCountsAsWell) {
  Pair pair;
  pair.right.K(1, 2) = 480;
  EXPECT_EQ(
      refusal(pair),
      std::string("input_invalid: right K[5]: 480, expected 144 to 336 in an image 480 px high") + kHint);
  pair.right.K(1, 2) = 300;
  EXPECT_EQ(warnings(pair), Texts{"right K[5]: 300, 12.5 % of the image's height off its middle: is this the "
                                  "calibration of another image size?"});
}

TEST(PrincipalPoint, IsNeitherRefusedNorWarnedAboutWhereTheRegionOfInterestIsAnnounced) {
  Pair pair;
  pair.both([](CameraCalibration& c) {
    c.roi = {0, 300, 640, 180};  // the sky cut away
    c.binning_x = c.binning_y = 2;
  });
  EXPECT_EQ(refusal(pair), "accepted");
  EXPECT_EQ(warnings(pair), Texts());
}

TEST(PrincipalPoint, OfTheRectifiedPictureMayLieAnywhere) {
  Pair pair;
  pair.both([](CameraCalibration& c) {
    c.P(0, 2) = -400;
    c.P(1, 2) = 900;
  });
  EXPECT_EQ(refusal(pair), "accepted");
  EXPECT_EQ(warnings(pair), Texts());
}

TEST(PrincipalPoint, OfAPictureThatIsCroppedOffTheMiddleIsLetThroughByTheParameter) {
  Pair pair;
  pair.both([](CameraCalibration& c) {
    c.height = 180;  // rows 300 to 479 of the camera's 480
    c.K(1, 2) = 240 - 300;
  });
  EXPECT_NE(refusal(pair), "accepted");
  pair.limits.max_principal_point_offset = 0.9;  // 150 of 180 rows are 0.833
  EXPECT_EQ(refusal(pair), "accepted");
  EXPECT_EQ(warnings(pair),
            (Texts{"left K[5]: -60, 83.33 % of the image's height off its middle: is this the "
                   "calibration of another image size?",
                   "right K[5]: -60, 83.33 % of the image's height off its middle: is this "
                   "the calibration of another image size?"}));
  pair.limits.max_principal_point_offset = 1.7;
  EXPECT_EQ(warnings(pair), Texts()) << "less than half of what is let through";
}

struct Limit {
  const char* name;
  int row;       // of K
  double value;  // of the principal point
  bool accepted;
  size_t warnings;
};

class PrincipalPointLimit : public testing::TestWithParam<Limit> {};

TEST_P(PrincipalPointLimit, IsTenPerCentForAWarningAndTwentyForARefusal) {
  for (const bool right : {false, true}) {
    Pair pair;
    (right ? pair.right : pair.left).K(GetParam().row, 2) = GetParam().value;
    EXPECT_EQ(refusal(pair) == "accepted", GetParam().accepted) << refusal(pair);
    EXPECT_EQ(warnings(pair).size(), GetParam().warnings);
  }
}

// The middle is (320, 240); 10 % of the size are 64 columns and 48 rows.
INSTANTIATE_TEST_SUITE_P(
    , PrincipalPointLimit,
    testing::Values(Limit{"left_within_10", 0, 256.5, true, 0}, Limit{"left_beyond_10", 0, 255.5, true, 1},
                    Limit{"right_within_10", 0, 383.5, true, 0}, Limit{"right_at_10", 0, 384, true, 1},
                    Limit{"left_within_20", 0, 192.5, true, 1}, Limit{"left_beyond_20", 0, 191.5, false, 0},
                    Limit{"right_at_20", 0, 448, true, 1}, Limit{"right_beyond_20", 0, 448.5, false, 0},
                    Limit{"up_within_10", 1, 192.5, true, 0}, Limit{"up_beyond_10", 1, 191.5, true, 1},
                    Limit{"down_within_10", 1, 287.5, true, 0}, Limit{"down_at_10", 1, 288, true, 1},
                    Limit{"up_within_20", 1, 144.5, true, 1}, Limit{"up_beyond_20", 1, 143.5, false, 0},
                    Limit{"down_at_20", 1, 336, true, 1}, Limit{"down_beyond_20", 1, 336.5, false, 0}),
    [](const testing::TestParamInfo<Limit>& info) { return info.param.name; });

class Baseline : public testing::Test {
 protected:
  void setBaseline(double metres) { pair_.right.P(0, 3) = -500 * metres; }
  Pair pair_;
};

TEST_F(Baseline, FromOneCentimetreToTenMetresIsLikely) {
  for (const double metres : {0.01, 0.11, 1.0, 10.0}) {
    setBaseline(metres);
    EXPECT_EQ(refusal(pair_), "accepted");
    EXPECT_EQ(warnings(pair_), Texts()) << metres;
  }
}

TEST_F(Baseline, OfLessIsWarnedAbout) {
  setBaseline(0.00965);
  EXPECT_EQ(refusal(pair_), "accepted");
  EXPECT_EQ(warnings(pair_), Texts{"baseline 0.00965 m: is right P[3] in metres (-fx times the baseline)?"});
}

TEST_F(Baseline, OfMoreIsWarnedAboutUpToFiftyMetres) {
  for (const double metres : {10.5, 50.0}) {
    setBaseline(metres);
    EXPECT_EQ(refusal(pair_), "accepted");
    EXPECT_EQ(warnings(pair_).size(), 1u) << metres;
  }
  EXPECT_EQ(warnings(pair_), Texts{"baseline 50 m: is right P[3] in metres (-fx times the baseline)?"});
}

TEST_F(Baseline, InMillimetresIsRefused) {
  setBaseline(1000);
  EXPECT_EQ(refusal(pair_),
            "input_invalid: baseline 1000 m, expected at most 50 m: is right P[3] in metres (-fx times the "
            "baseline)? If it is, raise rig/max_baseline");
  EXPECT_EQ(warnings(pair_), Texts());
}

TEST_F(Baseline, IsLetThroughByTheParameterWithAWarning) {
  setBaseline(60);
  EXPECT_NE(refusal(pair_), "accepted");
  pair_.limits.max_baseline = 60;
  EXPECT_EQ(refusal(pair_), "accepted");
  EXPECT_EQ(warnings(pair_), Texts{"baseline 60 m: is right P[3] in metres (-fx times the baseline)?"});
}

TEST(RigCheck, NamesAFieldThatMakesNoSenseBeforeWhatIsUnlikely) {
  Pair pair;
  pair.left.K(0, 2) = 640;
  pair.right.P(0, 3) = NAN;
  EXPECT_EQ(refusal(pair), "input_invalid: right P[3]: nan, expected a number");
  EXPECT_EQ(warnings(pair), Texts());
}

TEST(RigCheck, WarnsOfBothCamerasAndTheBaselineAtOnce) {
  Pair pair;
  pair.both([](CameraCalibration& c) { c.K.topRows(2) *= 1.3; });
  pair.right.P(0, 3) = -500 * 20;
  EXPECT_EQ(
      warnings(pair),
      (Texts{"left K[2]: 416, 15 % of the image's width off its middle: is this the calibration of another "
             "image size?",
             "right K[2]: 416, 15 % of the image's width off its middle: is this the calibration of another "
             "image size?",
             "baseline 20 m: is right P[3] in metres (-fx times the baseline)?"}));
}

}  // namespace
}  // namespace uav_landing
