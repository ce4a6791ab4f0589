#include "uav_landing/results/stage_results.h"

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

double LandingResult::speedVariance() const {
  return velocity.dot(twist_covariance.topLeftCorner<3, 3>() * velocity) / velocity.squaredNorm();
}

}  // namespace uav_landing
