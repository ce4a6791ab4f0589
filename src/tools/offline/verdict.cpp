#include "offline/verdict.h"

#include <algorithm>

#include "integrity/tests/test_catalogue.h"

namespace uav_landing {
namespace {

constexpr std::size_t kFewPairs = 10;  // fewer tell nothing of a recording

std::size_t countOf(const std::map<std::string, std::size_t>& counts, const std::string& name) {
  const auto found = counts.find(name);
  return found == counts.end() ? 0 : found->second;
}

/// Shares of the pairs.
class Shares {
 public:
  explicit Shares(const PairTally& tally) : tally_(tally) {}
  double of(std::size_t count) const {
    return static_cast<double>(count) / static_cast<double>(tally_.pairs);
  }
  double reason(Reason reason) const { return of(countOf(tally_.reasons, toString(reason))); }
  double test(IntegrityTest test) const { return of(countOf(tally_.failed_tests, toString(test))); }

 private:
  const PairTally& tally_;
};

std::string causeOf(const PairTally& tally) {
  const Shares share(tally);
  if (share.reason(Reason::kNegativeDisparity) > 0.3)
    return "left and right images are swapped, or the calibration was made with them swapped: give each "
           "camera its own topic (convert_recording bag … --left … --right …)";
  if (share.of(tally.alternating) > 0.6)
    return "every second image is black or uniform: exposure bracketing, or a lamp or projector that "
           "blinks; switch it off, or record the bright images alone";
  // Black images are also those of the pair before, bit by bit.
  if (share.reason(Reason::kUniformImage) > 0.3)
    return "images are black, saturated or uniform (" + tally.uniform +
           "): exposure, lens cap, a dead camera, or an encoding that is not what it says";
  const double repeating = share.test(IntegrityTest::kRepeatedImage);
  // If one camera alone repeats its images, it is frozen. If both do, they may just see nothing that moves.
  if (repeating > 0.3 && share.of(tally.repeating) > 0.5 * repeating)
    return "the images of both cameras come again, bit by bit: the cameras stand still and have no noise "
           "(a simulator), or the driver sends no new images";
  if (repeating > 0.3)
    return "images of one camera come twice, bit by bit: its driver repeats them, or hangs";
  if (share.test(IntegrityTest::kBaselineDirection) > 0.2)
    return "the images of a pair were not taken at the same time (test baseline_direction): the right "
           "images are late or early by some frames, their stamps are not those of the exposure, or there "
           "is no trigger. If the cameras are triggered and stamped well, one camera's focal length is "
           "wrong: calibrate again";
  if (share.test(IntegrityTest::kRowAgreement) + share.reason(Reason::kRigBent) > 0.3)
    return "the rows of left and right images do not belong together (test row_agreement): this is another "
           "rig's calibration, or a camera has turned since: calibrate again";
  if (share.test(IntegrityTest::kRowMotion) > 0.5)
    return "rows of the images move on their own (test row_motion): vibration with a rolling shutter. Mount "
           "the cameras softer, use global shutters, or record an inertial sensor of 200 Hz or more, and "
           "give "
           "rig/readout_time; heights are valid alone (column height_valid)";
  if (share.test(IntegrityTest::kSinkRate) + share.test(IntegrityTest::kMotionNormal) > 0.4)
    return "heights change otherwise than the motion says (tests motion_normal, sink_rate): a camera has "
           "turned sideways since the calibration: calibrate again";
  if (share.reason(Reason::kTooFewMatches) + share.reason(Reason::kTooFewFeatures) +
          share.reason(Reason::kNoPlane) >
      0.4)
    return "the images show hardly any texture or are blurred, the ground fills too little of them, or "
           "they are not aligned at all (calibration of another rig): look at the images of --report-data";
  if (share.reason(Reason::kNoMotion) > 0.5)
    return "the cameras stand still, or move too slowly for an approach angle: heights are valid alone "
           "(column height_valid)";
  return "";
}

}  // namespace

void PairTally::add(const ProcessedPair& pair) {
  const LandingResult& landing = pair.output.landing;
  const bool is_uniform = landing.failure.reason == Reason::kUniformImage;
  if (pairs > 0 && is_uniform != uniform_) ++alternating;
  uniform_ = is_uniform;
  if (is_uniform) uniform = landing.failure.detail;
  ++pairs;
  if (pair.output.stereo.left_repeated && pair.output.stereo.right_repeated) ++repeating;
  if (landing.valid())
    ++valid;
  else
    ++reasons[landing.failure ? toString(landing.failure.reason) : "no reason given"];
  for (const TestResult& test : landing.tests)
    if (test.failed()) ++failed_tests[test.name];
}

std::string verdictOf(const PairTally& tally) {
  if (tally.pairs < kFewPairs || 2 * tally.valid >= tally.pairs) return "";
  const std::string cause = causeOf(tally);
  if (!cause.empty()) return cause;
  const auto most = std::max_element(tally.reasons.begin(), tally.reasons.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  return "most pairs are " + most->first + ": see docs/troubleshooting.md";
}

}  // namespace uav_landing
