#include "uav_landing/results/stage_results.h"

#include <cmath>

#include "base/text.h"

namespace uav_landing {

const char* toString(Status status) {
  switch (status) {
    case Status::kSearching:
      return "searching";
    case Status::kTracking:
      return "tracking";
    case Status::kCoasting:
      return "coasting";
    case Status::kLost:
      return "lost";
  }
  return "unknown";
}

const char* toString(HeightOrigin origin) {
  switch (origin) {
    case HeightOrigin::kNone:
      return "";
    case HeightOrigin::kStereo:
      return "stereo";
    case HeightOrigin::kWidth:
      return "width";
    case HeightOrigin::kGeometry:
      return "geometry";
    case HeightOrigin::kPrediction:
      return "prediction";
  }
  return "unknown";
}

void LandingResult::forgetVelocity() {
  velocity.setConstant(kUnknown);
  twist_covariance.topRows<3>().setConstant(kUnknown);
  twist_covariance.leftCols<3>().setConstant(kUnknown);
}

double LandingResult::speedVariance() const {
  return velocity.dot(twist_covariance.topLeftCorner<3, 3>() * velocity) / velocity.squaredNorm();
}

std::string adviceOn(const ReadoutEstimate& readout) {
  constexpr double kUseful = 0.005, kCertain = 3;  // s, sigmas
  const double stddev = std::sqrt(readout.variance);
  if (!(stddev <= kUseful) || !(std::abs(readout.time) > kCertain * stddev)) return "";
  return text("rows are read within ", std::round(readout.time * 1e3), " +- ", std::ceil(stddev * 1e3),
              " ms, one after the other: set rig/readout_time");
}

std::string adviceOnImu(const ApproachAngleResult& result) {
  if (!result.step.rowsMove() && !result.window.rowsMove()) return "";
  if (!result.imu.rows_failure) return "";
  return "within images, whose rows move: " + result.imu.rows_failure.message();
}

}  // namespace uav_landing
