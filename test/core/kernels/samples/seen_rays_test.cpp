#include "kernels/samples/seen_rays.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "kernels/lanes/lanes.h"
#include "support/random_values.h"

namespace uav_landing {
namespace {

/// A view of rays as vectors and matrices.
struct View {
  Eigen::Matrix3d Q;
  Eigen::Vector3d t, n;
  double fx = 500, fy = 510, cx = 320, cy = 240;

  RayView numbers() const {
    RayView view{};
    const Eigen::Vector3d Qt = Q * t;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) view.Q[i][j] = Q(i, j);
      view.t[i] = t[i];
      view.n[i] = n[i];
      view.Qt[i] = Qt[i];
    }
    view.fx = fx;
    view.fy = fy;
    view.cx = cx;
    view.cy = cy;
    return view;
  }
  /// Turned from the left by a rotation vector, and moved.
  View changed(const Eigen::Matrix<double, 9, 1>& by) const {
    View view = *this;
    const double angle = by.head<3>().norm();
    if (angle > 0) view.Q = Eigen::AngleAxisd(angle, by.head<3>() / angle).toRotationMatrix() * Q;
    view.t += by.segment<3>(3);
    view.n += by.tail<3>();
    return view;
  }
};

View someView() {
  return {Eigen::AngleAxisd(0.02, Eigen::Vector3d(0.3, -0.8, 0.5).normalized()).toRotationMatrix(),
          {0.02, -0.05, 0.3},
          {0.05, 0.97, 0.2}};
}

/// The columns of one ray.
struct Ray {
  double x, y, u, v;
  Eigen::Matrix2d covariance;
  bool on_plane;
  double depth, depth_stddev;
  Eigen::Vector2d seen;
  Eigen::Matrix2d right, below;

  /// Pixel of a neighbour to the right or below; depth_change: of its own inverse depth. NaN behind the view.
  Eigen::Vector2d pixel(const View& view, double dx, double dy, double depth_change) const {
    const Eigen::Vector3d ray(x + dx / view.fx, y + dy / view.fy, 1);
    const double w = (on_plane ? view.n.dot(ray) : depth) + depth_change;
    const Eigen::Vector3d point = view.Q * (ray + w * view.t);
    if (!(point.z() > 0)) return Eigen::Vector2d::Constant(NAN);
    return {view.fx * point.x() / point.z() + view.cx, view.fy * point.y() / point.z() + view.cy};
  }
  Eigen::Vector2d mixture(const View& view, double depth_change = 0) const {
    return (Eigen::Matrix2d::Identity() - right - below) * pixel(view, 0, 0, depth_change) +
           right * pixel(view, 1, 0, depth_change) + below * pixel(view, 0, 1, depth_change);
  }
};

/// Rays, every third with a depth of its own; off: by how much they are seen beside where a view has them,
/// px.
std::vector<Ray> someRays(size_t count, const View& view, double off) {
  const std::vector<double> r = test::randomValues<double>(20 * count, -1, 1, 7);
  std::vector<Ray> rays(count);
  for (size_t i = 0; i < count; ++i) {
    const double* k = &r[20 * i];
    Ray& ray = rays[i];
    ray.x = 0.5 * k[0];
    ray.y = 0.3 + 0.2 * k[1];
    Eigen::Matrix2d root;
    root << 0.3 + 0.2 * k[2], 0, 0.2 * k[3], 0.3 + 0.2 * k[4];
    ray.covariance = root * root.transpose();
    ray.on_plane = i % 3 != 0;
    ray.depth = 0.3 + 0.1 * k[5];
    ray.depth_stddev = ray.on_plane ? 0 : 0.02;
    ray.right << 0.1 * k[6], 0.1 * k[7], 0.1 * k[8], 0.1 * k[9];
    ray.below << 0.1 * k[10], 0.1 * k[11], 0.1 * k[12], 0.1 * k[13];
    const Eigen::Vector2d there = ray.pixel(view, 0, 0, 0) + off * Eigen::Vector2d(k[14], k[15]);
    ray.u = there.x();
    ray.v = there.y();
    ray.seen = ray.mixture(view) + off * Eigen::Vector2d(k[16], k[17]);
  }
  return rays;
}

/// By columns, filled up with rays of a variance of 1.
std::vector<double> columnsOf(const std::vector<Ray>& rays, size_t padded) {
  std::vector<double> columns(kRayColumns * padded, 0);
  for (size_t i = rays.size(); i < padded; ++i)
    columns[kRayXX * padded + i] = columns[kRayYY * padded + i] = 1;
  for (size_t i = 0; i < rays.size(); ++i) {
    const Ray& ray = rays[i];
    const auto set = [&](int column, double value) { columns[column * padded + i] = value; };
    set(kRayX, ray.x);
    set(kRayY, ray.y);
    set(kRayU, ray.u);
    set(kRayV, ray.v);
    set(kRayXX, ray.covariance(0, 0));
    set(kRayXY, ray.covariance(0, 1));
    set(kRayYY, ray.covariance(1, 1));
    set(kRayOnPlane, ray.on_plane ? 1 : 0);
    set(kRayDepth, ray.depth);
    set(kRayDepthStddev, ray.depth_stddev);
    set(kRaySeenU, ray.seen.x());
    set(kRaySeenV, ray.seen.y());
    for (int k = 0; k < 4; ++k) {
      set(kRayRight + k, ray.right(k / 2, k % 2));
      set(kRayBelow + k, ray.below(k / 2, k % 2));
    }
  }
  return columns;
}

TEST(SeenRays, SupportIsByTheErrorOverTheTolerance) {
  const View view = someView();
  constexpr double kTolerance = 2;
  for (const size_t count : {1U, 3U, 4U, 5U, 90U}) {
    std::vector<Ray> rays = someRays(count, view, 2.5);
    if (count > 4) {
      rays[1].covariance(0, 0) = 1e4;  // as along a line
      rays[3].on_plane = false;        // behind the view
      rays[3].depth = -20;
    }
    const size_t padded = wholeDoubleLanes(count);
    const std::vector<double> columns = columnsOf(rays, padded);
    RaySupport expected;
    for (const Ray& ray : rays) {
      const bool telling = ray.covariance.trace() < kTolerance * kTolerance;
      expected.telling += telling ? 1 : 0;
      const Eigen::Vector2d error = Eigen::Vector2d(ray.u, ray.v) - ray.pixel(view, 0, 0, 0);
      const Eigen::Matrix2d allowed = ray.covariance + kTolerance * kTolerance * Eigen::Matrix2d::Identity();
      const double ratio = error.dot(allowed.inverse() * error);
      if (!(ratio < 1)) continue;
      expected.votes += 1 - ratio;
      expected.close += ratio < 1.0 / 16 ? 1 : 0;
      expected.telling_close += telling && ratio < 1.0 / 16 ? 1 : 0;
    }
    const RaySupport support = supportOf(view.numbers(), columns.data(), padded, count, kTolerance);
    EXPECT_NEAR(support.votes, expected.votes, 1e-9) << count;
    EXPECT_EQ(support.close, expected.close);
    EXPECT_EQ(support.telling, expected.telling);
    EXPECT_EQ(support.telling_close, expected.telling_close);
  }
}

TEST(SeenRays, RowsAreResidualsAndTheirDerivatives) {
  const View view = someView();
  for (const size_t count : {1U, 4U, 7U, 50U}) {
    const std::vector<Ray> rays = someRays(count, view, 1.5);
    const size_t padded = wholeDoubleLanes(count);
    const std::vector<double> columns = columnsOf(rays, padded);
    std::vector<double> out(kRayOutputs * padded);
    linearise(view.numbers(), columns.data(), padded, out.data());
    for (size_t i = 0; i < count; ++i) {
      const Ray& ray = rays[i];
      const auto value = [&](int column) { return out[column * padded + i]; };
      // Derivatives by differences of both sides.
      constexpr double kStep = 1e-6;
      Eigen::Matrix<double, 2, 9> by;
      for (int k = 0; k < 9; ++k) {
        const Eigen::Matrix<double, 9, 1> step = kStep * Eigen::Matrix<double, 9, 1>::Unit(k);
        by.col(k) = (ray.mixture(view.changed(step)) - ray.mixture(view.changed(-step))) / (2 * kStep);
      }
      const Eigen::Vector2d by_depth = (ray.mixture(view, kStep) - ray.mixture(view, -kStep)) / (2 * kStep);
      const Eigen::Matrix2d covariance =
          ray.covariance + std::pow(ray.depth_stddev, 2) * by_depth * by_depth.transpose();
      const Eigen::Vector2d residual = ray.seen - ray.mixture(view);
      // The second row less what the first one tells of it.
      const double mixed = covariance(0, 1) / covariance(0, 0);
      Eigen::Matrix2d unmix;
      unmix << 1, 0, -mixed, 1;
      const Eigen::Matrix<double, 2, 9> rows = unmix * by;
      const Eigen::Vector2d residuals = unmix * residual;
      const Eigen::Vector2d precisions = (unmix * covariance * unmix.transpose()).diagonal().cwiseInverse();
      for (int row = 0; row < 2; ++row) {
        for (int k = 0; k < 9; ++k)
          EXPECT_NEAR(value(row * kRayRow + k), rows(row, k), 1e-5 * (1 + std::abs(rows(row, k))))
              << i << ' ' << k;
        EXPECT_NEAR(value(row * kRayRow + kRayResidual), residuals[row], 1e-6);
        EXPECT_NEAR(value(row * kRayRow + kRayPrecision), precisions[row], 1e-6 * precisions[row]);
      }
      EXPECT_NEAR(value(kRaySquares), residual.squaredNorm(), 1e-9);
      EXPECT_NEAR(value(kRayRatio), residual.dot(covariance.inverse() * residual), 1e-5);
    }
  }
}

TEST(SeenRays, BehindTheViewAreMarked) {
  const View view = someView();
  std::vector<Ray> rays = someRays(5, view, 1);
  rays[3].on_plane = false;
  rays[3].depth = -20;
  const size_t padded = wholeDoubleLanes(rays.size());
  const std::vector<double> columns = columnsOf(rays, padded);
  std::vector<double> out(kRayOutputs * padded);
  linearise(view.numbers(), columns.data(), padded, out.data());
  for (size_t i = 0; i < rays.size(); ++i)
    EXPECT_EQ(out[kRaySquares * padded + i] == kRayBehind, i == 3) << i;
}

TEST(SeenRays, WeightsAreTukeys) {
  constexpr double kUnit = 0.5, kEnd = 16;
  for (const size_t padded : {4U, 20U}) {
    std::vector<double> squares = test::randomValues<double>(padded, 0, 5, 3),
                        ratios = test::randomValues<double>(padded, 0, 60, 4), weights(padded);
    squares[1] = kRayBehind;
    weighRays(squares.data(), ratios.data(), padded, kUnit, kEnd, weights.data());
    for (size_t i = 0; i < padded; ++i) {
      const double left = 1 - kUnit * ratios[i] / kEnd;
      EXPECT_NEAR(weights[i], i != 1 && left > 0 ? kUnit * left * left : 0, 1e-12) << i;
    }
  }
}

TEST(SeenRays, SumsAreTheNormalEquations) {
  for (const size_t padded : {4U, 32U, 36U, 100U}) {
    const std::vector<double> row = test::randomValues<double>(kRayRow * padded, -1, 1, 3),
                              weights = test::randomValues<double>(padded, 0, 1, 4);
    const double* precision = &row[kRayPrecision * padded];
    Eigen::Matrix<double, 9, 9> information = Eigen::Matrix<double, 9, 9>::Zero();
    Eigen::Matrix<double, 9, 1> right = Eigen::Matrix<double, 9, 1>::Zero();
    for (size_t i = 0; i < padded; ++i) {
      Eigen::Matrix<double, 9, 1> by;
      for (int k = 0; k < 9; ++k) by[k] = row[k * padded + i];
      information += weights[i] * precision[i] * by * by.transpose();
      right += weights[i] * precision[i] * row[kRayResidual * padded + i] * by;
    }
    RayBlocks blocks{};
    addUpRays(row.data(), precision, weights.data(), padded, blocks);
    addUpRays(row.data(), precision, weights.data(), padded, blocks);  // adds to what is there
    for (int i = 0, block = 0; i < 3; ++i) {
      for (int j = 0; j <= i; ++j, ++block)
        for (int k = 0; k < 9; ++k)
          EXPECT_NEAR(RayBlocks::total(blocks.information[block][k]),
                      2 * information(3 * i + k / 3, 3 * j + k % 3), 1e-10);
      for (int k = 0; k < 3; ++k)
        EXPECT_NEAR(RayBlocks::total(blocks.right[i][k]), 2 * right[3 * i + k], 1e-10);
    }
  }
}

}  // namespace
}  // namespace uav_landing
