#pragma once

#include <optional>
#include <vector>

#include "geometry/ground_normal.h"
#include "integrity/memory/vanishing_memory.h"
#include "integrity/tests/normal_doubt.h"
#include "integrity/tests/pair_tests.h"
#include "landing/height/ground_estimate.h"
#include "landing/height/pair_input.h"

namespace uav_landing {

/// Uncertainty of an approach angle because the ground may have another normal than the one used. Evidence
/// comes from the vanishing point, the motion in the images, the rig and the previous pairs.
class PathDoubt {
 public:
  explicit PathDoubt(const KalmanHeightParameters& parameters);

  /// Variance of this motion's angle from other possible normals, rad^2. Before update() it contains the
  /// doubt of the previous pairs only. Of a motion whose rows move on their own by more than its claim
  /// covers, nothing is known.
  double variance(const PairInput& in, const Ground& ground, const ApproachAngleResult::Motion& motion) const;
  /// Do not call it for a repeated image. tests: of this pair.
  void update(const PairInput& in, const Ground& ground, const PairTests& tests);

 private:
  /// A normal that the ground may have instead of the one in use.
  struct OtherNormal {
    Eigen::Vector3d normal;
    Eigen::Matrix3d covariance;  // excess over that of the normal in use, rad^2
    Eigen::Matrix3d by_noise;    // part of the difference that noise explains, rad^2
    double probability;
    double angleVariance(const Eigen::Vector3d& used, const ApproachAngleResult::Motion& motion) const;
  };
  std::vector<OtherNormal> otherNormals(const PairInput& in, const Ground& ground,
                                        const GroundNormal& used) const;
  void updateByVanishingPoint(const PairInput& in, const Ground& ground, const PairTests& tests);
  void updateByMotion(const PairInput& in, const PairTests& tests);

  bool rig_watch_;
  NormalDoubt by_vanishing_point_, by_motion_;
  VanishingMemory vanishing_;
};

/// Normal that an angle of this motion is measured against: the given one, averaged with the motion's own
/// normal when that is known.
std::optional<GroundNormal> normalOfAngle(const ApproachAngleResult& approach,
                                          const ApproachAngleResult::Motion& motion);

}  // namespace uav_landing
