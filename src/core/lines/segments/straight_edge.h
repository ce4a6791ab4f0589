#pragma once

namespace uav_landing {

/// Pixels along an edge between the places where its gradient is compared. Of the four places around a pixel,
/// two on each side, so many must be alike.
constexpr int kAlongEdge = 3, kAlikeAlongEdge = 3;

/// Whether the gradient h, farther along an edge, is like the gradient g: within 25 degrees, and at least 40
/// % as strong. Gradients of texture are not.
inline bool alikeAlongEdge(float gx, float gy, float hx, float hy) {
  constexpr float kMinCos2 = 0.82F, kMinStrength2 = 0.16F;
  const float g2 = gx * gx + gy * gy, h2 = hx * hx + hy * hy, product = hx * gx + hy * gy;
  return product > 0 && product * product >= kMinCos2 * g2 * h2 && h2 >= kMinStrength2 * g2;
}

}  // namespace uav_landing
