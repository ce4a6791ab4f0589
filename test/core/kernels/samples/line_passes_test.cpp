#include "kernels/samples/line_passes.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "support/random_values.h"

namespace uav_landing {
namespace {

struct Piece {
  Eigen::Vector2d a, b;
  double clearance, tolerance;

  Eigen::Vector2d middle() const { return 0.5 * (a + b); }
  Eigen::Vector2d along() const { return (b - a).normalized(); }
  double half() const { return 0.5 * (b - a).norm(); }

  void addTo(LineColumns& columns) const {
    const Eigen::Vector2d across(-along().y(), along().x()), top = a.y() < b.y() ? a : b;
    columns.middle_u.push_back(middle().x());
    columns.middle_v.push_back(middle().y());
    columns.along_u.push_back(along().x());
    columns.along_v.push_back(along().y());
    columns.across_u.push_back(across.x());
    columns.across_v.push_back(across.y());
    columns.top_u.push_back(top.x());
    columns.top_v.push_back(top.y());
    columns.half2.push_back(half() * half());
    columns.reach.push_back(half() + clearance);
    columns.tolerance2.push_back(tolerance * tolerance);
  }

  /// By the distance of an end from the line through middle and point.
  double fit(const Eigen::Vector2d& point, double slope) const {
    const double top = std::min(a.y(), b.y()), top_u = a.y() < b.y() ? a.x() : b.x();
    if (point.y() - top > slope * std::abs(point.x() - top_u)) return kTopAbove;
    const Eigen::Vector2d to = point - middle();
    if (std::abs(to.dot(along())) < half() + clearance) return -1;
    const Eigen::ParametrizedLine<double, 2> line =
        Eigen::ParametrizedLine<double, 2>::Through(middle(), point);
    return 1 - line.squaredDistance(a) / (tolerance * tolerance);
  }
};

TEST(FitLines, IsByTheDistanceOfTheirEnds) {
  constexpr double kSlope = 0.5;
  for (const int count : {1, 3, 4, 5, 33}) {
    const std::vector<double> ends = test::randomValues<double>(4 * count, 0, 300, count);
    LineColumns columns;
    columns.reserve(count);
    std::vector<Piece> pieces;
    for (int i = 0; i < count; ++i) {
      const double* e = &ends[4 * i];
      pieces.push_back({{e[0], e[1] + 150}, {e[2], e[3] + 200}, 4, 2.5});
      pieces.back().addTo(columns);
    }
    for (const Eigen::Vector2d& point : {Eigen::Vector2d(150, 20), Eigen::Vector2d(160, 210),
                                         Eigen::Vector2d(-900, -40), pieces[0].middle()}) {
      constexpr double kScale = 0.7;  // homogeneous points have any
      std::vector<double> fit(count + 1, 77);
      fitLines(columns, kScale * point.x(), kScale * point.y(), kScale, kSlope, count, fit.data());
      for (int i = 0; i < count; ++i) {
        const double expected = pieces[i].fit(point, kSlope);
        EXPECT_NEAR(fit[i], expected, 1e-9 * (1 + std::abs(expected))) << i << " of " << count;
      }
      EXPECT_EQ(fit[count], 77);
    }
  }
}

}  // namespace
}  // namespace uav_landing
