#include "height/attitude_filter.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "estimation/aircraft.h"
#include "geometry/rotation.h"

namespace uav_landing {
namespace {

constexpr double kMemory = 1.0;    // s
constexpr double kPatience = 3.0;  // s, with normals that contradict
// A normal that others are measured by needs so many agreeing pairs in a row.
constexpr int kConfirmed = 3;
// Pairs for which a normal that agrees stays in doubt.
constexpr int kDoubtPairs = 4;
// 1 sigma of the change of the ground's own normal from pair to pair, because another part of it is seen,
// rad.
constexpr double kUnevenness = 0.3 * M_PI / 180;

/// Root of a covariance that may be negative by rounding.
Eigen::Matrix3d rootOf(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solved(covariance);
  const Eigen::Vector3d roots = solved.eigenvalues().cwiseMax(0).cwiseSqrt();
  return solved.eigenvectors() * roots.asDiagonal() * solved.eigenvectors().transpose();
}

double angleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

Eigen::Matrix2d symmetric(const Eigen::Matrix2d& m) { return 0.5 * (m + m.transpose()); }

/// Difference of a pair's normal from an estimate, in the tangent plane of the estimate.
struct Innovation {
  Eigen::Matrix<double, 3, 2> basis;
  Eigen::Matrix2d P, measured, S;  // covariances of the estimate, of the pair's normal, and their sum
  Eigen::Vector2d difference;
  double ratio;

  Innovation(const AttitudeFilter::Estimate& estimate, const Eigen::Vector3d& normal,
             const Eigen::Matrix3d& covariance)
      : basis(tangents(estimate.normal)) {
    P = symmetric(basis.transpose() * estimate.covariance * basis);
    difference = basis.transpose() * (normal - estimate.normal);
    measured = symmetric(basis.transpose() * covariance * basis);
    S = P + measured;
    const Eigen::Matrix2d allowed = S + kUnevenness * kUnevenness * Eigen::Matrix2d::Identity();
    ratio = difference.dot(allowed.inverse() * difference);
  }
};

/// Covariance of a normal when nobody knows how the camera turned during T (s).
Eigen::Matrix3d unknownTurn(double T, const Eigen::Vector3d& normal) {
  return std::pow(aircraft::kTurnRate * T, 2) * (Eigen::Matrix3d::Identity() - normal * normal.transpose());
}

/// Covariance of a normal after a step, by the errors of its rotation. It is at most that of an unknown turn:
/// with a step that claims to know less, any normal would agree.
Eigen::Matrix3d turnCovariance(double T, const Eigen::Vector3d& normal,
                               const ApproachAngleResult::Motion& step) {
  const Eigen::Matrix3d by_rotation = crossMatrix(normal);
  const Eigen::Matrix3d claimed =
      by_rotation * step.covariance.topLeftCorner<3, 3>() * by_rotation.transpose();
  const double most = std::pow(aircraft::kTurnRate * T, 2);
  if (claimed.trace() <= most) return claimed;
  if (!claimed.allFinite()) return unknownTurn(T, normal);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solved(claimed);
  const Eigen::Vector3d variances = solved.eigenvalues().cwiseMin(most);
  return solved.eigenvectors() * variances.asDiagonal() * solved.eigenvectors().transpose();
}

/// Turns the estimate by the step. The memory fades with each call.
void rotate(double T, const Eigen::Matrix3d& R, const ApproachAngleResult::Motion& step,
            AttitudeFilter::Estimate& estimate) {
  estimate.normal = R * estimate.normal;
  estimate.common_root = (R * estimate.common_root * R.transpose()).eval();
  const Eigen::Matrix3d by_turn = turnCovariance(T, estimate.normal, step);
  estimate.covariance = (std::exp(T / kMemory) * R * estimate.covariance * R.transpose()).eval() + by_turn;
  estimate.average_covariance = (R * estimate.average_covariance * R.transpose()).eval() + by_turn;
}

void addTurn(double T, AttitudeFilter::Estimate& estimate) {
  const Eigen::Matrix3d by_turn = unknownTurn(T, estimate.normal);
  estimate.covariance = std::exp(T / kMemory) * estimate.covariance + by_turn;
  estimate.average_covariance += by_turn;
}

}  // namespace

bool AttitudeFilter::tellsTurn(const ApproachAngleResult::Motion& step, double T) {
  return !step.failure && step.rotation.allFinite() && step.covariance.allFinite() &&
         std::abs(T - step.duration) <= kStampRounding;
}

AttitudeFilter::Prediction AttitudeFilter::predict(double stamp, const ApproachAngleResult::Motion& step) {
  const double T = stamp - stamp_;
  stamp_ = stamp;
  if (!estimate_ || !(T > 0)) return Prediction::kNone;
  if (other_ && --doubts_left_ < 0) other_.reset();
  turn_doubted_ = false;
  if (tellsTurn(step, T)) {
    turn(T, rotationMatrix(step.rotation), step);
    return Prediction::kTurned;
  }
  if (agreements_ < kConfirmed || T > kPatience) return Prediction::kNone;
  guess(T);
  return Prediction::kGuessed;
}

void AttitudeFilter::turn(double T, const Eigen::Matrix3d& R, const ApproachAngleResult::Motion& step) {
  const Eigen::Vector3d& n = estimate_->normal;
  turn_doubted_ = agreements_ >= kConfirmed && angleBetween(n, R * n) > aircraft::kUnusualTurnRate * T;
  if (turn_doubted_) {
    if (!other_) doubt(*estimate_, true);
    addTurn(T, *other_);
  } else if (other_) {
    rotate(T, R, step, *other_);
  }
  rotate(T, R, step, *estimate_);
}

void AttitudeFilter::guess(double T) {
  if (other_) addTurn(T, *other_);
  addTurn(T, *estimate_);
}

void AttitudeFilter::doubt(const Estimate& other, bool turn) {
  other_ = other;
  other_is_turn_ = turn;
  doubts_left_ = kDoubtPairs;
}

void AttitudeFilter::carry(double stamp, const ApproachAngleResult::Motion& step) {
  if (predict(stamp, step) == Prediction::kNone) reset();
}

void AttitudeFilter::reset() {
  estimate_.reset();
  other_.reset();
  turn_doubted_ = false;
  agreements_ = 0;
}

AttitudeFilter::Estimate AttitudeFilter::update(double stamp, const GroundNormal& seen,
                                                const ApproachAngleResult::Motion& step,
                                                const Eigen::Matrix3d& common, double fresh) {
  const Eigen::Vector3d& normal = seen.vector();
  const Eigen::Matrix3d& covariance = seen.covariance();
  Prediction predicted = predict(stamp, step);
  const Eigen::Matrix3d common_root = rootOf(common), of_pair = fresh * covariance;
  if (predicted == Prediction::kNone) return start(normal, covariance, common_root, of_pair);
  Innovation innovation(*estimate_, normal, covariance);
  bool denied = false;  // whether the turn in doubt was wrong
  if (other_) {
    const Innovation without(*other_, normal, covariance);
    const bool agrees = kGate.admitsRatio(innovation.ratio), other_agrees = kGate.admitsRatio(without.ratio);
    if (!agrees && other_agrees) {
      denied = other_is_turn_ || turn_doubted_;
      innovation = without;
      predicted = Prediction::kGuessed;
      std::swap(*estimate_, *other_);
      doubts_left_ = kDoubtPairs;
    }
    if (agrees) turn_doubted_ = false;
    if (denied || (other_is_turn_ && agrees != other_agrees)) other_.reset();
  }
  estimate_->ratio = innovation.ratio;
  estimate_->agrees = kGate.admitsRatio(estimate_->ratio);
  if (!estimate_->agrees) {
    // Start anew: nothing yet tells which of the two normals is the ground's, or the new one has persisted.
    if (agreements_ < kConfirmed || stamp - agreed_ >= kPatience)
      return start(normal, covariance, common_root, of_pair);
    return *estimate_;
  }
  agreed_ = stamp;
  agreements_ = std::min(agreements_ + 1, kConfirmed);
  const bool guessed = predicted == Prediction::kGuessed;
  const bool doubtful = (guessed && !denied) || innovation.ratio > kDoubtful.squared();
  if (doubtful && !other_ && agreements_ >= kConfirmed) doubt(*estimate_, false);
  if (guessed) {
    // A guessed turn is good enough to contradict a normal, but not to average with it.
    estimate_->normal = normal;
    estimate_->covariance = covariance;
    estimate_->common_root = common_root;
    estimate_->average_covariance = of_pair;
    return *estimate_;
  }
  const Eigen::Matrix<double, 3, 2>& basis = innovation.basis;
  const Eigen::Matrix2d gain = innovation.P * innovation.S.inverse();
  estimate_->normal = (estimate_->normal + basis * (gain * innovation.difference)).normalized();
  // Joseph's form, because the short form loses its symmetry over hundreds of pairs, and then its sign.
  const Eigen::Matrix2d kept = Eigen::Matrix2d::Identity() - gain;
  const auto joint = [&](const Eigen::Matrix2d& before, const Eigen::Matrix2d& measured) -> Eigen::Matrix3d {
    return basis * (kept * before * kept.transpose() + gain * measured * gain.transpose()) *
           basis.transpose();
  };
  const Eigen::Matrix2d average = symmetric(basis.transpose() * estimate_->average_covariance * basis);
  estimate_->covariance = joint(innovation.P, innovation.measured);
  estimate_->average_covariance = joint(average, fresh * innovation.measured);
  // Roots instead of covariances, because common errors add up with their sign.
  estimate_->common_root =
      basis * (kept * basis.transpose() * estimate_->common_root + gain * basis.transpose() * common_root);
  return *estimate_;
}

AttitudeFilter::Estimate AttitudeFilter::start(const Eigen::Vector3d& normal,
                                               const Eigen::Matrix3d& covariance,
                                               const Eigen::Matrix3d& common_root,
                                               const Eigen::Matrix3d& fresh) {
  other_.reset();
  agreed_ = stamp_;
  agreements_ = 1;
  estimate_ = Estimate{normal, covariance, common_root, fresh, kUnknown, true};
  return *estimate_;
}

}  // namespace uav_landing
