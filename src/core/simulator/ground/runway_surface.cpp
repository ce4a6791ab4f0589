#include "simulator/ground/runway_surface.h"

#include <algorithm>
#include <cmath>

namespace uav_landing {

RunwaySurface::RunwaySurface(const SimulatedRunwayParameters& p)
    : length_(p.length),
      displaced_(p.displaced_threshold),
      half_width_(0.5 * p.width),
      centre_half_width_(0.5 * p.centre_line_width),
      centre_start_(p.centre_line_start),
      dash_(p.centre_dash_length),
      period_(p.centre_dash_length + p.centre_gap_length) {
  const auto interval = [](double from, double to) {
    return Interval{static_cast<float>(from), static_cast<float>(to)};
  };
  const auto bothSides = [&](Mark& mark, double from, double to) {
    mark.across.push_back(interval(from, to));
    mark.across.push_back(interval(-to, -from));
  };
  const double half = 0.5 * p.width, line = half - p.edge_line_inset;
  if (p.edge_line_width > 0) {
    marks_.push_back({interval(-p.displaced_threshold, p.length), {}});
    bothSides(marks_.back(), line - p.edge_line_width, line);
  }
  if (p.threshold_line_width > 0)  // between the edge lines, so that nothing is painted twice
    marks_.push_back({interval(0, p.threshold_line_width),
                      {interval(-line + p.edge_line_width, line - p.edge_line_width)}});
  if (p.threshold_bars > 0 && p.threshold_bar_length > 0) {
    marks_.push_back({interval(p.threshold_bars_start, p.threshold_bars_start + p.threshold_bar_length), {}});
    for (int bar = 0; bar < p.threshold_bars; ++bar) {
      const double inner = 0.5 * p.threshold_centre_gap + bar * (p.threshold_bar_width + p.threshold_bar_gap);
      bothSides(marks_.back(), inner, inner + p.threshold_bar_width);
    }
  }
  if (p.aiming_point_length > 0 && p.aiming_point_width > 0) {
    marks_.push_back(
        {interval(p.aiming_point_distance, p.aiming_point_distance + p.aiming_point_length), {}});
    bothSides(marks_.back(), 0.5 * p.aiming_point_gap, 0.5 * p.aiming_point_gap + p.aiming_point_width);
  }
  if (p.centre_line_width > 0) addArrowShafts(p);
}

void RunwaySurface::addArrowShafts(const SimulatedRunwayParameters& p) {
  constexpr double kPitch = 60, kShaft = 25, kFree = 5;  // m; the last arrow ends kFree before the threshold
  const auto half = static_cast<float>(0.5 * p.centre_line_width);
  for (double end = -kFree; end - kShaft >= -p.displaced_threshold; end -= kPitch)
    marks_.push_back({{static_cast<float>(end - kShaft), static_cast<float>(end)}, {{-half, half}}});
}

float RunwaySurface::centreLine(const Patch& patch) const {
  const float across = overlap(patch.y, patch.width, -centre_half_width_, centre_half_width_);
  if (across == 0.0f) return 0.0f;
  const float end = std::max(length_ - centre_start_, centre_start_);
  const float from = std::clamp(patch.x - 0.5f * patch.length, centre_start_, end) - centre_start_;
  const float to = std::clamp(patch.x + 0.5f * patch.length, centre_start_, end) - centre_start_;
  return across * (dashesUpTo(to, dash_, period_) - dashesUpTo(from, dash_, period_)) / patch.length;
}

float RunwaySurface::paint(const Patch& patch) const {
  float covered = centreLine(patch);
  const float x = std::min(patch.x, length_ - patch.x);
  for (const Mark& mark : marks_) {
    const float along = overlap(x, patch.length, mark.along.from, mark.along.to);
    if (along == 0.0f) continue;
    float across = 0;
    for (const Interval& interval : mark.across)
      across += overlap(patch.y, patch.width, interval.from, interval.to);
    covered += along * across;
  }
  return std::min(covered, 1.0f);
}

RunwaySurface::Cover RunwaySurface::cover(const Patch& patch) const {
  const float runway = overlap(patch.x, patch.length, -displaced_, length_ + displaced_) *
                       overlap(patch.y, patch.width, -half_width_, half_width_);
  if (runway == 0.0f) return {0.0f, 0.0f};
  return {runway, std::min(paint(patch), runway)};
}

}  // namespace uav_landing
