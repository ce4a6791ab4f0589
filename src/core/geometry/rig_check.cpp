#include "uav_landing/geometry/rig_check.h"

#include <array>
#include <cmath>
#include <utility>

#include "base/text.h"

namespace uav_landing {
namespace {

constexpr double kWarnedShare = 0.5;  // share of the largest offset from which on it warns
constexpr const char* kSizeQuestion = "is this the calibration of another image size?";
constexpr const char* kLeft = "left ";
constexpr const char* kRight = "right ";

/// One coordinate of the principal point, in full-resolution pixels.
struct Coordinate {
  const char* field;
  const char* side;
  const char* extent;
  double value;
  int size;  // of the image

  double middle() const { return 0.5 * size; }
  /// Distance from the middle, as a share of the image's size.
  double offset() const { return std::abs(value - middle()) / size; }
};

std::array<Coordinate, 2> principalPoint(const CameraCalibration& calibration) {
  return {Coordinate{"K[2]", "width", "wide", calibration.K(0, 2), calibration.width},
          Coordinate{"K[5]", "height", "high", calibration.K(1, 2), calibration.height}};
}

std::string baselineQuestion(const std::string& of_baseline) {
  return of_baseline + ": is right P[3] in metres (-fx times the baseline)?";
}

std::string baselineText(const StereoRig& rig) { return "baseline " + rounded(rig.baseline) + " m"; }

Failure checkBaseline(const StereoRig& rig, const RigParameters& limits) {
  if (rig.baseline <= limits.max_baseline) return {};
  return {Reason::kInputInvalid,
          baselineQuestion(baselineText(rig) + ", expected at most " + text(limits.max_baseline) + " m") +
              " If it is, raise rig/max_baseline"};
}

/// Warns of the coordinate that is farther off, as both have one cause.
void warnOfPrincipalPoint(const char* camera, const CameraCalibration& calibration,
                          const RigParameters& limits, std::vector<std::string>& warnings) {
  const auto [x, y] = principalPoint(calibration);
  const Coordinate& farther = y.offset() > x.offset() ? y : x;
  if (farther.offset() < kWarnedShare * limits.max_principal_point_offset) return;
  warnings.push_back(text(camera, farther.field, ": ", farther.value, ", ", rounded(100 * farther.offset()),
                          " % of the image's ", farther.side, " off its middle: ", kSizeQuestion));
}

}  // namespace

Failure checkPrincipalPoint(const CameraCalibration& calibration, const RigParameters& limits) {
  const double share = limits.max_principal_point_offset;
  for (const Coordinate& c : principalPoint(calibration))
    if (c.offset() > share)
      return {
          Reason::kInputInvalid,
          text(c.field, ": ", c.value, ", expected ", c.middle() - share * c.size, " to ",
               c.middle() + share * c.size, " in an image ", c.size, " px ", c.extent, ": ", kSizeQuestion,
               " If the image is cropped off the middle, raise rig/max_principal_point_offset")};
  return {};
}

Expected<StereoRig> makeStereoRig(const CameraCalibration& left, const CameraCalibration& right,
                                  const RigParameters& limits) {
  Expected<StereoRig> rig = makeStereoRig(left, right);
  if (!rig) return rig;
  for (const auto& [camera, calibration] : {std::pair(kLeft, &left), {kRight, &right}})
    if (Failure failure = checkPrincipalPoint(*calibration, limits)) {
      failure.detail = camera + failure.detail;
      return tl::unexpected(failure);
    }
  if (Failure failure = checkBaseline(*rig, limits)) return tl::unexpected(failure);
  return rig;
}

std::vector<std::string> rigWarnings(const CameraCalibration& left, const CameraCalibration& right,
                                     const RigParameters& limits) {
  std::vector<std::string> warnings;
  const Expected<StereoRig> rig = makeStereoRig(left, right, limits);
  if (!rig) return warnings;
  warnOfPrincipalPoint(kLeft, left, limits, warnings);
  warnOfPrincipalPoint(kRight, right, limits, warnings);
  if (rig->baseline < kShortestLikelyBaseline || rig->baseline > kLongestLikelyBaseline)
    warnings.push_back(baselineQuestion(baselineText(*rig)));
  return warnings;
}

}  // namespace uav_landing
