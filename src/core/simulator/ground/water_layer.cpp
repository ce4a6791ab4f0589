#include "simulator/ground/water_layer.h"

#include <algorithm>
#include <cmath>

namespace uav_landing {

WaterLayer::WaterLayer(const SimulatedWaterParameters& p)
    : frame_(p.x, p.y, p.direction_deg),
      width_(p.width),
      wave_(p.wave),
      wave_length_(p.wave_length),
      brightness_(p.brightness),
      contrast_(p.contrast),
      beach_(p.beach_width),
      beach_brightness_(p.beach_brightness) {}

WaterLayer::Bank WaterLayer::bank(float along) const {
  // With two sines no two bends are alike. Together they stay within the wave.
  constexpr float kSlow = 0.7f, kFast = 0.3f, kRatio = 2.7f;
  const float k = 2 * static_cast<float>(M_PI) / wave_length_, phase = k * along;
  return {wave_ * (kSlow * std::sin(phase) + kFast * std::sin(kRatio * phase)),
          wave_ * k * (kSlow * std::cos(phase) + kFast * kRatio * std::cos(kRatio * phase))};
}

LayerCover WaterLayer::cover(const GroundFootprint& footprint) const {
  const GroundPatch patch = footprint.in(frame_);
  const float reach = wave_ + beach_ + 0.5f * patch.width;
  if (patch.y < -reach || patch.y > width_ + reach) return {};
  // A patch as long as the bends shows their mean, and reaches farther across by their amplitude.
  const float detail = std::clamp(1.5f - 2.0f * patch.length / wave_length_, 0.0f, 1.0f);
  const Bank near = bank(patch.x);
  const float across = patch.y - detail * near.across;
  const float slope = detail * near.slope;
  const Eigen::Vector2f u = frame_.turned(footprint.u), v = frame_.turned(footprint.v);
  const float extent = std::hypot(u.y() - slope * u.x(), v.y() - slope * v.x()) + 2 * (1 - detail) * wave_;
  const float water = overlap(across, extent, 0, width_);
  const float sand =
      beach_ > 0 ? overlap(across, extent, -beach_, 0) + overlap(across, extent, width_, width_ + beach_) : 0;
  const float share = std::min(water + sand, 1.0f);
  if (share == 0) return {};
  const float grey = (water * brightness_ + sand * beach_brightness_) / (water + sand);
  return {share, grey, contrast_, water == 1 || sand == 1};
}

}  // namespace uav_landing
