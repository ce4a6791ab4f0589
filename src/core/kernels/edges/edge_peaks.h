#pragma once

#include <array>
#include <cmath>
#include <opencv2/core.hpp>

#include "kernels/samples/line_sums.h"

namespace uav_landing {

/// A line crosses rows of pixels, the stations, at one place each. Edges are looked for there, among the
/// pixels of the station. (Stations may also be columns: of the image with rows and columns exchanged.)
///
/// Equally spaced stations.
struct Stations {
  int first, step, count;

  int at(int i) const { return first + i * step; }
};

/// The strongest gradient at a station: its place, and twice its value and its neighbours' values.
struct StationEdge {
  int station, place;
  int twice, before, after;
};

/// Place of an edge along and across a line, px, and its gradient across the line, grey/px.
struct EdgePeak {
  double along, across, gradient;
};

/// A line's axes by their parts down the stations (major) and along each station (minor).
struct LineAxes {
  double origin_major, origin_minor, along_major, along_minor, across_major, across_minor;
  double scale;  ///< gradient across the line of one grey level along a station; it has the sign of
                 ///< across_minor

  /// Place of the peak, interpolated by a parabola.
  [[gnu::always_inline]] inline EdgePeak peakOf(const StationEdge& edge) const {
    const double top = 0.5 * (edge.before - edge.after) / (edge.before - 2 * edge.twice + edge.after);
    const double major = edge.station - origin_major, minor = edge.place + top - origin_minor;
    return {along_major * major + along_minor * minor, across_major * major + across_minor * minor,
            std::abs(scale) * edge.twice};
  }
};

/// Edges at stations by columns, filled up to whole groups. Without an edge the numbers mean nothing.
struct EdgeColumns {
  static constexpr int kAtOnce = 8;  ///< stations of a group
  static constexpr int kMost = kMostLineSamples;
  using Column = std::array<short, kMost>;

  std::array<int, kMost> centre;  ///< pixel nearest to the line
  Column place;                   ///< of the edge, from the centre
  Column twice, before, after;
  Column found;  ///< whether there is an edge: 1 or 0
};

/// Sets the centres of stations that a line crosses at first + slope station, rounded as by cvRound().
void setCentres(const Stations& stations, double first, double slope, EdgeColumns& edges);

/// Sets the edges at some stations, up to whole groups. pixels: the centre pixel of each station, with four
/// readable pixels on each side; all of one grey for a station without an edge. The edge is the largest
/// gradient, times sign, within reach px (1 or 2) of the centre; of equal ones the first. There is none when
/// the gradient grows on beyond the reach, or when twice the gradient is below least.
void findEdges(const uchar* const* pixels, int stations, int reach, short sign, short least,
               EdgeColumns& edges);

/// Peaks of the edges at all stations, whether there is an edge or not, up to whole lanes.
void findPeaks(const EdgeColumns& edges, const Stations& stations, const LineAxes& line, float* along,
               float* across, float* gradient);

/// Moves the peaks of stations with an edge to the front and returns their number.
int keepFound(const EdgeColumns& edges, int stations, float* along, float* across, float* gradient);

}  // namespace uav_landing
