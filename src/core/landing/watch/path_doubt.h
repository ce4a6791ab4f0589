#pragma once

#include <vector>

#include "integrity/normal_doubt.h"
#include "integrity/pair_tests.h"
#include "integrity/vanishing_memory.h"
#include "landing/height/ground_estimate.h"
#include "landing/height/pair_input.h"

namespace uav_landing {

/// How far an approach angle is to be believed, as the ground may have another normal than it was measured
/// against: by the vanishing point, by the images' motion, by the rig, by the pairs before.
class PathDoubt {
 public:
  explicit PathDoubt(const KalmanHeightParameters& parameters);

  /// Variance of the angle of this motion by other normals, rad^2. Before update() it has the doubt of the
  /// pairs before alone.
  double variance(const PairInput& in, const Ground& ground, const ApproachAngleResult::Motion& motion) const;
  /// Not of a picture that came once more. tests: of the pair.
  void update(const PairInput& in, const Ground& ground, const PairTests& tests);

 private:
  /// One that the ground may have instead of that which the approach angle is measured against.
  struct OtherNormal {
    Eigen::Vector3d normal;
    Eigen::Matrix3d covariance;  // by which it is less certain than that, rad^2
    Eigen::Matrix3d by_noise;    // of the difference, as far as that is expected, rad^2
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

/// The normal that an angle of this motion is measured against: the one given with what the motion's own
/// adds.
GroundNormal normalOfAngle(const ApproachAngleResult& approach, const ApproachAngleResult::Motion& motion);

}  // namespace uav_landing
