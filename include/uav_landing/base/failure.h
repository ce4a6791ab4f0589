#pragma once

#include <string>
#include <tl/expected.hpp>

namespace uav_landing {

/// Reasons for having no result. The names are part of the interface: they appear in messages.
enum class Reason {
  kNone,                ///< there is a result
  kNotYet,              ///< a second frame or a first estimate is needed
  kInputInvalid,        ///< the input cannot be used at all (size, calibration, stamp)
  kUniformImage,        ///< black, saturated or uniform image
  kTooFewFeatures,      ///< not enough corners or lines
  kTooFewMatches,       ///< corners found, but too few have a counterpart
  kNegativeDisparity,   ///< the scene lies behind the rig: left and right are swapped
  kNoPlane,             ///< matches do not agree on one ground plane
  kNoVanishingPoint,    ///< lines do not agree on one vanishing point
  kNoRunway,            ///< no edges or no threshold are certainly the runway's
  kNoGroundNormal,      ///< neither stereo nor a vanishing point gives the ground normal
  kNoMotion,            ///< standing still or too slow for a direction of motion
  kMotionInconsistent,  ///< temporal matches do not agree on one motion
  kPlaneUnproven,       ///< without stereo, too few corners move as those of one plane do
  kTimeJump,            ///< stamps went back or far ahead, or the clock was set; everything starts anew
  kRejected,            ///< a measurement failed the innovation gate
  kTimeout,             ///< no measurement for too long
  kUncertain,           ///< there is a number, but its variance is too large to fly with
  kTransformMissing,    ///< the lever arm from tf is not known (yet)
  kTransformInvalid,    ///< tf turns the aircraft as no aircraft flies: the axes of a frame are wrong
  kInconsistent,        ///< a test of the height's sources against each other failed; the detail names it
  kRigBent,             ///< the right camera has turned too far since the calibration
};

/// Name of a reason as it appears in messages, for example "too_few_matches"; "" for kNone.
const char* toString(Reason reason);

/// A named reason, with details for people (numbers, field names).
struct Failure {
  Reason reason = Reason::kNone;
  std::string detail;

  explicit operator bool() const { return reason != Reason::kNone; }
  /// "too_few_matches: 7 of at least 20", or "" when there is no failure.
  std::string message() const;
};

/// A value, or the reason for having none.
template <class T>
using Expected = tl::expected<T, Failure>;

}  // namespace uav_landing
