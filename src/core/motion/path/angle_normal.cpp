#include "motion/path/angle_normal.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "lines/vanishing/vanishing_point.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180.0;
// Chi-square limit (1 degree of freedom, 1e-4) beyond which a vanishing point contradicts the stereo plane.
constexpr double kMaxVanishingNis = 15.1;

GroundPlane withDirection(const GroundPlane& plane, const std::optional<GroundDirection>& vanishing) {
  return vanishing ? fuseDirection(plane, *vanishing, kMaxVanishingNis, nullptr) : plane;
}

std::optional<AngleNormal> angleNormal(const std::optional<GroundNormal>& normal, const Failure& imu = {}) {
  if (!normal) return std::nullopt;
  return AngleNormal{*normal, imu};
}

/// Normal from the vanishing point: with the roll of the stereo plane when there is one, else that of the
/// paper's level rig.
std::optional<AngleNormal> byVanishingPoint(const NormalSources& sources) {
  const std::optional<GroundDirection>& vanishing = sources.vanishing;
  if (!vanishing) return std::nullopt;
  if (!sources.plane) return angleNormal(sources.level_rig);
  const std::optional<GroundNormal> seen = normalOf(*sources.plane);
  if (!seen) return std::nullopt;
  return angleNormal(normalFromVanishingPoint({vanishing->vector(), vanishing->covariance(), {}, 0},
                                              rollOf(seen->vector()),
                                              std::sqrt(rollVariance(seen->vector(), seen->covariance()))));
}

}  // namespace

std::optional<AngleNormal> findAngleNormal(const NormalSources& sources,
                                           const ApproachAngleParameters& parameters) {
  const AttitudePrior& imu = sources.imu;
  if (parameters.normal_source == NormalSource::kVanishingLine) return byVanishingPoint(sources);
  if (!sources.plane && !imu.hasNormal()) return byVanishingPoint(sources);
  // The normal of an imu acts as a plane at the height 1.
  if (!sources.plane)
    return angleNormal(normalOf(withDirection({imu.normal, imu.normal_covariance}, sources.vanishing)));
  Failure imu_failure;
  GroundPlane fused = withDirection(*sources.plane, sources.vanishing);
  if (imu.hasNormal()) {
    double nis = 0;
    fused = fuseNormal(fused, {imu.normal, imu.normal_covariance}, kMaxVanishingNis, &nis);
    if (!(nis <= kMaxVanishingNis)) {
      const double off = std::acos(std::clamp(fused.normal().dot(imu.normal), -1.0, 1.0));
      imu_failure = {Reason::kRejected,
                     text("the imu's attitude is ", rounded(off / kDegree), " deg off the ground ahead")};
    }
  }
  return angleNormal(normalOf(fused), imu_failure);
}

}  // namespace uav_landing
