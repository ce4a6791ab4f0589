#pragma once

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>

#include "uav_landing/geometry/calibration.h"

/// Cells of the image, parts in which errors are alike. Residuals of a lens, and of a surface that is not the
/// plane, are the same there. They move together what is fitted to points all over the image.
namespace uav_landing {

constexpr int kCellsAcross = 4, kCellsDown = 3, kImageCells = kCellsAcross * kCellsDown;

inline int imageCell(const StereoRig& rig, double u, double v) {
  const auto part = [](double at, int size, int parts) {
    return std::clamp(static_cast<int>(at * parts / size), 0, parts - 1);
  };
  return part(v, rig.size.height, kCellsDown) * kCellsAcross + part(u, rig.size.width, kCellsAcross);
}

/// Addition to the covariance of a fit that took points as independent, although neighbours share errors. It
/// follows the sandwich estimator with clusters (Liang, Zeger 1986), but only products of different points
/// count. Sums that are negative by chance count as zero. With few cells and many unknowns it is too small.
template <int N>
class ClusterCovariance {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;
  ClusterCovariance() { sums_.fill(Vector::Zero()); }

  /// influence: change of the fitted values by the residual of one point.
  void add(int cell, const Vector& influence) {
    sums_[cell] += influence;
    own_ += influence * influence.transpose();
  }
  Matrix shared() const {
    Matrix shared = -own_;
    for (const Vector& sum : sums_) shared += sum * sum.transpose();
    const Eigen::SelfAdjointEigenSolver<Matrix> axes(shared);
    return axes.eigenvectors() * axes.eigenvalues().cwiseMax(0).asDiagonal() *
           axes.eigenvectors().transpose();
  }

 private:
  std::array<Vector, kImageCells> sums_;
  Matrix own_ = Matrix::Zero();
};

}  // namespace uav_landing
