#include "uav_landing/base/failure.h"

namespace uav_landing {

const char* toString(Reason reason) {
  switch (reason) {
    case Reason::kNone:
      return "";
    case Reason::kNotYet:
      return "not_yet";
    case Reason::kInputInvalid:
      return "input_invalid";
    case Reason::kUniformImage:
      return "uniform_image";
    case Reason::kTooFewFeatures:
      return "too_few_features";
    case Reason::kTooFewMatches:
      return "too_few_matches";
    case Reason::kNegativeDisparity:
      return "negative_disparity";
    case Reason::kNoPlane:
      return "no_plane";
    case Reason::kNoVanishingPoint:
      return "no_vanishing_point";
    case Reason::kNoRunway:
      return "no_runway";
    case Reason::kNoGroundNormal:
      return "no_ground_normal";
    case Reason::kNoMotion:
      return "no_motion";
    case Reason::kMotionInconsistent:
      return "motion_inconsistent";
    case Reason::kPlaneUnproven:
      return "plane_unproven";
    case Reason::kTimeJump:
      return "time_jump";
    case Reason::kRejected:
      return "rejected";
    case Reason::kTimeout:
      return "timeout";
    case Reason::kUncertain:
      return "uncertain";
    case Reason::kTransformMissing:
      return "transform_missing";
    case Reason::kTransformInvalid:
      return "transform_invalid";
    case Reason::kInconsistent:
      return "inconsistent";
    case Reason::kRigBent:
      return "rig_bent";
  }
  return "";
}

std::string Failure::message() const {
  const std::string name = toString(reason);
  return name.empty() || detail.empty() ? name : name + ": " + detail;
}

}  // namespace uav_landing
