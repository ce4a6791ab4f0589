#include "simulator/ground/paved_layer.h"

#include <algorithm>
#include <cmath>

namespace uav_landing {
namespace {

/// The frame at the near end of a strip that is given by its middle.
template <class Strip>
GroundFrame frameOf(const Strip& strip) {
  const double direction = strip.direction_deg * M_PI / 180;
  return {strip.x - 0.5 * strip.length * std::cos(direction),
          strip.y - 0.5 * strip.length * std::sin(direction), strip.direction_deg};
}

SimulatedRunwayParameters plain(const SimulatedStripParameters& strip) {
  SimulatedRunwayParameters p;
  p.length = strip.length;
  p.width = strip.width;
  p.edge_line_width = strip.edge_line_width;
  p.edge_line_inset = std::min(0.3, 0.1 * strip.width);
  p.centre_line_width = strip.centre_line_width;
  p.centre_dash_length = strip.centre_dash_length;
  p.centre_gap_length = strip.centre_gap_length;
  p.centre_line_start = 0;
  p.threshold_line_width = 0;
  p.threshold_bars = 0;
  p.aiming_point_length = 0;
  return p;
}

/// Marks of the main runway on another one of this size. A mark without room is left out.
SimulatedRunwayParameters fitted(const SimulatedCrossingParameters& crossing,
                                 const SimulatedRunwayParameters& main) {
  SimulatedRunwayParameters p = main;
  p.length = crossing.length;
  p.width = crossing.width;
  p.displaced_threshold = 0;
  const double inside = 0.5 * p.width - p.edge_line_inset - p.edge_line_width;
  if (inside <= 0) p.edge_line_width = p.threshold_line_width = 0;
  const double room = inside - 0.5 * p.threshold_centre_gap + p.threshold_bar_gap;
  const double pitch = p.threshold_bar_width + p.threshold_bar_gap;
  if (pitch > 0) p.threshold_bars = std::clamp(static_cast<int>(room / pitch), 0, p.threshold_bars);
  const bool wide = 0.5 * p.aiming_point_gap + p.aiming_point_width <= inside;
  const bool long_enough = p.aiming_point_distance + p.aiming_point_length <= 0.5 * p.length;
  if (!wide || !long_enough) p.aiming_point_length = 0;
  return p;
}

}  // namespace

PavedLayer::PavedLayer(const SimulatedStripParameters& strip)
    : frame_(frameOf(strip)),
      surface_(plain(strip)),
      brightness_(strip.brightness),
      line_brightness_(strip.line_brightness),
      contrast_(strip.contrast) {}

PavedLayer::PavedLayer(const SimulatedCrossingParameters& crossing, const SimulatedRunwayParameters& main,
                       const SimulatedSurfaceParameters& surface)
    : frame_(frameOf(crossing)),
      surface_(fitted(crossing, main)),
      brightness_(surface.runway_brightness),
      line_brightness_(surface.marking_brightness),
      contrast_(surface.runway_contrast) {}

LayerCover PavedLayer::cover(const GroundFootprint& footprint) const {
  const RunwaySurface::Cover cover = surface_.cover(footprint.in(frame_));
  if (cover.runway == 0) return {};
  const float painted = cover.paint / cover.runway;
  return {cover.runway, brightness_ + painted * (line_brightness_ - brightness_), contrast_, cover.pure()};
}

}  // namespace uav_landing
