#include "simulator/ground/town_layer.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

namespace uav_landing {
namespace {

/// The frame at the corner of a rectangle that is given by its middle.
GroundFrame cornerOf(const SimulatedTownParameters& p) {
  const GroundFrame middle(p.x, p.y, p.direction_deg);
  GroundFrame corner = middle;
  const Eigen::Vector2f left(-middle.axis.y(), middle.axis.x());
  corner.origin -=
      0.5f * static_cast<float>(p.length) * middle.axis + 0.5f * static_cast<float>(p.width) * left;
  return corner;
}

}  // namespace

TownLayer::Grid::Grid(double street_width, double block, double plot_side, double whole)
    : street(street_width),
      period(street_width + block),
      plots(std::max(1, static_cast<int>(std::lround(block / plot_side)))) {
  plot = static_cast<float>(block / plots);
  count = plots * static_cast<int>(std::ceil(whole / (street_width + block)));
}

float TownLayer::Grid::plotFrom(int index) const {
  return static_cast<float>(index / plots) * period + street + static_cast<float>(index % plots) * plot;
}

int TownLayer::Grid::plotAt(float s) const {
  const float block = std::floor(s / period);
  const int within =
      std::clamp(static_cast<int>(std::floor((s - block * period - street) / plot)), 0, plots - 1);
  return std::clamp(static_cast<int>(block) * plots + within, 0, count - 1);
}

float TownLayer::Grid::streets(float from, float to) const {
  return (dashesUpTo(to, street, period) - dashesUpTo(from, street, period)) / (to - from);
}

TownLayer::TownLayer(const SimulatedTownParameters& p, uint64_t seed)
    : frame_(cornerOf(p)),
      length_(p.length),
      width_(p.width),
      along_(p.street_width, p.block_length, p.plot, p.length),
      across_(p.street_width, p.block_width, p.plot, p.width),
      street_brightness_(p.street_brightness),
      garden_brightness_(p.garden_brightness),
      contrast_(p.contrast) {
  cv::RNG random(seed * 0x9E3779B97F4A7C15ULL + 7);
  const auto grey = [](double value) { return static_cast<float>(std::clamp(value, 0.0, 255.0)); };
  for (int i = 0; i < along_.count; ++i) {
    for (int j = 0; j < across_.count; ++j) {
      Roof roof{random.uniform(0.0, 1.0) < p.built, {}};
      const float length = along_.plot * random.uniform(0.45f, 0.8f);
      const float width = across_.plot * random.uniform(0.45f, 0.8f);
      const float x =
          along_.plotFrom(i) + random.uniform(0.5f, 1.0f) * (along_.plot - length) + 0.5f * length;
      const float y =
          across_.plotFrom(j) + random.uniform(0.3f, 0.7f) * (across_.plot - width) + 0.5f * width;
      const double brightness = p.roof_brightness + p.roof_spread * random.uniform(-1.0, 1.0);
      const double slope = random.uniform(-0.2, 0.2);  // one half of the roof faces the sun
      const bool ridge_along = random.uniform(0, 2) == 0;
      for (int half = 0; half < 2; ++half) {
        const float side = half == 0 ? -0.25f : 0.25f;
        const float shade = grey(brightness * (1 + (half == 0 ? slope : -slope)));
        roof.halves[half] = ridge_along ? Rectangle{x, y + side * width, length, 0.5f * width, shade}
                                        : Rectangle{x + side * length, y, 0.5f * length, width, shade};
        if (!roof.built) continue;
        mean_roofs_ += 0.5f * length * width;
        mean_light_ += 0.5f * length * width * shade;
      }
      roofs_.push_back(roof);
    }
  }
  const float plots =
      static_cast<float>(along_.count) * static_cast<float>(across_.count) * along_.plot * across_.plot;
  mean_roofs_ /= plots;
  mean_light_ /= plots;
}

TownLayer::Roofs TownLayer::roofs(const GroundPatch& patch) const {
  const int first_i = along_.plotAt(patch.x - 0.5f * patch.length);
  const int last_i = along_.plotAt(patch.x + 0.5f * patch.length);
  const int first_j = across_.plotAt(patch.y - 0.5f * patch.width);
  const int last_j = across_.plotAt(patch.y + 0.5f * patch.width);
  constexpr int kMost = 200;  // number of plots; more of them, far away, show their mean
  if ((last_i - first_i + 1) * (last_j - first_j + 1) > kMost) {
    const float blocks = (1 - along_.streets(patch.x - 0.5f * patch.length, patch.x + 0.5f * patch.length)) *
                         (1 - across_.streets(patch.y - 0.5f * patch.width, patch.y + 0.5f * patch.width));
    return {blocks * mean_roofs_, blocks * mean_light_, false};
  }
  Roofs sum;
  for (int i = first_i; i <= last_i; ++i) {
    for (int j = first_j; j <= last_j; ++j) {
      const Roof& roof = roofs_[static_cast<size_t>(i) * across_.count + j];
      if (!roof.built) continue;
      for (const Rectangle& half : roof.halves) {
        const float share =
            overlap(patch.x, patch.length, half.x - 0.5f * half.length, half.x + 0.5f * half.length) *
            overlap(patch.y, patch.width, half.y - 0.5f * half.width, half.y + 0.5f * half.width);
        sum.share += share;
        sum.light += share * half.brightness;
        if (share == 1) sum.one = true;
      }
    }
  }
  return sum;
}

LayerCover TownLayer::cover(const GroundFootprint& footprint) const {
  const GroundPatch whole = footprint.in(frame_);
  const float share = overlap(whole.x, whole.length, 0, length_) * overlap(whole.y, whole.width, 0, width_);
  if (share == 0) return {};
  const float near = std::max(whole.x - 0.5f * whole.length, 0.0f);
  const float far = std::min(whole.x + 0.5f * whole.length, length_);
  const float low = std::max(whole.y - 0.5f * whole.width, 0.0f);
  const float high = std::min(whole.y + 0.5f * whole.width, width_);
  if (!(far > near && high > low)) return {};
  const GroundPatch patch{0.5f * (near + far), 0.5f * (low + high), far - near, high - low};
  const float streets = 1 - (1 - along_.streets(near, far)) * (1 - across_.streets(low, high));
  const Roofs roofs = this->roofs(patch);
  const float garden = std::max(1 - streets - roofs.share, 0.0f);
  constexpr float kAll = 0.9999f;  // all, except for rounding
  const bool even = share == 1 && (streets > kAll || garden == 1 || roofs.one);
  const float sum = streets + roofs.share + garden;
  return {share, (streets * street_brightness_ + roofs.light + garden * garden_brightness_) / sum, contrast_,
          even};
}

}  // namespace uav_landing
