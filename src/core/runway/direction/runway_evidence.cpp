#include "runway/direction/runway_evidence.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;
constexpr double kSameEdge = 0.04;     // share of the width; lines this close to an edge belong to it
constexpr double kLeastExtent = 0.14;  // least log(far / near) of both edges

// Evidence of the lines.
constexpr double kEnoughOfEdges = 14;  // limit, as more lines along the edges do not make it more of a runway
constexpr double kEnoughMarks = 10;    // limit for marks
constexpr double kRoadMarks = 4;       // limit for marks that roads have as well, against the path
// Least number of sides of bars. An aiming point has four, and the lanes of a road have fewer.
constexpr size_t kFewestBars = 4;
constexpr double kAstray = 1.2;                 // penalty for each line between the edges that no runway has
constexpr double kMiddle = 0.08, kSide = 0.15;  // shares of the width for centre line and side stripes
constexpr double kLane = 0.5;                   // share of the length; a longer line is no mark
constexpr double kSameEnd = 0.03;    // share of the distance; lines this close to an end count as at it
constexpr double kUnbroken = 2;      // factor for the log of the share of an edge that is seen
constexpr double kLeastSeen = 0.05;  // least share of an edge, for that log
constexpr double kSlender = 3;       // factor for the log of the missing length
constexpr double kUsualLength = 6;   // in widths; the visible part of a runway is longer
constexpr double kEnoughExtent = 2;  // limit of log(far / near)
// Evidence of lines that a runway may have beside it: taxiways, roads, edges of grass.
constexpr double kUsualBeside = 30;
constexpr double kTelling = 1;  // least evidence of a line that counts as beside the object

// Evidence from earlier knowledge.
constexpr double kMostOff = 10;             // largest penalty for ground, path, or chart
constexpr double kMostTurned = 6;           // largest penalty for a turn since the previous pair
constexpr double kPathSigma = 3 * kDegree;  // 1 sigma between path and runway, from wind and corrections
// Largest margin of a strip without bars that the path leads along. In about one of a thousand approaches
// such a strip is a road. That road is as near to the path in direction (6 of 60 degrees) and at the side,
// and no runway is in view.
constexpr double kBareStrip = 7.3;
// An approach crosses the near end at about kCrossing, and may come down as steeply as kGlide.
constexpr double kCrossing = 15, kCrossingSigma = 20;  // m; a long runway may be landed on beyond its begin
constexpr double kGlide = 6 * kDegree;
constexpr double kSteepest = 60 * kDegree;    // angle between path and runway above which nothing is known
constexpr double kStepSigma = 0.7 * kDegree;  // 1 sigma of the camera's turn between pairs
constexpr double kSizeSigma = 0.06;           // 1 sigma of the size that is seen, as a share of the size
constexpr double kStripe = 0.9;               // m
constexpr double kSameByChance = 0.25;        // of other objects are about as wide as the chart's runway
constexpr double kFarSigma = 0.05 * kDegree;  // 1 sigma of the angle between the far end and the horizon

double penalty(double off, double variance, double most) {
  return std::min(most, 0.5 * off * off / variance);
}

/// The lines along one edge, with their ends and their evidence.
struct Edge {
  std::vector<size_t> pieces;
  double near = std::numeric_limits<double>::infinity(), far = 0;
  double evidence = 0;
};

Edge edgeAt(const LinePencil& p, double lateral, double slack) {
  Edge edge;
  for (size_t k = 0; k < p.passes.size(); ++k) {
    if (p.passes[k] == 0 || std::abs(p.places[k]->lateral - lateral) >= slack) continue;
    edge.pieces.push_back(k);
    edge.near = std::min(edge.near, p.places[k]->near);
    edge.far = std::max(edge.far, p.places[k]->far);
    edge.evidence += p.evidence[k];
  }
  return edge;
}

/// log(far / near) of the visible part of an edge, within the range where both edges are seen. Overlapping
/// pieces count once.
double seenLength(const LinePencil& p, const Edge& edge, const RunwayHypothesis& h) {
  std::vector<std::pair<double, double>> pieces;
  for (const size_t k : edge.pieces)
    pieces.emplace_back(std::max(p.places[k]->near, h.near), std::min(p.places[k]->far, h.far));
  std::sort(pieces.begin(), pieces.end());
  double length = 0, end = h.near;
  for (const auto& [near, far] : pieces) {
    const double begin = std::max(near, end);
    if (far <= begin) continue;
    length += std::log(far / begin);
    end = far;
  }
  return length;
}

/// Evidence of a long object with unbroken edges. seen: visible length of the less visible edge.
double ofShape(const RunwayHypothesis& h, double seen) {
  const double extent = std::log(h.far / h.near), lengths = (h.far - h.near) / h.width();
  return kUnbroken * std::log(std::max(seen / extent, kLeastSeen)) +
         kSlender * std::min(0.0, std::log(lengths / kUsualLength)) + std::min(extent, kEnoughExtent);
}

/// Whether a line runs between the middle and the sides, where a runway has bars.
bool isAmongBars(const LinePencil& p, size_t k, const RunwayHypothesis& h) {
  const double across = std::abs((p.places[k]->lateral - h.right) / h.width() - 0.5);  // 0: middle, 0.5: edge
  return across > kMiddle && across < 0.5 - kSide;
}

/// Whether a line is too long for a bar.
bool isLong(const LinePencil& p, size_t k, const RunwayHypothesis& h) {
  const double length = std::log(std::min(p.places[k]->far, h.far) / std::max(p.places[k]->near, h.near));
  return length > kLane * std::log(h.far / h.near);
}

/// Lines between the edges: evidence of bars and of other marks, and the number of lines that no runway has.
struct Surface {
  double bars = 0, others = 0;
  int astray = 0;
};

/// Number of places that are not the same.
size_t countApart(std::vector<double> places, double slack) {
  std::sort(places.begin(), places.end());
  const auto same = [slack](double a, double b) { return b - a < slack; };
  return static_cast<size_t>(std::unique(places.begin(), places.end(), same) - places.begin());
}

/// Evaluates the lines between the edges, and adds those along the runway to the members.
Surface surfaceOf(const GroundLines& lines, const LinePencil& p, double slack, RunwayHypothesis& h) {
  Surface found;
  std::vector<double> bars;
  for (size_t k = 0; k < p.passes.size(); ++k) {
    if (!p.places[k] || p.places[k]->lateral > h.left + slack || p.places[k]->lateral < h.right - slack)
      continue;
    if (p.places[k]->far < (1 - kSameEnd) * h.near || p.places[k]->near > (1 + kSameEnd) * h.far) {
      h.members[k] = 0;
    } else if (p.passes[k] == 0) {
      found.astray += lines.isAcross(static_cast<int>(k)) ? 0 : 1;
    } else if (h.members[k] == 0) {
      h.members[k] = 1;
      if (!isAmongBars(p, k, h)) {
        found.others += p.evidence[k];
      } else if (isLong(p, k, h)) {
        ++found.astray;
      } else {
        found.bars += p.evidence[k];
        bars.push_back(p.places[k]->lateral);
      }
    }
  }
  if (countApart(bars, slack) < kFewestBars) found.others += std::exchange(found.bars, 0);
  return found;
}

/// Whether two lines are pieces of one. Then they are in line with each other, and not side by side, however
/// close.
bool arePieces(const LinePlace& a, const LinePlace& b, double slack) {
  return std::abs(a.lateral - b.lateral) < slack && std::min(a.far, b.far) <= std::max(a.near, b.near);
}

/// Evidence that the object is one of many side by side. Streets, crop rows and roofs come in rows; runways
/// do not. In a row it is no surprise that lines point to the same place. So each line beside the object
/// takes away as much as one line of the object adds, up to all of it.
double ofRow(const LinePencil& p, double slack, const RunwayHypothesis& h) {
  std::vector<LinePlace> places;
  double beside = 0;
  for (size_t k = 0; k < p.passes.size(); ++k) {
    if (p.evidence[k] < kTelling) continue;
    const LinePlace& place = *p.places[k];
    if (place.lateral <= h.left + slack && place.lateral >= h.right - slack) continue;
    const bool known = std::any_of(places.begin(), places.end(),
                                   [&](const LinePlace& other) { return arePieces(place, other, slack); });
    if (known) continue;
    places.push_back(place);
    beside += p.evidence[k];
  }
  return std::max(0.0, beside - kUsualBeside);
}

}  // namespace

std::optional<RunwayHypothesis> runwayBetween(const GroundLines& lines, const LinePencil& p, double left,
                                              double right) {
  RunwayHypothesis h;
  h.left = left;
  h.right = right;
  if (!(h.width() > 0)) return std::nullopt;
  const double slack = kSameEdge * h.width();
  const Edge left_edge = edgeAt(p, left, slack), right_edge = edgeAt(p, right, slack);
  h.near = std::max(left_edge.near, right_edge.near);
  h.far = std::min(left_edge.far, right_edge.far);
  if (!(h.near > 0) || !(std::log(h.far / h.near) > kLeastExtent)) return std::nullopt;
  h.members.assign(p.passes.size(), 0);
  for (const Edge* edge : {&left_edge, &right_edge})
    for (const size_t k : edge->pieces) h.members[k] = 1;
  const Surface surface = surfaceOf(lines, p, slack, h);
  const double row = ofRow(p, slack, h);
  const double marks = std::min(surface.bars + surface.others, kEnoughMarks);
  const double pointing = std::min(left_edge.evidence + right_edge.evidence, kEnoughOfEdges) + marks;
  h.marks = std::max(0.0, std::min(surface.bars + std::min(surface.others, kRoadMarks), kEnoughMarks) - row);
  h.evidence = std::max(0.0, pointing - row) - kAstray * surface.astray +
               ofShape(h, std::min(seenLength(p, left_edge, h), seenLength(p, right_edge, h)));
  return h;
}

double azimuthOn(const Eigen::Vector3d& normal, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d forward = (Eigen::Vector3d::UnitZ() - normal.z() * normal).normalized();
  return std::atan2(direction.dot(forward.cross(normal)), direction.dot(forward));
}

double againstHorizon(const Eigen::Vector3d& direction, const RunwayPrior& prior) {
  return penalty(prior.normal.dot(direction), direction.dot(prior.normal_covariance * direction), kMostOff);
}

/// Height of the path over the near end beyond that of an approach, over its 1 sigma. A road below the
/// aircraft begins too near for it to land there.
double tooHigh(const RunwayHypothesis& h, const RunwayPrior& prior) {
  if (!prior.height) return 0;
  const double down = std::max(std::asin(std::min(prior.normal.dot(*prior.path), 1.0)), kGlide);
  return std::max(0.0, *prior.height * (1 - h.near * std::tan(down)) - kCrossing) / kCrossingSigma;
}

double againstPath(const RunwayHypothesis& h, const RunwayPrior& prior) {
  if (!prior.path) return 0;
  const double aside = azimuthOn(prior.normal, *prior.path) - azimuthOn(prior.normal, h.direction);
  const double passes = h.near * std::tan(std::clamp(aside, -kSteepest, kSteepest));  // left of the camera
  const double beside = std::atan(std::max({0.0, passes - h.left, h.right - passes}) / h.near);
  const double above = tooHigh(h, prior);
  return std::min(kMostOff,
                  0.5 * ((aside * aside + beside * beside) / (kPathSigma * kPathSigma) + above * above));
}

double mostOfMargin(const RunwayHypothesis& h, const RunwayPrior& prior) {
  if (!prior.path) return std::numeric_limits<double>::infinity();
  return kBareStrip + h.marks - againstPath(h, prior);
}

double againstTurn(const Eigen::Vector3d& direction, const RunwayPrior& prior) {
  if (!prior.last) return 0;
  const double turn = azimuthOn(prior.normal, direction) - azimuthOn(prior.normal, *prior.last);
  return penalty(turn, kStepSigma * kStepSigma, std::min(kMostTurned, -std::log(prior.last_doubt)));
}

double againstSize(const RunwayHypothesis& h, const RunwayPrior& prior) {
  const RunwayParameters& runway = prior.runway;
  if (!prior.height) return 0;
  double sum = 0;
  if (runway.length > 0) {
    // The far end is less certain when it is closer to the horizon.
    const double length = (h.far - h.near) * *prior.height,
                 far_sigma = kFarSigma * h.far * h.far / (h.far - h.near);
    const double longer = std::max(0.0, std::log(length / runway.length));
    sum += penalty(longer, kSizeSigma * kSizeSigma + far_sigma * far_sigma, kMostOff);
  }
  if (runway.width > 0) {
    // A dark surface shows between the inner sides of its stripes.
    const double width = h.width() * *prior.height,
                 between_stripes =
                     std::max(0.1 * runway.width, runway.width - 2 * (runway.largestInset() + kStripe));
    const double off = std::max({0.0, std::log(width / runway.width), std::log(between_stripes / width)});
    const double by_chance = std::log(kSameByChance);
    sum += penalty(off, kSizeSigma * kSizeSigma, kMostOff - by_chance) + by_chance;
  }
  return sum;
}

}  // namespace uav_landing
