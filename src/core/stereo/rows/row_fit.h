#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "estimation/convergence.h"
#include "estimation/robust.h"
#include "image/input/image_cells.h"
#include "uav_landing/base/failure.h"
#include "uav_landing/geometry/calibration.h"

/// Robust fit of what moves the rows of the right image. The N parameters are its rotation (3) and, with N =
/// 5, the direction of the baseline (2).
namespace uav_landing::row_fit {

struct RowShift {
  Eigen::Matrix<double, 1, 5> by;  ///< derivatives by the parameters, pixels per rad
  double shift, stddev;            ///< pixels
  double below_centre;             ///< row in the image below its centre, pixels
  int cell;                        ///< cell of the image (image_cells.h)
};

template <int N>
struct RowFit {
  Eigen::Matrix<double, N, 1> value;  ///< rad
  Eigen::Matrix<double, N, N> covariance;
  int count = 0;                ///< rows that are no outliers
  std::vector<double> weights;  ///< per row, by its residual after the fit
};

template <int N>
double residualOf(const RowShift& row, const Eigen::Matrix<double, N, 1>& value) {
  return row.shift - row.by.head<N>().dot(value);
}

/// Robust size of the residuals as a multiple of the claimed stddevs, at least 1.
template <int N>
double residualScale(const std::vector<RowShift>& rows, const Eigen::Matrix<double, N, 1>& value) {
  std::vector<double> ratios;
  ratios.reserve(rows.size());
  for (const RowShift& row : rows) ratios.push_back(std::abs(residualOf<N>(row, value)) / row.stddev);
  return std::max(1.0, robustStddev(ratios));
}

/// Weight of a row by Tukey's function of its residual; 0 for outliers.
template <int N>
double weightOf(const RowShift& row, const Eigen::Matrix<double, N, 1>& value, double scale) {
  const double stddev = scale * row.stddev;
  const double root = tukeyRoot(residualOf<N>(row, value) / (TukeyEnd::kDisparity * stddev));
  return root * root / (stddev * stddev);
}

/// Addition to the covariance, because neighbouring rows share errors.
template <int N>
Eigen::Matrix<double, N, N> sharedVariance(const std::vector<RowShift>& rows, const RowFit<N>& fit) {
  ClusterCovariance<N> clusters;
  for (size_t i = 0; i < rows.size(); ++i) {
    const double weighted = fit.weights[i] * residualOf<N>(rows[i], fit.value);
    clusters.add(rows[i].cell, weighted * fit.covariance * rows[i].by.head<N>().transpose());
  }
  return clusters.shared();
}

/// Addition to the covariance by an error of 1 sigma (pixels) that all rows in a cell of the image share.
/// Cells are independent. Residuals do not show this error where the fit absorbs it.
template <int N>
Eigen::Matrix<double, N, N> commonVariance(const std::vector<RowShift>& rows, const RowFit<N>& fit,
                                           double sigma) {
  using Vector = Eigen::Matrix<double, N, 1>;
  std::array<Vector, kImageCells> sums;
  sums.fill(Vector::Zero());
  for (size_t i = 0; i < rows.size(); ++i)
    sums[rows[i].cell] += fit.weights[i] * rows[i].by.head<N>().transpose();
  Eigen::Matrix<double, N, N> common = Eigen::Matrix<double, N, N>::Zero();
  for (const Vector& sum : sums) {
    const Vector moved = sigma * fit.covariance * sum;
    common += moved * moved.transpose();
  }
  return common;
}

/// The same for the focal length of the right camera, which may be wrong by a share of 1 sigma. It moves rows
/// in proportion to their distance from the centre.
template <int N>
Eigen::Matrix<double, N, N> focalVariance(const std::vector<RowShift>& rows, const RowFit<N>& fit,
                                          double sigma) {
  Eigen::Matrix<double, N, 1> sum = Eigen::Matrix<double, N, 1>::Zero();
  for (size_t i = 0; i < rows.size(); ++i)
    sum += fit.weights[i] * rows[i].below_centre * rows[i].by.head<N>().transpose();
  const Eigen::Matrix<double, N, 1> moved = sigma * fit.covariance * sum;
  return moved * moved.transpose();
}

template <int N>
Expected<RowFit<N>> fitRows(const std::vector<RowShift>& rows) {
  using Matrix = Eigen::Matrix<double, N, N>;
  constexpr int kIterations = 6, kFewest = 20;
  // Prior stddev of a component that the corners do not determine because they are not on all sides, rad.
  constexpr double kAnything = 0.1, kAnyBaseline = 10;
  const auto few = [](int count) {
    return tl::make_unexpected(Failure{Reason::kTooFewMatches, std::to_string(count) + " rows, at least " +
                                                                   std::to_string(kFewest) + " needed"});
  };
  if (static_cast<int>(rows.size()) < kFewest) return few(static_cast<int>(rows.size()));
  Eigen::Matrix<double, 5, 1> loose;
  loose << Eigen::Vector3d::Constant(kAnything), Eigen::Vector2d::Constant(kAnyBaseline);
  const Matrix prior = loose.head<N>().array().square().inverse().matrix().asDiagonal();
  // The median row shift is the start, so that outliers show.
  std::vector<double> shifts;
  for (const RowShift& row : rows) shifts.push_back(row.shift / row.by[0]);
  RowFit<N> fit;
  fit.value.setZero();
  fit.value[0] = medianOf(shifts);
  Convergence convergence;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    const double scale = residualScale<N>(rows, fit.value);
    Matrix information = prior;
    Eigen::Matrix<double, N, 1> right = Eigen::Matrix<double, N, 1>::Zero();
    fit.count = 0;
    for (const RowShift& row : rows) {
      const double weight = weightOf<N>(row, fit.value, scale);
      if (weight == 0) continue;
      const auto by = row.by.head<N>();
      information += weight * by.transpose() * by;
      right += weight * by.transpose() * row.shift;
      ++fit.count;
    }
    if (fit.count < kFewest) return few(fit.count);
    fit.covariance = information.inverse();
    const Eigen::Matrix<double, N, 1> before = fit.value;
    fit.value = fit.covariance * right;
    if (convergence.reached<N>(fit.value - before, information)) break;
  }
  const double scale = residualScale<N>(rows, fit.value);
  fit.weights.reserve(rows.size());
  for (const RowShift& row : rows) fit.weights.push_back(weightOf<N>(row, fit.value, scale));
  return fit;
}

}  // namespace uav_landing::row_fit
