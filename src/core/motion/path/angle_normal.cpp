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

GroundPlane withDirection(const GroundPlane& plane, const GroundDirection& vanishing) {
  if (!vanishing.direction.allFinite()) return plane;
  return fuseVanishingPoint(plane, vanishing.direction, vanishing.covariance, kMaxVanishingNis, nullptr);
}

GroundNormal normalOf(const GroundPlane& plane) { return {plane.normal(), plane.normalCovariance()}; }

/// Normal from the vanishing point: with the roll of the stereo plane when there is one, else that of the
/// paper's level rig.
std::optional<AngleNormal> byVanishingPoint(const NormalSources& sources) {
  const GroundDirection& vanishing = sources.vanishing;
  if (!vanishing.direction.allFinite()) return std::nullopt;
  if (!sources.plane) return AngleNormal{sources.level_rig, {}};
  const GroundNormal seen = normalOf(*sources.plane);
  return AngleNormal{
      normalFromVanishingPoint({vanishing.direction, vanishing.covariance, {}, 0}, rollOf(seen.n),
                               std::sqrt(rollVariance(seen.n, seen.covariance))),
      {}};
}

}  // namespace

std::optional<AngleNormal> findAngleNormal(const NormalSources& sources,
                                           const ApproachAngleParameters& parameters) {
  const AttitudePrior& imu = sources.imu;
  if (parameters.normal_source == NormalSource::kVanishingLine) return byVanishingPoint(sources);
  if (!sources.plane && !imu.hasNormal()) return byVanishingPoint(sources);
  // The normal of an imu acts as a plane at the height 1.
  if (!sources.plane)
    return AngleNormal{normalOf(withDirection({imu.normal, imu.normal_covariance}, sources.vanishing)), {}};
  AngleNormal found;
  GroundPlane fused = withDirection(*sources.plane, sources.vanishing);
  if (imu.hasNormal()) {
    double nis = 0;
    fused = fuseNormal(fused, {imu.normal, imu.normal_covariance}, kMaxVanishingNis, &nis);
    if (!(nis <= kMaxVanishingNis)) {
      const double off = std::acos(std::clamp(fused.normal().dot(imu.normal), -1.0, 1.0));
      found.imu_failure = {Reason::kRejected, text("the imu's attitude is ", rounded(off / kDegree),
                                                   " deg off the ground ahead")};
    }
  }
  found.normal = normalOf(fused);
  return found;
}

}  // namespace uav_landing
