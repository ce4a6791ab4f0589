#include "results/result_check.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "estimation/aircraft.h"
#include "geometry/bias_variance.h"
#include "geometry/ground_normal.h"

namespace uav_landing {
namespace {

// The range is wider than anything that flies. It is so narrow that no square or product of heights
// overflows.
constexpr double kLeastHeight = 1e-3, kLargestHeight = 1e5;  // m
// Smallest cosine of the ground's tilt in the image: no ground rises like a wall.
constexpr double kSteepest = 0.17;
constexpr double kLargestRatio = 1e4;  // lengths over the height: runways are that long, steps are not
constexpr double kShortestStep = 1e-4, kLongestStep = 3600;  // s
constexpr double kLargestSkew = 0.1;                         // s, largest value of max_skew
// Largest variance, in squares of the units below. Larger ones only say "unknown" in numbers.
constexpr double kLargestVariance = 1e9;
constexpr double kLeastRelative = 1e-6;  // 1 sigma over the value: no camera sees better
constexpr double kRounding = 1e-6;       // error of covariances that were calculated
constexpr size_t kMostPoints = 100000;

constexpr double kLongestReadout = 1;  // s

bool within(double value, double limit) { return std::abs(value) <= limit; }  // false for NaN

bool isVariance(double value) { return value > 0 && value <= kLargestVariance; }

/// Whether the matrix is symmetric, has no negative direction, and is not all zero.
template <int kSize>
bool isCovariance(const Eigen::Matrix<double, kSize, kSize>& matrix) {
  const double size = matrix.trace();
  if (!matrix.allFinite() || !isVariance(size)) return false;
  if ((matrix - matrix.transpose()).cwiseAbs().maxCoeff() > kRounding * size) return false;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, kSize, kSize>> solver(matrix,
                                                                                  Eigen::EigenvaluesOnly);
  return solver.eigenvalues()[0] >= -kRounding * size;
}

/// Whether share is zero, or a covariance that is contained in the other one.
bool isShare(const Eigen::Matrix3d& share, const Eigen::Matrix3d& whole) {
  if (share.isZero(0)) return true;
  return isCovariance<3>(share) &&
         (share.diagonal().array() <= (1 + kRounding) * whole.diagonal().array()).all();
}

/// Whether it is a unit vector with its covariance.
bool isDirection(const Eigen::Vector3d& direction, const Eigen::Matrix3d& covariance) {
  return within(direction.norm() - 1, kUnitRounding) && isCovariance<3>(covariance) &&
         covariance.trace() >= kLeastRelative * kLeastRelative;
}

/// Whether rows that do not match can show this rotation of the right camera. The rows of larger rotations
/// are never found.
bool isRotation(const RigRotation& rotation) {
  constexpr double kLargest = 0.2, kLargestYaw = 1, kLeastStddev = 1e-6;  // rad; rows hardly show a yaw
  return rotation.w.allFinite() && within(rotation.w.x(), kLargest) && within(rotation.w.z(), kLargest) &&
         within(rotation.w.y(), kLargestYaw) && isCovariance<3>(rotation.covariance) &&
         rotation.covariance.diagonal().minCoeff() >= kLeastStddev * kLeastStddev;
}

/// Whether the right camera can be there. The limit is far beyond the place of any camera that sees the same
/// scene.
bool isBaseline(const BaselineDirection& baseline) {
  constexpr double kLargest = 100;  // baselines
  return within(baseline.t.norm(), kLargest) && isCovariance<2>(baseline.covariance);
}

/// Makes both unknown unless they are a direction.
void keepDirection(Eigen::Vector3d& direction, Eigen::Matrix3d& covariance) {
  if (isDirection(direction, covariance)) return;
  direction.setConstant(kUnknown);
  covariance.setConstant(kUnknown);
}

/// Makes the numbers of a failed motion unknown. A camera that hardly moves is an exception: its rotation is
/// known even though the angle is not.
void keepMotion(ApproachAngleResult::Motion& motion) {
  const bool measured = !motion.failure || motion.failure.reason == Reason::kNoMotion;
  const bool possible =
      measured && motion.rotation.norm() <= std::min(M_PI, aircraft::kFastestTurnRate * motion.duration) &&
      motion.translation_over_height.norm() <= kLargestRatio && motion.duration >= kShortestStep &&
      motion.duration <= kLongestStep && isCovariance<6>(motion.covariance) &&
      motion.covariance.diagonal().minCoeff() > 0;  // nothing that is measured is exact
  if (!possible) {
    motion.duration = kUnknown;
    motion.rotation.setConstant(kUnknown);
    motion.translation_over_height.setConstant(kUnknown);
    motion.turn_rate.setConstant(kUnknown);
    motion.covariance.setConstant(kUnknown);
  }
  if (!(motion.turn_rate.norm() <= aircraft::kFastestTurnRate)) motion.turn_rate.setConstant(kUnknown);
  if (motion.failure || !within(motion.angle, M_PI / 2) || !isVariance(motion.angle_variance))
    motion.angle = motion.angle_variance = kUnknown;
  if (motion.failure || !(motion.row_motion >= 0 && motion.row_motion <= M_PI) ||
      !(motion.row_motion_limit > 0))
    motion.row_motion = motion.row_motion_limit = kUnknown;
  if (!possible) motion.normal.setConstant(kUnknown);
  keepDirection(motion.normal, motion.normal_covariance);
}

bool isReadout(const ReadoutEstimate& readout) {
  const bool global = readout.time == 0 && readout.variance == 0;
  return global || (within(readout.time, kLongestReadout) && readout.variance > 0 &&
                    readout.variance <= kLongestReadout * kLongestReadout);
}

void keepByTurns(ApproachAngleResult::PlaneByTurns& by_turns) {
  constexpr double kLargest = 1;  // 1/m
  const bool possible = by_turns.mean.norm() <= kLargest &&
                        (by_turns.covariance.isZero(0) || isCovariance<3>(by_turns.covariance));
  if (!possible) by_turns = {};
}

void keepImu(AttitudePrior& imu) {
  keepDirection(imu.normal, imu.normal_covariance);
  const bool possible = imu.rotation.norm() <= M_PI && imu.duration >= kShortestStep &&
                        imu.duration <= kLongestStep && isCovariance<3>(imu.rotation_covariance);
  if (possible) return;
  imu.duration = kUnknown;
  imu.rotation.setConstant(kUnknown);
  imu.rotation_covariance.setConstant(kUnknown);
}

void keepRunway(ApproachAngleResult::Runway& runway) {
  const auto isLength = [](double value, double variance) {
    return within(value, kLargestRatio) && isVariance(variance);
  };
  const auto refuse = [](const char* field, Failure& failure) {
    if (!failure) failure = {Reason::kInputInvalid, text("runway.", field, ": not a length with a variance")};
  };
  if (!isLength(runway.y, runway.y_variance)) {
    runway.y = runway.y_variance = kUnknown;
    refuse("y", runway.failure);
  }
  for (CentreSolutions::Solution& solution : runway.y_without.without)
    if (!isLength(solution.value, solution.variance)) solution = {};
  if (!isLength(runway.width, runway.width_variance) || runway.width <= 0)
    runway.width = runway.width_variance = kUnknown;
  const bool is_part = runway.x_systematic_variance >= 0 && runway.x_systematic_variance <= runway.x_variance;
  if (!isLength(runway.x, runway.x_variance) || !is_part) {
    runway.x = runway.x_variance = kUnknown;
    runway.x_systematic_variance = 0;
    refuse("x", runway.threshold_failure);
  }
}

void keepSight(ApproachAngleResult::Sight& sight) {
  constexpr double kFarthest = 1e5;  // m
  const auto isKnown = [](double value, double variance) {
    return within(value, kFarthest) && isVariance(variance);
  };
  const auto keep = [&](double& value, double& variance) {
    if (!isKnown(value, variance)) value = variance = kUnknown;
  };
  keep(sight.yaw, sight.yaw_variance);
  keep(sight.width, sight.width_variance);
  keep(sight.length, sight.length_variance);
  keep(sight.size_over_chart, sight.size_over_chart_variance);
  keep(sight.disparity, sight.disparity_variance);
  for (double* effect : {&sight.height_by_chart, &sight.height_by_bias})
    if (!(*effect >= 0 && *effect <= kFarthest)) *effect = kUnknown;
  for (int i = 0; i < 3; ++i) keep(sight.height_without[i], sight.variance_without[i]);
  const Eigen::Vector3d& p = sight.position;
  if (p.allFinite() && p.cwiseAbs().maxCoeff() <= kFarthest && isCovariance<3>(sight.covariance)) return;
  sight.position.setConstant(kUnknown);
  sight.covariance.setConstant(kUnknown);
  if (!sight.failure)
    sight.failure = {Reason::kInputInvalid, "sight.position: not a position with a covariance"};
}

/// Returns the field that makes the plane useless, with the reason; "" when there is none.
std::string problemOfPlane(const StereoRig& rig, const StereoDepthResult& result) {
  const Eigen::Vector3d& g = result.plane.g;
  const double size = g.norm();
  if (!(size >= 1 / kLargestHeight && size <= 1 / kLeastHeight && g.y() > kSteepest * size))
    return text("plane: ", g.x(), ", ", g.y(), ", ", g.z(), " is no ground below the camera");
  if (!isCovariance<3>(result.plane.covariance) ||
      !(result.plane.covariance.trace() >= std::pow(kLeastRelative * size, 2)))
    return "plane_covariance: not a covariance of this plane";
  if (!isShare(result.row_covariance, result.plane.covariance))
    return "plane_row_covariance: not a part of plane_covariance";
  // No plane changes by many times itself within a readout. Its components may be hardly distinguishable.
  constexpr double kLargestByRate = 100 * kLongestReadout, kLargestRate = 100;
  if (!result.plane_by_rate.allFinite() || result.plane_by_rate.cwiseAbs().maxCoeff() > kLargestByRate)
    return text("plane_by_rate: finite numbers up to ", kLargestByRate, " s expected");
  if (!(result.plane_rate.norm() <= kLargestRate * size))
    return text("plane_rate: not the rate of this plane");
  const double bias = biasVariance(rig, result.disparity_bias_stddev);
  const double with_bias = result.plane.covariance(2, 2);
  if (!(result.disparity_bias_stddev >= 0 && bias <= with_bias * (1 + kRounding)))
    return text("disparity_bias_stddev: ", result.disparity_bias_stddev,
                " px is not part of plane_covariance");
  constexpr double kLargestRowBias = 10;
  if (!(result.row_bias_stddev >= 0 && result.row_bias_stddev <= kLargestRowBias))
    return text("row_bias_stddev: ", result.row_bias_stddev, " px, 0 to ", kLargestRowBias, " expected");
  if (!std::isnan(result.lasting_share) && !(result.lasting_share > 0 && result.lasting_share <= 1))
    return text("plane_lasting_share: ", result.lasting_share, ", at most 1 expected");
  // An unbiased estimate of a variance may be negative because of noise, but not by much.
  constexpr double kLeastSurface = -1e-2, kLargestSurface = 1;
  const double surface = result.surface_variance * size * size;
  if (!std::isnan(surface) && !(surface >= kLeastSurface && surface <= kLargestSurface))
    return text("surface_variance: ", result.surface_variance, " m^2 at a height of ", 1 / size, " m");
  if (!result.below.g.array().isNaN().all()) {
    const double below = result.below.g.norm() / size;
    if (!(below > 0.5 && below < 2 && isCovariance<3>(result.below.covariance)))
      return "plane_below: no tangent of the surface that the plane is of";
  }
  if (!within(result.skew, kLargestSkew))
    return text("skew: ", result.skew, " s, at most ", kLargestSkew, " expected");
  if (result.points.size() > kMostPoints)
    return text("u: ", result.points.size(), " points, at most ", kMostPoints, " expected");
  return "";
}

}  // namespace

StereoDepthResult checked(const StereoRig& rig, const StereoDepthResult& result) {
  StereoDepthResult kept = result;
  const auto impossible = [&](const StereoDepthResult::Point& point) {
    return !(point.u >= 0 && point.u < rig.size.width && point.v >= 0 && point.v < rig.size.height &&
             within(point.disparity, 2 * rig.size.width) && isVariance(point.disparity_stddev));
  };
  if (kept.points.size() > kMostPoints) kept.points.clear();
  kept.points.erase(std::remove_if(kept.points.begin(), kept.points.end(), impossible), kept.points.end());
  if (!isRotation(kept.vertical_rotation)) kept.vertical_rotation = {};
  if (!isBaseline(kept.baseline_direction)) kept.baseline_direction = {};
  if (kept.failure) return kept;
  const std::string problem = problemOfPlane(rig, result);
  if (problem.empty()) return kept;
  kept.failure = {Reason::kInputInvalid, problem};
  kept.plane = {};
  return kept;
}

ApproachAngleResult checked(const ApproachAngleResult& result) {
  ApproachAngleResult kept = result;
  keepDirection(kept.vanishing_direction, kept.vanishing_covariance);
  keepDirection(kept.n_vp, kept.n_vp_covariance);
  keepDirection(kept.n, kept.n_covariance);
  keepMotion(kept.step);
  keepMotion(kept.window);
  keepRunway(kept.runway);
  keepSight(kept.sight);
  keepImu(kept.imu);
  if (!isReadout(kept.readout)) kept.readout = {};
  keepByTurns(kept.plane_by_turns);
  if (!(kept.other_runway_probability >= 0 && kept.other_runway_probability <= 1))
    kept.other_runway_probability = 1;
  if (!kept.foe.allFinite()) kept.foe.setConstant(kUnknown);
  return kept;
}

}  // namespace uav_landing
