#include "runway/direction/runway_evidence.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;
constexpr double kSameEdge = 0.04;     // of the width: lines this near to an edge are its pieces
constexpr double kLeastExtent = 0.14;  // log(far / near) of both edges

// Evidence by the lines.
constexpr double kEnoughOfEdges = 14;  // more lines along the edges do not make it more of a runway
constexpr double kEnoughMarks = 10;    // nor do more marks
constexpr double kAstray = 1.2;        // against it, for each line between the edges that no runway has
constexpr double kMiddle = 0.08, kSide = 0.15;  // of the width: centre line, side stripes
constexpr double kLane = 0.5;                   // of the length, from which on a line is long
constexpr double kSameEnd = 0.03;               // of the distance: lines this near to an end are at it
constexpr double kUnbroken = 2;                 // per log of the share of an edge that is seen
constexpr double kLeastSeen = 0.05;             // of an edge
constexpr double kSlender = 3;                  // per log of the length that is missing
constexpr double kUsualLength = 6;              // widths; a runway is longer, even the part in view
constexpr double kEnoughExtent = 2;             // log(far / near)
constexpr double kUsualBeside = 30;  // evidence of lines beside a runway: taxiways, roads, edges of grass
constexpr double kTelling = 1;       // least evidence of a line that counts as lying beside an object

// Evidence by what is known besides.
constexpr double kMostOff = 10;             // against it at most, for ground, path, or chart
constexpr double kMostTurned = 6;           // for the pair before
constexpr double kPathSigma = 3 * kDegree;  // between path and runway: wind and corrections
// For a strip without marks that the path leads along. Of a thousand approaches about one has a road there:
// as near to the path in direction (6 of 60 degrees), as near to its side, and a runway that is not in view.
constexpr double kBareStrip = 7.3;
constexpr double kSteepest = 60 * kDegree;    // between both, beyond which nothing is known
constexpr double kStepSigma = 0.7 * kDegree;  // by which the camera turns between pairs
constexpr double kSizeSigma = 0.06;           // share of its size by which a runway seems to be another
constexpr double kFarSigma = 0.05 * kDegree;  // of the angle between the far end and the horizon

double penalty(double off, double variance, double most) {
  return std::min(most, 0.5 * off * off / variance);
}

/// The lines along one edge.
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

/// log(far / near) of what is seen of an edge where both are: the union of its pieces.
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

/// A long object whose edges are not broken. seen: length of the edge that shows less.
double ofShape(const RunwayHypothesis& h, double seen) {
  const double extent = std::log(h.far / h.near), lengths = (h.far - h.near) / h.width();
  return kUnbroken * std::log(std::max(seen / extent, kLeastSeen)) +
         kSlender * std::min(0.0, std::log(lengths / kUsualLength)) + std::min(extent, kEnoughExtent);
}

/// Whether a line runs along the runway for long between its middle and its sides, where nothing is painted.
bool isLane(const LinePencil& p, size_t k, const RunwayHypothesis& h) {
  const double across = std::abs((p.places[k]->lateral - h.right) / h.width() - 0.5);  // 0: middle, 0.5: edge
  const double length = std::log(std::min(p.places[k]->far, h.far) / std::max(p.places[k]->near, h.near));
  return across > kMiddle && across < 0.5 - kSide && length > kLane * std::log(h.far / h.near);
}

/// What lies between the edges: evidence of marks, and lines that no runway has.
struct Surface {
  double marks = 0;
  int astray = 0;
};

/// Adds what runs along the runway there to the members.
Surface surfaceOf(const GroundLines& lines, const LinePencil& p, double slack, RunwayHypothesis& h) {
  Surface found;
  for (size_t k = 0; k < p.passes.size(); ++k) {
    if (!p.places[k] || p.places[k]->lateral > h.left + slack || p.places[k]->lateral < h.right - slack)
      continue;
    if (p.places[k]->far < (1 - kSameEnd) * h.near || p.places[k]->near > (1 + kSameEnd) * h.far) {
      h.members[k] = 0;
    } else if (p.passes[k] == 0) {
      found.astray += lines.isAcross(static_cast<int>(k)) ? 0 : 1;
    } else if (h.members[k] == 0) {
      h.members[k] = 1;
      if (isLane(p, k, h))
        ++found.astray;
      else
        found.marks += p.evidence[k];
    }
  }
  return found;
}

/// Whether two lines are pieces of one: in line, and not side by side, however close together.
bool arePieces(const LinePlace& a, const LinePlace& b, double slack) {
  return std::abs(a.lateral - b.lateral) < slack && std::min(a.far, b.far) <= std::max(a.near, b.near);
}

/// For one of many objects side by side. Streets, crop rows and roofs come in rows, runways do not. That a
/// row's lines point there is no wonder: each line beside the object says of the row what one of the object
/// says of the runway, and at most it takes all that.
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
  h.marks = std::min(surface.marks, kEnoughMarks);
  const double pointing = std::min(left_edge.evidence + right_edge.evidence, kEnoughOfEdges) + h.marks;
  h.marks = std::max(0.0, h.marks - row);
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

double againstPath(const RunwayHypothesis& h, const RunwayPrior& prior) {
  if (!prior.path) return 0;
  const double aside = azimuthOn(prior.normal, *prior.path) - azimuthOn(prior.normal, h.direction);
  const double passes = h.near * std::tan(std::clamp(aside, -kSteepest, kSteepest));  // left of the camera
  const double beside = std::atan(std::max({0.0, passes - h.left, h.right - passes}) / h.near);
  return std::min(kMostOff, 0.5 * (aside * aside + beside * beside) / (kPathSigma * kPathSigma));
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
    // The far end is the less certain the nearer it is to the horizon.
    const double length = (h.far - h.near) * *prior.height,
                 far_sigma = kFarSigma * h.far * h.far / (h.far - h.near);
    const double longer = std::max(0.0, std::log(length / runway.length));
    sum += penalty(longer, kSizeSigma * kSizeSigma + far_sigma * far_sigma, kMostOff);
  }
  if (runway.width > 0) {
    const double width = h.width() * *prior.height, stripes = runway.width - 2 * runway.largestInset();
    const double off = std::max({0.0, std::log(width / runway.width), std::log(stripes / width)});
    sum += penalty(off, kSizeSigma * kSizeSigma, kMostOff);
  }
  return sum;
}

}  // namespace uav_landing
