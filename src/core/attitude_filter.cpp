#include "uav_landing/attitude_filter.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "rotation.h"

namespace uav_landing {
namespace {

constexpr double kMemory = 1.0;          // s
constexpr double kStampRounding = 1e-3;  // s
constexpr double kPatience = 0.5;        // s, with normals that contradict
// 1 sigma by which the ground's own normal changes from pair to pair, because another part of it is seen. rad
constexpr double kUnevenness = 0.3 * M_PI / 180;

Eigen::Matrix2d symmetric(const Eigen::Matrix2d& m) { return 0.5 * (m + m.transpose()); }

}  // namespace

bool AttitudeFilter::predict(double stamp, const ApproachAngleResult::Motion& step) {
  if (!estimate_ || step.failure || !step.rotation.allFinite() || !step.covariance.allFinite()) return false;
  // A step that spans another time is not the way from the last normal to this one.
  if (!(std::abs(stamp - stamp_ - step.duration) <= kStampRounding)) return false;
  const Eigen::Matrix3d R = rotationMatrix(step.rotation);
  estimate_->normal = R * estimate_->normal;
  const Eigen::Matrix3d by_rotation = crossMatrix(estimate_->normal);
  estimate_->covariance = std::exp(step.duration / kMemory) * R * estimate_->covariance * R.transpose() +
                          by_rotation * step.covariance.topLeftCorner<3, 3>() * by_rotation.transpose();
  return true;
}

AttitudeFilter::Estimate AttitudeFilter::update(double stamp, const Eigen::Vector3d& normal,
                                                const Eigen::Matrix3d& covariance,
                                                const ApproachAngleResult::Motion& step) {
  const bool predicted = predict(stamp, step);
  stamp_ = stamp;
  if (predicted) {
    const Eigen::Matrix<double, 3, 2> basis = tangents(estimate_->normal);
    const Eigen::Matrix2d P = symmetric(basis.transpose() * estimate_->covariance * basis);
    const Eigen::Vector2d innovation = basis.transpose() * (normal - estimate_->normal);
    const Eigen::Matrix2d measured = symmetric(basis.transpose() * covariance * basis), S = P + measured;
    const Eigen::Matrix2d allowed = S + kUnevenness * kUnevenness * Eigen::Matrix2d::Identity();
    estimate_->ratio = innovation.dot(allowed.inverse() * innovation);
    estimate_->agrees = estimate_->ratio <= kGate;
    if (estimate_->agrees) {
      agreed_ = stamp;
      const Eigen::Matrix2d gain = P * S.inverse();
      estimate_->normal = (estimate_->normal + basis * (gain * innovation)).normalized();
      // Joseph's form: the short one loses its symmetry over hundreds of pairs, and then its sign.
      const Eigen::Matrix2d kept = Eigen::Matrix2d::Identity() - gain;
      const Eigen::Matrix2d joint = kept * P * kept.transpose() + gain * measured * gain.transpose();
      estimate_->covariance = basis * joint * basis.transpose();
      return *estimate_;
    }
    if (stamp - agreed_ < kPatience) return *estimate_;
  }
  agreed_ = stamp;
  estimate_ = Estimate{normal, covariance, kUnknown, true};
  return *estimate_;
}

}  // namespace uav_landing
