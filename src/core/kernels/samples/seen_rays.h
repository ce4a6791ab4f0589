#pragma once

#include <array>
#include <cstddef>

namespace uav_landing {

/// What is known of rays that two views have matched, by columns of whole lanes. A ray (x, y, 1) of one view
/// was seen at the pixel (u, v) of the other one.
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
  kRayDepthStddev,  ///< of that; 0 on the plane
  kRaySeenU,        ///< where a mixture of the ray and its neighbours was seen
  kRaySeenV,
  kRayRight,                  ///< what the neighbour to the right counts there, a matrix of 2 x 2 by rows,
  kRayBelow = kRayRight + 4,  ///< and the one below; the ray itself counts what is left of the unit matrix
  kRayColumns = kRayBelow + 4
};

/// Two rows of the least squares problem of each ray, by columns of whole lanes: for each row derivatives by
/// kRayUnknowns, residual and precision.
constexpr int kRayUnknowns = 9;
constexpr int kRayResidual = kRayUnknowns, kRayPrecision = kRayResidual + 1, kRayRow = kRayPrecision + 1;
/// For both: squared residual in pixels, the same over the covariance, and room for a weight.
constexpr int kRaySquares = 2 * kRayRow, kRayRatio = kRaySquares + 1, kRayWeight = kRaySquares + 2;
constexpr int kRayOutputs = kRaySquares + 3;
/// Squared residual of a ray that lies behind the other view, pixels^2.
constexpr double kRayBehind = 1e9;

/// How the other view sees rays: a ray r of inverse depth w, n.r on the plane, is the point Q (r + w t), in a
/// pinhole camera.
struct RayView {
  std::array<std::array<double, 3>, 3> Q;
  std::array<double, 3> t, n, Qt;  ///< Qt: Q t
  double fx, fy, cx, cy;
};

/// How well rays are seen where a view has them.
struct RaySupport {
  double votes = 0;  ///< of each 1 - ratio, at least 0: ratio is the squared error over that of the tolerance
  int close = 0;     ///< rays with a ratio below 1/16
  int telling = 0, telling_close = 0;  ///< of rays with less variance in all than the tolerance's square
};

/// inputs: kRayColumns columns of padded (whole lanes); count: rays that count. tolerance: pixels, added to
/// the covariance of each ray, so that where a ray does not know, as along a line, any view has its vote.
RaySupport supportOf(const RayView& view, const double* inputs, size_t padded, size_t count,
                     double tolerance);

/// Residuals and their derivatives by a rotation of Q from the left, t and n. The two rows of a ray are made
/// independent of each other (LDL' of its covariance, which has the depth's in it). Sets all columns but the
/// weights.
void linearise(const RayView& view, const double* inputs, size_t padded, double* outputs);

/// Tukey's weights unit (1 - unit ratio / end)^2 of rays that are not behind the view, 0 where the bracket is
/// below zero.
void weighRays(const double* squares, const double* ratios, size_t padded, double unit, double end,
               double* weights);

/// Sums over rays, in four lanes each: lower blocks of three by three of the normal equations, by rows, and
/// the right side by three.
struct RayBlocks {
  alignas(32) double information[6][9][4];
  alignas(32) double right[3][9][4];

  /// Of its lanes.
  static double total(const double (&lanes)[4]) { return (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]); }
};

/// Adds one row of all rays, the kRayRow columns from row on, with the product of weight and precision.
void addUpRays(const double* row, const double* precision, const double* weights, size_t padded,
               RayBlocks& blocks);

}  // namespace uav_landing
