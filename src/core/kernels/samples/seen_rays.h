#pragma once

#include <array>
#include <cstddef>

namespace uav_landing {

/// Rays that two views have matched, by columns of whole lanes. A ray (x, y, 1) of one view was seen at the
/// pixel (u, v) of the other one.
enum RayColumn {
  kRayX,
  kRayY,
  kRayU,
  kRayV,
  kRayXX,  ///< covariance of that pixel
  kRayXY,
  kRayYY,
  kRayOnPlane,      ///< 1: its inverse depth is that of a plane; 0: its own
  kRayDepth,        ///< own inverse depth
  kRayDepthStddev,  ///< of the inverse depth; 0 on the plane
  kRaySeenU,        ///< place where a mixture of the ray and its neighbours was seen
  kRaySeenV,
  kRayRight,                  ///< weight of the neighbour to the right in this mixture, a 2 x 2 matrix by
                              ///< rows,
  kRayBelow = kRayRight + 4,  ///< and of the one below; the ray itself has the rest of the unit matrix
  kRayColumns = kRayBelow + 4
};

/// Two rows of the least squares problem per ray, by columns of whole lanes. Each row has the derivatives by
/// kRayUnknowns, the residual and the precision.
constexpr int kRayUnknowns = 9;
constexpr int kRayResidual = kRayUnknowns, kRayPrecision = kRayResidual + 1, kRayRow = kRayPrecision + 1;
/// For both rows: squared residual in pixels, the same over the covariance, and room for a weight.
constexpr int kRaySquares = 2 * kRayRow, kRayRatio = kRaySquares + 1, kRayWeight = kRaySquares + 2;
constexpr int kRayOutputs = kRaySquares + 3;
/// Squared residual of a ray that lies behind the other view, pixels^2.
constexpr double kRayBehind = 1e9;

/// The other view. A ray r with the inverse depth w (n.r on the plane) is the point Q (r + w t), seen by a
/// pinhole camera.
struct RayView {
  std::array<std::array<double, 3>, 3> Q;
  std::array<double, 3> t, n, Qt;  ///< Qt: Q t
  double fx, fy, cx, cy;
};

/// Agreement of rays with a view.
struct RaySupport {
  double votes = 0;  ///< sum of 1 - ratio, each at least 0; ratio: squared error over that of the tolerance
  int close = 0;     ///< rays with a ratio below 1/16
  int telling = 0, telling_close = 0;  ///< of rays whose total variance is below the square of the tolerance
};

/// inputs: kRayColumns columns of padded values (whole lanes). count: number of rays. tolerance: pixels,
/// added to the covariance of each ray. So a ray that is uncertain, for example along a line, votes for any
/// view in that direction.
RaySupport supportOf(const RayView& view, const double* inputs, size_t padded, size_t count,
                     double tolerance);

/// Residuals and their derivatives by a rotation of Q from the left, t and n. The two rows of a ray are made
/// independent of each other (LDL' of its covariance, which contains that of the depth). Sets all columns but
/// the weights.
void linearise(const RayView& view, const double* inputs, size_t padded, double* outputs);

/// Tukey's weights unit (1 - unit ratio / end)^2; 0 for rays behind the view and where the bracket is
/// negative.
void weighRays(const double* squares, const double* ratios, size_t padded, double unit, double end,
               double* weights);

/// Sums over rays, in four lanes each: lower blocks of three by three of the normal equations, by rows, and
/// the right side by three.
struct RayBlocks {
  alignas(32) double information[6][9][4];
  alignas(32) double right[3][9][4];

  /// Sum of the lanes.
  static double total(const double (&lanes)[4]) { return (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]); }
};

/// Adds one row of all rays, the kRayRow columns from row on, times weight and precision.
void addUpRays(const double* row, const double* precision, const double* weights, size_t padded,
               RayBlocks& blocks);

}  // namespace uav_landing
