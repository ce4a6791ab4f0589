#pragma once

#include "kernels/lanes/lanes.h"
#include "motion/motion_state.h"

namespace uav_landing {
namespace motion_lanes {

// Four matches at a time: where a motion puts them, and how that follows from it. For motion_rows.cpp.

// Nearer than this, in units of what is seen, nothing is in front of the camera.
constexpr double kLeastDepth = 1e-6;

using Mask = decltype(DoubleLanes{} > DoubleLanes{});

/// A state and a camera, by numbers.
struct Terms {
  double Q[3][3], t[3], n[3], Qt[3];
  double fx, fy, cx, cy;

  Terms(const MotionState& state, double fx_, double fy_, double cx_, double cy_)
      : fx(fx_), fy(fy_), cx(cx_), cy(cy_) {
    const Eigen::Vector3d turned = state.Q * state.t;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) Q[i][j] = state.Q(i, j);
      t[i] = state.t[i];
      n[i] = state.n[i];
      Qt[i] = turned[i];
    }
  }
};

/// Where four rays of the frame now are seen then: inverse depth, the point in the frame then, its pixel.
/// seen: in front of the camera.
struct Seen {
  DoubleLanes rx, ry, w, x, y, z, u, v;
  Mask on_plane, seen;
};

[[gnu::always_inline]] inline void look(const Terms& s, const DoubleLanes& rx, const DoubleLanes& ry,
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

// A row of the Jacobian by (rotation, t, n), where the projection's derivatives by the point are a by its
// component `axis` (0 or 1) and c by the third.
template <int axis>
[[gnu::always_inline]] inline void derive(const Terms& s, const Seen& at, const DoubleLanes& a,
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

// Adds a pixel and its derivatives, times a matrix of four matches, to theirs.
struct MatchRows {
  DoubleLanes u{}, v{}, depth_u{}, depth_v{}, first[9]{}, second[9]{};
};
[[gnu::always_inline]] inline void addPixel(const Terms& s, const Seen& at, const DoubleLanes (&share)[4],
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

// What was matched is not the corner alone: its neighbours to the right and below count by how the place
// found follows from the warp, the corner itself by what is left. seen: the corner is in front.
[[gnu::always_inline]] inline void combine(const Terms& s, const double* in, size_t padded, MatchRows& rows,
                                           Mask& seen) {
  const DoubleLanes none{}, one = none + 1;
  DoubleLanes rx, ry, right[4], below[4], corner[4];
  load(in, rx);
  load(in + kY * padded, ry);
  for (int k = 0; k < 4; ++k) {
    load(in + (kRight + k) * padded, right[k]);
    load(in + (kBelow + k) * padded, below[k]);
    corner[k] = (k == 0 || k == 3 ? one : none) - right[k] - below[k];
  }
  const double *on_plane = in + kOnPlane * padded, *depth = in + kDepth * padded;
  Seen at, neighbour;
  look(s, rx, ry, on_plane, depth, at);
  addPixel(s, at, corner, rows);
  look(s, rx + 1 / s.fx, ry, on_plane, depth, neighbour);
  addPixel(s, neighbour, right, rows);
  look(s, rx, ry + 1 / s.fy, on_plane, depth, neighbour);
  addPixel(s, neighbour, below, rows);
  seen = at.seen;
}

}  // namespace motion_lanes
}  // namespace uav_landing
