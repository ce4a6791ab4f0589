#pragma once

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>

#include "uav_landing/geometry/calibration.h"

/// Parts of the image in which errors are alike: residuals of a lens, or of surface that is not the plane,
/// are the same there, and pull together at what is fitted to points all over the image.
namespace uav_landing {

constexpr int kCellsAcross = 4, kCellsDown = 3, kImageCells = kCellsAcross * kCellsDown;

inline int imageCell(const StereoRig& rig, double u, double v) {
  const auto part = [](double at, int size, int parts) {
    return std::clamp(static_cast<int>(at * parts / size), 0, parts - 1);
  };
  return part(v, rig.size.height, kCellsDown) * kCellsAcross + part(u, rig.size.width, kCellsAcross);
}

/// What neighbouring points share adds to the covariance of a fit that took them as independent: after the
/// sandwich estimator with clusters (Liang, Zeger 1986), of which only the products of different points
/// count. By chance they are negative as often as positive.
template <int N>
class SharedPulls {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;
  SharedPulls() { sums_.fill(Vector::Zero()); }

  /// pull: of one point at the fit, its weighted residual times its derivatives.
  void add(int cell, const Vector& pull) {
    sums_[cell] += pull;
    own_ += pull * pull.transpose();
  }
  /// by: of what is fitted by the pulls. What is negative there counts for nothing.
  template <int M>
  Eigen::Matrix<double, M, M> variance(const Eigen::Matrix<double, M, N>& by) const {
    Matrix shared = -own_;
    for (const Vector& sum : sums_) shared += sum * sum.transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, M, M>> axes(by * shared * by.transpose());
    return axes.eigenvectors() * axes.eigenvalues().cwiseMax(0).asDiagonal() *
           axes.eigenvectors().transpose();
  }

 private:
  std::array<Vector, kImageCells> sums_;
  Matrix own_ = Matrix::Zero();
};

}  // namespace uav_landing
