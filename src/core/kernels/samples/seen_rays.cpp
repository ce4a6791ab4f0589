#include "kernels/samples/seen_rays.h"

#include <algorithm>

#include "kernels/lanes/lanes.h"
#include "kernels/lanes/multiversion.h"

namespace uav_landing {
namespace {

// Smallest depth in front of the view, in units of the scene.
constexpr double kLeastDepth = 1e-6;

using Mask = decltype(DoubleLanes{} > DoubleLanes{});

// Four rays as seen: inverse depth, the point in the other view, its pixel. seen: the point is in front of
// the view.
struct Seen {
  DoubleLanes rx, ry, w, x, y, z, u, v;
  Mask on_plane, seen;
};

[[gnu::always_inline]] inline void look(const RayView& s, const DoubleLanes& rx, const DoubleLanes& ry,
                                        const double* on_plane, const double* depth, Seen& out) {
  DoubleLanes plane, own;
  load(on_plane, plane);
  load(depth, own);
  out.rx = rx;
  out.ry = ry;
  out.on_plane = plane > 0;
  out.w = out.on_plane ? s.n[0] * rx + s.n[1] * ry + s.n[2] : own;
  const DoubleLanes px = rx + out.w * s.t[0], py = ry + out.w * s.t[1], pz = 1 + out.w * s.t[2];
  const DoubleLanes z = s.Q[2][0] * px + s.Q[2][1] * py + s.Q[2][2] * pz, one = DoubleLanes{} + 1;
  out.seen = z > kLeastDepth;
  out.x = s.Q[0][0] * px + s.Q[0][1] * py + s.Q[0][2] * pz;
  out.y = s.Q[1][0] * px + s.Q[1][1] * py + s.Q[1][2] * pz;
  out.z = out.seen ? z : one;
  out.u = s.fx * out.x / out.z + s.cx;
  out.v = s.fy * out.y / out.z + s.cy;
}

// A row of the Jacobian by (rotation, t, n). The projection's derivatives by the point are a by its component
// `axis` (0 or 1), and c by the third one.
template <int axis>
[[gnu::always_inline]] inline void derive(const RayView& s, const Seen& at, const DoubleLanes& a,
                                          const DoubleLanes& c, const DoubleLanes& by_depth,
                                          DoubleLanes (&row)[9]) {
  const DoubleLanes none{};
  // The point turns by -[y]x.
  if (axis == 0) {
    row[0] = c * at.y;
    row[1] = a * at.z - c * at.x;
    row[2] = -a * at.y;
  } else {
    row[0] = c * at.y - a * at.z;
    row[1] = -c * at.x;
    row[2] = a * at.x;
  }
  for (int j = 0; j < 3; ++j) row[3 + j] = at.w * (a * s.Q[axis][j] + c * s.Q[2][j]);
  row[6] = at.on_plane ? by_depth * at.rx : none;
  row[7] = at.on_plane ? by_depth * at.ry : none;
  row[8] = at.on_plane ? by_depth : none;
}

// Adds a pixel and its derivatives, times a matrix of four matches, to the sums here.
struct MatchRows {
  DoubleLanes u{}, v{}, depth_u{}, depth_v{}, first[9]{}, second[9]{};
};
[[gnu::always_inline]] inline void addPixel(const RayView& s, const Seen& at, const DoubleLanes (&share)[4],
                                            MatchRows& rows) {
  const DoubleLanes au = s.fx / at.z, av = s.fy / at.z, cu = -au * at.x / at.z, cv = -av * at.y / at.z;
  const DoubleLanes depth_u = au * s.Qt[0] + cu * s.Qt[2], depth_v = av * s.Qt[1] + cv * s.Qt[2];
  DoubleLanes by_u[9], by_v[9];
  derive<0>(s, at, au, cu, depth_u, by_u);
  derive<1>(s, at, av, cv, depth_v, by_v);
  rows.u += share[0] * at.u + share[1] * at.v;
  rows.v += share[2] * at.u + share[3] * at.v;
  rows.depth_u += share[0] * depth_u + share[1] * depth_v;
  rows.depth_v += share[2] * depth_u + share[3] * depth_v;
  for (int j = 0; j < 9; ++j) {
    rows.first[j] += share[0] * by_u[j] + share[1] * by_v[j];
    rows.second[j] += share[2] * by_u[j] + share[3] * by_v[j];
  }
}

// The match is not of the corner alone. Its neighbours to the right and below count by the derivative of the
// place by the warp; the corner itself has the rest. seen: the corner is in front of the view.
[[gnu::always_inline]] inline void combine(const RayView& s, const double* in, size_t padded, MatchRows& rows,
                                           Mask& seen) {
  const DoubleLanes none{}, one = none + 1;
  DoubleLanes rx, ry, right[4], below[4], corner[4];
  load(in, rx);
  load(in + kRayY * padded, ry);
  for (int k = 0; k < 4; ++k) {
    load(in + (kRayRight + k) * padded, right[k]);
    load(in + (kRayBelow + k) * padded, below[k]);
    corner[k] = (k == 0 || k == 3 ? one : none) - right[k] - below[k];
  }
  const double *on_plane = in + kRayOnPlane * padded, *depth = in + kRayDepth * padded;
  Seen at, neighbour;
  look(s, rx, ry, on_plane, depth, at);
  addPixel(s, at, corner, rows);
  look(s, rx + 1 / s.fx, ry, on_plane, depth, neighbour);
  addPixel(s, neighbour, right, rows);
  look(s, rx, ry + 1 / s.fy, on_plane, depth, neighbour);
  addPixel(s, neighbour, below, rows);
  seen = at.seen;
}

constexpr size_t kTile = 32;  // rays whose columns stay in the cache

// Sums of the products of three columns with three others of a row, by its weights.
[[gnu::always_inline]] inline void addBlock(const double* a, const double* b, const double* weights,
                                            size_t padded, size_t size, double (&sums)[9][kDoubleLanes]) {
  DoubleLanes s[9];
  for (int k = 0; k < 9; ++k) load(sums[k], s[k]);
  for (size_t i = 0; i < size; i += kDoubleLanes) {
    DoubleLanes a0, a1, a2, b0, b1, b2, weight;
    load(weights + i, weight);
    load(a + i, a0);
    load(a + padded + i, a1);
    load(a + 2 * padded + i, a2);
    load(b + i, b0);
    load(b + padded + i, b1);
    load(b + 2 * padded + i, b2);
    b0 *= weight;
    b1 *= weight;
    b2 *= weight;
    s[0] += a0 * b0;
    s[1] += a0 * b1;
    s[2] += a0 * b2;
    s[3] += a1 * b0;
    s[4] += a1 * b1;
    s[5] += a1 * b2;
    s[6] += a2 * b0;
    s[7] += a2 * b1;
    s[8] += a2 * b2;
  }
  for (int k = 0; k < 9; ++k) store(s[k], sums[k]);
}

// Sums of the products of three columns with the residual.
[[gnu::always_inline]] inline void addRight(const double* a, const double* residual, const double* weights,
                                            size_t padded, size_t size, double (&sums)[9][kDoubleLanes]) {
  DoubleLanes s[3];
  for (int k = 0; k < 3; ++k) load(sums[k], s[k]);
  for (size_t i = 0; i < size; i += kDoubleLanes) {
    DoubleLanes a0, a1, a2, r, weight;
    load(weights + i, weight);
    load(residual + i, r);
    load(a + i, a0);
    load(a + padded + i, a1);
    load(a + 2 * padded + i, a2);
    r *= weight;
    s[0] += a0 * r;
    s[1] += a1 * r;
    s[2] += a2 * r;
  }
  for (int k = 0; k < 3; ++k) store(s[k], sums[k]);
}

}  // namespace

UAV_LANDING_MULTIVERSION RaySupport supportOf(const RayView& view, const double* inputs, size_t padded,
                                              size_t count, double tolerance) {
  constexpr double kClose = 0.0625;  // ratio of a ray that misses by a quarter of the tolerance
  const double square = tolerance * tolerance;
  const DoubleLanes none{}, one = none + 1, last = none + static_cast<double>(count);
  DoubleLanes votes{}, close{}, telling{}, telling_close{}, index{0, 1, 2, 3};
  for (size_t i = 0; i < padded; i += kDoubleLanes, index += kDoubleLanes) {
    Seen at;
    const double* in = inputs + i;
    DoubleLanes rx, ry, then_u, then_v, xx, xy, yy;
    load(in, rx);
    load(in + kRayY * padded, ry);
    look(view, rx, ry, in + kRayOnPlane * padded, in + kRayDepth * padded, at);
    load(in + kRayU * padded, then_u);
    load(in + kRayV * padded, then_v);
    const DoubleLanes error_u = then_u - at.u, error_v = then_v - at.v;
    load(in + kRayXX * padded, xx);
    load(in + kRayXY * padded, xy);
    load(in + kRayYY * padded, yy);
    const Mask tells = (index < last) & (xx + yy < square);
    xx += square;
    yy += square;
    const DoubleLanes ratio =
        (yy * error_u * error_u - 2 * xy * error_u * error_v + xx * error_v * error_v) / (xx * yy - xy * xy);
    const Mask counts = at.seen & (index < last) & (ratio < 1);
    votes += counts ? 1 - ratio : none;
    const Mask fits = counts & (ratio < kClose);
    close += fits ? one : none;
    telling += tells ? one : none;
    telling_close += (fits & tells) ? one : none;
  }
  return {sum(votes), static_cast<int>(sum(close)), static_cast<int>(sum(telling)),
          static_cast<int>(sum(telling_close))};
}

UAV_LANDING_MULTIVERSION void linearise(const RayView& view, const double* inputs, size_t padded,
                                        double* outputs) {
  constexpr double kLeastVariance = 1e-12;
  const DoubleLanes none{}, behind = none + kRayBehind;
  for (size_t i = 0; i < padded; i += kDoubleLanes) {
    const double* in = inputs + i;
    double* out = outputs + i;
    MatchRows rows;
    Mask seen;
    combine(view, in, padded, rows, seen);
    DoubleLanes u, v, xx, xy, yy, depth_stddev;
    load(in + kRaySeenU * padded, u);
    load(in + kRaySeenV * padded, v);
    load(in + kRayXX * padded, xx);
    load(in + kRayXY * padded, xy);
    load(in + kRayYY * padded, yy);
    load(in + kRayDepthStddev * padded, depth_stddev);  // zero on the plane
    const DoubleLanes du = rows.depth_u * depth_stddev, dv = rows.depth_v * depth_stddev;
    xx += du * du;
    xy += du * dv;
    yy += dv * dv;
    const DoubleLanes mixed = xy / xx, left = yy - mixed * xy;
    const DoubleLanes precision_u = 1 / xx,
                      precision_v = 1 / (left > kLeastVariance ? left : none + kLeastVariance);
    const DoubleLanes error_u = u - rows.u, error_v = v - rows.v, own_v = error_v - mixed * error_u;
    for (int j = 0; j < kRayUnknowns; ++j) {
      store(rows.first[j], out + j * padded);
      store(rows.second[j] - mixed * rows.first[j], out + (kRayRow + j) * padded);
    }
    store(error_u, out + kRayResidual * padded);
    store(precision_u, out + kRayPrecision * padded);
    store(own_v, out + (kRayRow + kRayResidual) * padded);
    store(precision_v, out + (kRayRow + kRayPrecision) * padded);
    const DoubleLanes squares = error_u * error_u + error_v * error_v;
    store(seen ? squares : behind, out + kRaySquares * padded);
    store(error_u * error_u * precision_u + own_v * own_v * precision_v, out + kRayRatio * padded);
  }
}

UAV_LANDING_MULTIVERSION void weighRays(const double* squares, const double* ratios, size_t padded,
                                        double unit, double end, double* weights) {
  const DoubleLanes none{};
  for (size_t i = 0; i < padded; i += kDoubleLanes) {
    DoubleLanes square, ratio;
    load(squares + i, square);
    load(ratios + i, ratio);
    const DoubleLanes left = 1 - unit / end * ratio;
    store(((square < kRayBehind) & (left > 0)) ? unit * left * left : none, weights + i);
  }
}

UAV_LANDING_MULTIVERSION void addUpRays(const double* row, const double* precision, const double* ray_weights,
                                        size_t padded, RayBlocks& blocks) {
  alignas(32) double weights[kTile];
  for (size_t begin = 0; begin < padded; begin += kTile) {
    const size_t size = std::min(kTile, padded - begin);
    for (size_t i = 0; i < size; ++i) weights[i] = ray_weights[begin + i] * precision[begin + i];
    const double* columns = row + begin;
    int block = 0;
    for (int i = 0; i < 3; ++i) {
      const double* a = columns + 3 * i * padded;
      for (int j = 0; j <= i; ++j)
        addBlock(a, columns + 3 * j * padded, weights, padded, size, blocks.information[block++]);
      addRight(a, columns + kRayResidual * padded, weights, padded, size, blocks.right[i]);
    }
  }
}

}  // namespace uav_landing
