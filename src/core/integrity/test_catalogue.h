#pragma once

#include "height/attitude_filter.h"

namespace uav_landing {

/// In which step of the landing estimate a test is made (stages/kalman_height_stage.cpp).
enum class TestStep { kGround, kPair, kTrack, kMemory };

/// What follows from a failure.
enum class OnFailure {
  kReported,       ///< nothing but the report
  kPairLeftOut,    ///< no height by this pair
  kSourceLeftOut,  ///< that source does not count, the others do
  kAngleDoubted,   ///< the approach angle is less certain
  kNoHeight        ///< the published height is not valid
};

/// With what the squared normalised difference is compared.
struct TestLimit {
  enum Kind { kChiSquare, kSquaredGate, kFixed } kind;
  double value;  ///< of kFixed

  /// What noise alone exceeds with the probability false_alarm_rate.
  static constexpr TestLimit chiSquare() { return {kChiSquare, 0}; }
  /// The parameter gate, squared.
  static constexpr TestLimit squaredGate() { return {kSquaredGate, 0}; }
  static constexpr TestLimit fixed(double value) { return {kFixed, value}; }
};

/// All tests of integrity, in the order in which they are reported: name in the code, name for people, step,
/// what follows, limit, unit, what is compared, and what follows in words. A new test is a line here and a
/// call in its step; the enum, the messages, the diagnostics and docs/integrity_tests.md follow.
// clang-format off
#define UAV_LANDING_INTEGRITY_TESTS(TEST)                                                                              \
  TEST(kRepeatedImage, "repeated_image", TestStep::kPair, OnFailure::kPairLeftOut, TestLimit::fixed(0), "–",           \
       "an image with the one before, bit by bit: sensors have noise, a frozen camera or driver has none",             \
       "pair left out")                                                                                                \
  TEST(kPhotometric, "photometric", TestStep::kPair, OnFailure::kReported, TestLimit::fixed(1), "1",                   \
       "share of the image blocks that look alike left and right and lie on one plane (after direct refinement); on "  \
       "real streets a tenth of them is enough, so that no share is a limit",                                          \
       "reported")                                                                                                     \
  TEST(kRowAgreement, "row_agreement", TestStep::kPair, OnFailure::kPairLeftOut, TestLimit::fixed(0.5), "1",           \
       "share of the matches along the rows that are found again when they may move across the rows as well: at "      \
       "least half; matches of scenes that are not the same mostly are not",                                           \
       "pair left out")                                                                                                \
  TEST(kRigRotation, "rig_rotation", TestStep::kPair, OnFailure::kPairLeftOut, TestLimit::chiSquare(), "rad",          \
       "pitch and roll of the right camera by the vertical disparities of the pair, with the two seconds before",      \
       "pair left out")                                                                                                \
  TEST(kBaselineDirection, "baseline_direction", TestStep::kPair, OnFailure::kPairLeftOut, TestLimit::chiSquare(),     \
       "rad",                                                                                                          \
       "direction from the left to the right camera by the vertical disparities of the pair, with the calibrated "     \
       "one: images have that one which were taken at the same time (or with the skew that their stamps tell), "       \
       "through lenses as calibrated",                                                                                 \
       "pair left out")                                                                                                \
  TEST(kStandstill, "standstill", TestStep::kPair, OnFailure::kPairLeftOut, TestLimit::chiSquare(), "m",               \
       "way since the pair before with the least that the speed before allows, less `max_deceleration` (3 m/s²): a "   \
       "picture that stands still while the aircraft cannot",                                                          \
       "pair left out")                                                                                                \
  TEST(kVelocity, "velocity", TestStep::kPair, OnFailure::kAngleDoubted, TestLimit::chiSquare(), "m/s",                \
       "way since the pair before, as a vector, with the velocity on those before that; random accelerations of "      \
       "half a g, and while steps contradict what 1 g makes of it: an aircraft's way does not become a period of a "   \
       "pattern longer, nor does it lead to the other camera or backwards",                                            \
       "approach angle as uncertain as it changes by that; no velocity by this step")                                  \
  TEST(kTilt, "tilt", TestStep::kGround, OnFailure::kPairLeftOut, TestLimit::fixed(AttitudeFilter::kGate.squared()), "rad",      \
       "ground normal of the pair, with the pairs before and the rotation since (5 σ); needs `average_attitude`",      \
       "pair left out")                                                                                                \
  TEST(kVanishingPoint, "vanishing_point", TestStep::kPair, OnFailure::kSourceLeftOut, TestLimit::chiSquare(), "rad",  \
       "disparity of the stereo plane at the runway's vanishing point, which lies on the horizon and must have none",  \
       "vanishing point left out (`vanishing_point_gate`)")                                                            \
  TEST(kMotionNormal, "motion_normal", TestStep::kPair, OnFailure::kSourceLeftOut, TestLimit::chiSquare(), "rad",      \
       "ground normal of the pair by stereo alone, with the one that the motion in the left image asks for",           \
       "left out of the plane by its own gate; no vertical speed by the motion")                                       \
  TEST(kImu, "imu", TestStep::kPair, OnFailure::kReported, TestLimit::chiSquare(), "rad",                              \
       "ground normal of the pair by stereo alone, with the direction of gravity by the imu; the runway's slope is "   \
       "in the variance",                                                                                              \
       "reported (and left out of the height by its own gate)")                                                        \
  TEST(kImageRegions, "image_regions", TestStep::kPair, OnFailure::kPairLeftOut, TestLimit::chiSquare(), "m",           \
       "height of the pair with that from the points outside of the near, middle and far third, left and right half",  \
       "pair left out")                                                                                                \
  TEST(kRunwayWidth, "runway_width", TestStep::kPair, OnFailure::kReported, TestLimit::chiSquare(), "m",               \
       "height by the runway's width (known or learned, of the edges that it was learned from) with that by stereo",   \
       "reported")                                                                                                     \
  TEST(kInnovation, "innovation", TestStep::kTrack, OnFailure::kPairLeftOut, TestLimit::squaredGate(), "m",            \
       "height of the pair with the filter's prediction: an outlier is beyond `gate`",                                 \
       "pair left out")                                                                                                \
  TEST(kSinkRate, "sink_rate", TestStep::kMemory, OnFailure::kNoHeight, TestLimit::chiSquare(), "m",                   \
       "published height with the one of 0.5 s to 1 s ago carried on by the motion, which needs no stereo",            \
       "height not valid")
// clang-format on

enum class IntegrityTest {
#define UAV_LANDING_ENUMERATOR(code, ...) code,
  UAV_LANDING_INTEGRITY_TESTS(UAV_LANDING_ENUMERATOR)
#undef UAV_LANDING_ENUMERATOR
};

struct TestDescription {
  IntegrityTest test;
  const char* name;  ///< as in messages and files
  TestStep step;
  OnFailure on_failure;
  TestLimit limit;
  const char *unit, *compares, *consequence;
};

constexpr TestDescription kTestCatalogue[] = {
#define UAV_LANDING_DESCRIPTION(code, ...) {IntegrityTest::code, __VA_ARGS__},
    UAV_LANDING_INTEGRITY_TESTS(UAV_LANDING_DESCRIPTION)
#undef UAV_LANDING_DESCRIPTION
};
constexpr int kIntegrityTests = sizeof(kTestCatalogue) / sizeof(TestDescription);

constexpr const TestDescription& descriptionOf(IntegrityTest test) {
  return kTestCatalogue[static_cast<int>(test)];
}
/// For example "tilt".
constexpr const char* toString(IntegrityTest test) { return descriptionOf(test).name; }

}  // namespace uav_landing
