#pragma once

#include "height/attitude_filter.h"

namespace uav_landing {

/// Phase of the landing estimate in which a test is made (stages/kalman_height_stage.cpp).
enum class TestStep { kGround, kPair, kTrack, kMemory };

/// The consequence of a failure.
enum class OnFailure {
  kReported,       ///< only reported
  kPairLeftOut,    ///< this pair gives no height
  kSourceLeftOut,  ///< this source is not used, the others are
  kAngleDoubted,   ///< the approach angle is less certain
  kNoHeight        ///< the published height is not valid
};

/// Limit of the squared normalised difference.
struct TestLimit {
  enum Kind { kChiSquare, kSquaredGate, kFixed } kind;
  double value;  ///< of kFixed

  /// Noise alone exceeds this limit with the probability false_alarm_rate.
  static constexpr TestLimit chiSquare() { return {kChiSquare, 0}; }
  /// The parameter gate, squared.
  static constexpr TestLimit squaredGate() { return {kSquaredGate, 0}; }
  static constexpr TestLimit fixed(double value) { return {kFixed, value}; }
};

/// All tests of integrity, in the order in which they are reported. A line has the name in the code, the name
/// for people, the phase, the consequence, the limit, the unit, what is compared, and the consequence in
/// words. A new test is a line here and a call in its phase. The enum, the messages, the diagnostics and
/// docs/integrity_tests.md are made from these lines.
// clang-format off
#define UAV_LANDING_INTEGRITY_TESTS(TEST)                                                                              \
  TEST(kRepeatedImage, "repeated_image", TestStep::kPair, OnFailure::kPairLeftOut, TestLimit::fixed(0), "–",           \
       "an image with the previous one, bit by bit: a real image has noise, so only a frozen camera or driver "        \
       "repeats it",                                                                                                   \
       "pair rejected")                                                                                                \
  TEST(kPhotometric, "photometric", TestStep::kPair, OnFailure::kReported, TestLimit::fixed(1), "1",                   \
       "share of the image blocks that look alike left and right and lie on one plane (after direct refinement). A "   \
       "tenth is enough on real streets, so there is no limit",                                                        \
       "reported")                                                                                                     \
  TEST(kRowAgreement, "row_agreement", TestStep::kPair, OnFailure::kPairLeftOut, TestLimit::fixed(0.5), "1",           \
       "share of the matches along the rows that are found again when they may leave the row: at least half. Matches " \
       "of different scenes mostly are not",                                                                           \
       "pair rejected")                                                                                                \
  TEST(kRigRotation, "rig_rotation", TestStep::kPair, OnFailure::kPairLeftOut, TestLimit::chiSquare(), "rad",          \
       "pitch and roll of the right camera from the pair's vertical disparities, with those of the last two seconds",  \
       "pair rejected")                                                                                                \
  TEST(kBaselineDirection, "baseline_direction", TestStep::kPair, OnFailure::kPairLeftOut, TestLimit::chiSquare(),     \
       "rad",                                                                                                          \
       "direction from the left to the right camera from the pair's vertical disparities, with the calibrated one. "   \
       "They agree if the images were taken at the same time (or with the skew that their stamps tell) and the "       \
       "lenses are as calibrated",                                                                                     \
       "pair rejected")                                                                                                \
  TEST(kStandstill, "standstill", TestStep::kPair, OnFailure::kPairLeftOut, TestLimit::chiSquare(), "m",               \
       "distance since the previous pair, with 30 % of the shortest distance that the speed before and "               \
       "`max_deceleration` allow. Images that stand still faster than an aircraft can brake are those of a frozen "    \
       "camera",                                                                                                       \
       "pair rejected")                                                                                                \
  TEST(kVelocity, "velocity", TestStep::kPair, OnFailure::kAngleDoubted, TestLimit::chiSquare(), "m/s",                \
       "velocity of the frame step, with that of the steps before. The aircraft may accelerate by half a g at "        \
       "random, and by 1 g as long as steps contradict. Finds steps that are one period of a pattern too long, lead "  \
       "to the other camera, or backwards",                                                                            \
       "approach angle as uncertain as this step changes it; no velocity by this step")                                \
  TEST(kRowMotion, "row_motion", TestStep::kPair, OnFailure::kAngleDoubted, TestLimit::fixed(1), "rad",                \
       "1 σ by which rows of a rolling shutter that move on their own, as vibration moves them, move the approach "    \
       "angle: at most a third of the angle's own 1 σ",                                                                \
       "approach angle not valid; the vertical speed by this motion counts for nothing. Where nothing is told of "    \
       "the shutter, its readout time is estimated from then on")                                                      \
  TEST(kTilt, "tilt", TestStep::kGround, OnFailure::kPairLeftOut, TestLimit::fixed(AttitudeFilter::kGate.squared()),   \
       "rad",                                                                                                          \
       "ground normal of the pair, with that of the pairs before, turned by the rotation since (5 σ); needs "          \
       "`average_attitude`",                                                                                           \
       "pair rejected")                                                                                                \
  TEST(kVanishingPoint, "vanishing_point", TestStep::kPair, OnFailure::kSourceLeftOut, TestLimit::chiSquare(), "rad",  \
       "disparity of the stereo plane at the runway's vanishing point: zero, as that point lies on the horizon",       \
       "vanishing point not used (`vanishing_point_gate`)")                                                            \
  TEST(kMotionNormal, "motion_normal", TestStep::kPair, OnFailure::kSourceLeftOut, TestLimit::chiSquare(), "rad",      \
       "ground normal of the pair by stereo alone, with the one that fits the motion in the left image",               \
       "not used for the plane, by its own gate; no vertical speed by the motion")                                     \
  TEST(kImu, "imu", TestStep::kPair, OnFailure::kReported, TestLimit::chiSquare(), "rad",                              \
       "ground normal of the pair by stereo alone, with the direction of gravity by the imu. The variance contains "   \
       "the runway's slope",                                                                                           \
       "reported (and not used for the height, by its own gate)")                                                      \
  TEST(kImageRegions, "image_regions", TestStep::kPair, OnFailure::kPairLeftOut, TestLimit::chiSquare(), "m",          \
       "height of the pair, with the height without the points of one region: near, middle or far third, left or "     \
       "right half",                                                                                                   \
       "pair rejected")                                                                                                \
  TEST(kRunwayWidth, "runway_width", TestStep::kPair, OnFailure::kReported, TestLimit::chiSquare(), "m",               \
       "height by the runway's width (known, or learned from the same edges), with the height by stereo",              \
       "reported")                                                                                                     \
  TEST(kInnovation, "innovation", TestStep::kTrack, OnFailure::kPairLeftOut, TestLimit::squaredGate(), "m",            \
       "height of the pair, with the filter's prediction. Beyond `gate` it is an outlier",                             \
       "pair rejected")                                                                                                \
  TEST(kSinkRate, "sink_rate", TestStep::kMemory, OnFailure::kNoHeight, TestLimit::chiSquare(), "m",                   \
       "published height, with that of 0.5 s to 1 s ago carried on by the motion, which needs no stereo",              \
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
