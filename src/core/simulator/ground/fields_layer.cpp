#include "simulator/ground/fields_layer.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

namespace uav_landing {
namespace {

/// The frame at the corner of a rectangle that is given by its middle.
GroundFrame cornerOf(const SimulatedFieldsParameters& p) {
  const GroundFrame middle(p.x, p.y, p.direction_deg);
  GroundFrame corner = middle;
  const Eigen::Vector2f left(-middle.axis.y(), middle.axis.x());
  corner.origin -=
      0.5f * static_cast<float>(p.length) * middle.axis + 0.5f * static_cast<float>(p.width) * left;
  return corner;
}

/// Borders from 0 to the whole length, at random distances around the mean. No piece is shorter than half of
/// it.
std::vector<float> divide(cv::RNG& random, double whole, double mean) {
  std::vector<float> borders{0};
  double at = random.uniform(0.5, 1.5) * mean;
  for (; at < whole - 0.5 * mean; at += random.uniform(0.5, 1.5) * mean)
    borders.push_back(static_cast<float>(at));
  borders.push_back(static_cast<float>(whole));
  return borders;
}

/// The first element that reaches beyond `from`.
template <class Element>
typename std::vector<Element>::const_iterator firstFrom(const std::vector<Element>& elements, float from) {
  return std::upper_bound(elements.begin(), elements.end(), from,
                          [](float value, const Element& element) { return value < element.to; });
}

}  // namespace

FieldsLayer::FieldsLayer(const SimulatedFieldsParameters& p, uint64_t seed)
    : frame_(cornerOf(p)),
      length_(p.length),
      width_(p.width),
      contrast_(p.contrast),
      border_(p.border_width),
      border_brightness_(p.border_brightness),
      row_spacing_(p.row_spacing),
      mean_(p.brightness) {
  cv::RNG random(seed * 0x9E3779B97F4A7C15ULL + 5);
  const std::vector<float> across = divide(random, p.width, p.field_width);
  for (size_t i = 0; i + 1 < across.size(); ++i) {
    strips_.push_back({across[i], across[i + 1], {}});
    const std::vector<float> along = divide(random, p.length, p.field_length);
    for (size_t j = 0; j + 1 < along.size(); ++j) {
      Field field{along[j], along[j + 1], 0, 0, random.uniform(0, 4) != 0};
      field.brightness =
          std::clamp(static_cast<float>(p.brightness + p.spread * random.uniform(-1.0, 1.0)), 0.0f, 255.0f);
      field.rows = static_cast<float>(p.row_contrast * random.uniform(0.0, 1.0));
      strips_.back().fields.push_back(field);
    }
  }
}

float FieldsLayer::crop(const Field& field, const GroundPatch& patch) const {
  const float extent = (field.rows_along ? patch.width : patch.length) / row_spacing_;
  if (field.rows == 0 || extent >= 1) return field.brightness;
  const float phase = static_cast<float>(M_PI) * (field.rows_along ? patch.y : patch.x) / row_spacing_;
  const float half = static_cast<float>(M_PI) * extent;
  // The mean of a sine over the extent. Rows that pixels can hardly show fade sooner, as they do in a lens.
  // Otherwise they come back as false rows.
  const float mean = half > 1e-3f ? std::sin(half) / half : 1.0f;
  const float faded = mean * std::min(2 - 2 * extent, 1.0f);
  return field.brightness * (1 + field.rows * faded * std::sin(2 * phase));
}

LayerCover FieldsLayer::cover(const GroundFootprint& footprint) const {
  const GroundPatch patch = footprint.in(frame_);
  const float share = overlap(patch.x, patch.length, 0, length_) * overlap(patch.y, patch.width, 0, width_);
  if (share == 0) return {};
  const float low = patch.y - 0.5f * patch.width, high = patch.y + 0.5f * patch.width;
  const float near = patch.x - 0.5f * patch.length, far = patch.x + 0.5f * patch.length;
  constexpr int kMost = 400;  // number of fields; more of them, far away, show their mean
  int looked_at = 0;
  float inner = 0, light = 0;
  bool one = false;
  for (auto strip = firstFrom(strips_, low); strip != strips_.end() && strip->from < high; ++strip) {
    const float across =
        overlap(patch.y, patch.width, strip->from + 0.5f * border_, strip->to - 0.5f * border_);
    if (across == 0) continue;
    for (auto field = firstFrom(strip->fields, near); field != strip->fields.end() && field->from < far;
         ++field) {
      if (++looked_at > kMost) return {share, mean_, contrast_, share == 1};
      const float along =
          overlap(patch.x, patch.length, field->from + 0.5f * border_, field->to - 0.5f * border_);
      if (along == 0) continue;
      inner += across * along;
      light += across * along * crop(*field, patch);
      one = across * along == 1;
    }
  }
  const float border = std::max(share - inner, 0.0f);
  const float grey = (light + border * border_brightness_) / (inner + border);
  return {share, grey, contrast_, one || (share == 1 && inner == 0)};
}

}  // namespace uav_landing
