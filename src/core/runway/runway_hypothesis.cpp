#include "runway/runway_hypothesis.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "base/text.h"
#include "estimation/limits.h"
#include "lines/vanishing_candidate.h"
#include "lines/vanishing_chance.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;
constexpr double kLeastCrossing = 3 * kDegree;  // in the picture, between two edges
constexpr double kLeastSlope = 1e-3;            // n.r of the horizon's neighbourhood
constexpr double kFarOff = 5 * kDegree;         // from the horizon: not on the ground
constexpr double kSameEdge = 0.04;              // of the width: lines this near to an edge are its pieces
constexpr double kLeastExtent = 0.14;           // log(far / near) of both edges
constexpr double kAcross = 12 * kDegree;        // of the horizon: lines of a threshold, in the picture
constexpr double kStraightness = 1.0;           // px by which an edge may differ from a straight line
constexpr Sigmas kGate(4);                      // of a line's own errors
constexpr double kOther = 1 * kDegree;          // between directions of two runways
constexpr double kPathSigma = 3 * kDegree;      // between path and runway: wind and corrections
constexpr double kStepSigma = 0.7 * kDegree;    // by which the camera turns between pairs
constexpr double kSizeSigma = 0.06;             // share of the runway's size by which it seems to be another
constexpr double kFarSigma = 0.05 * kDegree;    // of the angle between the far end and the horizon

// Evidence.
constexpr double kRunwayShare = 0.25;  // of the lines that point there, that are the runway's
constexpr double kEnoughOfEdges = 14;  // more lines along the edges do not make it more of a runway
constexpr double kEnoughInside = 10;   // nor do more marks
constexpr double kAstray = 1.2;        // against it, for each line between the edges that runs elsewhere
constexpr double kMiddle = 0.08, kSide = 0.15;  // of the width: centre line, side stripes
constexpr double kLane = 0.5;                   // of the length
constexpr double kUnbroken = 2;                 // per log of the share of an edge that is seen
constexpr double kLeastSeen = 0.05;             // of an edge
constexpr double kSlender = 3;                  // per log of the length that is missing
constexpr double kEnoughExtent = 2;             // log(far / near)
constexpr double kSameEnd = 0.03;               // of the distance: lines this near to an end are at it
constexpr double kUsualLength = 6;              // widths; a runway is longer, even the part in view
constexpr double kUsualBeside = 30;  // evidence of lines beside a runway: taxiways, roads, edges of grass
constexpr double kRow = 0.3;    // evidence against an object, per evidence of lines beside it above the usual
constexpr double kTelling = 1;  // least evidence of a line that counts as lying beside an object
constexpr double kMostOfRow = 15;  // against a street or a crop row at most
constexpr double kByChance = 4;    // of two lines that meet somewhere, as any two do
constexpr double kMostOff = 10;    // against it at most, for ground, path, or chart
constexpr double kMostTurned = 6;  // for the pair before

struct Interval {
  double begin, end;
};

/// Length of the union of intervals. Sorts them.
double lengthOfUnion(std::vector<Interval>& intervals) {
  std::sort(intervals.begin(), intervals.end(),
            [](const Interval& a, const Interval& b) { return a.begin < b.begin; });
  double length = 0, end = -1e9;
  for (const Interval& i : intervals) {
    length += std::max(0.0, i.end - std::max(i.begin, end));
    end = std::max(end, i.end);
  }
  return length;
}

/// A line as all hypotheses need it.
struct GroundLine {
  VanishingCandidate line;
  Eigen::Vector3d a, b, middle;  ///< rays of its ends and its middle
  Eigen::Vector3d plane;         ///< normal of the plane through camera and line
  double azimuth;                ///< on the ground, left of the axis, rad
  double tolerance;              ///< px by which its ends may miss the point where it vanishes
  bool on_ground;                ///< below the horizon
  bool ahead;                    ///< and may run along a runway
  bool across;                   ///< or may be of a threshold
};

/// The ground that has a direction in it.
struct GroundAlong {
  Eigen::Vector3d direction, down, left;

  GroundAlong(const Eigen::Vector3d& normal, const Eigen::Vector3d& towards)
      : direction(towards),
        down((normal - normal.dot(towards) * towards).normalized()),
        left(towards.cross(down)) {}

  double lateral(const GroundLine& line) const {
    return left.dot(line.middle) / std::max(down.dot(line.middle), kLeastSlope);
  }
  /// Nearest and farthest place.
  std::pair<double, double> forward(const GroundLine& line) const {
    return std::minmax({direction.dot(line.a) / std::max(down.dot(line.a), kLeastSlope),
                        direction.dot(line.b) / std::max(down.dot(line.b), kLeastSlope)});
  }
};

/// The lines along one edge of a hypothesis.
struct Edge {
  std::vector<size_t> pieces;
  double near = std::numeric_limits<double>::infinity(), far = 0;  ///< in heights
  double evidence = 0;
};

/// The lines as one direction has them.
struct Pencil {
  std::vector<double> lateral, near, far;  ///< per line, in heights
  std::vector<double> evidence;            ///< per line that passes; 0 where it does not
  std::vector<char> passes;
};

class Search {
 public:
  Search(const std::vector<LineSegment>& lines, const Eigen::Matrix3d& K, const RunwayPrior& prior,
         double tolerance)
      : K_(K), Kinv_(K.inverse()), prior_(prior) {
    forward_ = (Eigen::Vector3d::UnitZ() - prior.normal.z() * prior.normal).normalized();
    left_ = forward_.cross(prior.normal);
    const Eigen::Vector3d horizon = Kinv_.transpose() * prior.normal;
    horizon_ = Eigen::Vector2d(horizon.y(), -horizon.x()).normalized();
    for (const LineSegment& line : lines) add(line, tolerance);
  }

  std::vector<RunwayHypothesis> all() const {
    std::vector<RunwayHypothesis> found;
    for (size_t i = 0; i < lines_.size(); ++i) {
      if (!lines_[i].ahead) continue;
      for (size_t j = 0; j < i; ++j) {
        const auto direction = lines_[j].ahead ? meeting(lines_[i], lines_[j]) : std::nullopt;
        if (!direction) continue;
        if (const auto hypothesis = between(i, j, *direction)) found.push_back(*hypothesis);
      }
    }
    return found;
  }

  double azimuth(const Eigen::Vector3d& direction) const {
    return std::atan2(direction.dot(left_), direction.dot(forward_));
  }

 private:
  void add(const LineSegment& segment, double tolerance) {
    GroundLine line{VanishingCandidate(segment),
                    Kinv_ * segment.a.homogeneous(),
                    Kinv_ * segment.b.homogeneous(),
                    Kinv_ * segment.middle().homogeneous(),
                    K_.transpose() * segment.line,
                    0,
                    0,
                    false,
                    false,
                    false};
    line.tolerance = std::min(std::max(kStraightness, kGate.bound(line.line.endVariance())), tolerance);
    line.azimuth = azimuthOf(line.plane);
    line.on_ground = std::min(prior_.normal.dot(line.a), prior_.normal.dot(line.b)) > kLeastSlope;
    line.ahead = line.on_ground && std::abs(line.azimuth) < prior_.max_yaw;
    line.across = std::abs(line.line.along.dot(horizon_)) > std::cos(kAcross);
    lines_.push_back(line);
  }

  double azimuthOf(const Eigen::Vector3d& plane) const {
    Eigen::Vector3d along = plane.cross(prior_.normal);
    if (along.dot(forward_) < 0) along = -along;
    return azimuth(along);
  }

  /// Where two lines meet, if that may be the end of a runway.
  std::optional<Eigen::Vector3d> meeting(const GroundLine& a, const GroundLine& b) const {
    const Eigen::Vector2d &p = a.line.along, &q = b.line.along;
    if (std::abs(p.x() * q.y() - p.y() * q.x()) < std::sin(kLeastCrossing)) return std::nullopt;
    Eigen::Vector3d direction = a.plane.cross(b.plane).normalized();
    if (direction.z() < 0) direction = -direction;
    if (!direction.allFinite() || std::abs(prior_.normal.dot(direction)) > std::sin(kFarOff))
      return std::nullopt;
    if (std::abs(azimuth(direction)) > prior_.max_yaw) return std::nullopt;
    return direction;
  }

  Pencil pencil(const GroundAlong& ground) const {
    const Eigen::Vector3d V = K_ * ground.direction;
    const double per_pixel = V.z() / (Kinv_ * V).squaredNorm();
    Pencil pencil;
    const size_t count = lines_.size();
    pencil.lateral.resize(count);
    pencil.near.resize(count);
    pencil.far.resize(count);
    pencil.evidence.assign(count, 0);
    pencil.passes.assign(count, 0);
    for (size_t i = 0; i < count; ++i) {
      const GroundLine& l = lines_[i];
      if (!l.on_ground) continue;
      pencil.lateral[i] = ground.lateral(l);
      std::tie(pencil.near[i], pencil.far[i]) = ground.forward(l);
      const double miss2 = l.ahead ? l.line.endMiss2(V) / (l.tolerance * l.tolerance) : 2;
      if (!(miss2 < 1)) continue;
      pencil.passes[i] = 1;
      const double sine = std::abs(l.line.along.x() * horizon_.y() - l.line.along.y() * horizon_.x());
      const double turn = l.tolerance / l.line.half * l.line.towards(V).norm() * per_pixel /
                          (K_(0, 0) * std::max(sine, 1e-6));
      const double chance = std::min(1.0, std::max(1e-4, chanceWithin(turn)));
      pencil.evidence[i] = std::log(1 - kRunwayShare + kRunwayShare / chance) * (1 - miss2);
    }
    return pencil;
  }

  /// Whether two lines that vanish there are as far apart, and seen side by side, as the edges of a runway.
  bool mayBeEdges(const GroundLine& left, const GroundLine& right, const GroundAlong& ground) const {
    // The brighter side is that of the line's normal.
    if ((left.line.line.x() < 0) == (right.line.line.x() < 0)) return false;
    const auto [near_left, far_left] = ground.forward(left);
    const auto [near_right, far_right] = ground.forward(right);
    if (std::min(far_left, far_right) < 1.05 * std::max(near_left, near_right)) return false;
    if (!prior_.height) return true;
    const double width = (ground.lateral(left) - ground.lateral(right)) * *prior_.height;
    return width >= kNarrowestRunway && width <= std::max(kWidestRunway, prior_.runway.width);
  }

  /// What is seen of an edge at this place.
  Edge edgeAt(const Pencil& p, double lateral, double slack) const {
    Edge edge;
    for (size_t k = 0; k < lines_.size(); ++k) {
      if (p.passes[k] == 0 || std::abs(p.lateral[k] - lateral) >= slack) continue;
      edge.pieces.push_back(k);
      edge.near = std::min(edge.near, p.near[k]);
      edge.far = std::max(edge.far, p.far[k]);
      edge.evidence += p.evidence[k];
    }
    return edge;
  }

  std::optional<RunwayHypothesis> between(size_t i, size_t j, const Eigen::Vector3d& direction) const {
    const GroundAlong ground(prior_.normal, direction);
    const bool i_is_left = ground.lateral(lines_[i]) > ground.lateral(lines_[j]);
    const size_t l = i_is_left ? i : j, r = i_is_left ? j : i;
    if (!mayBeEdges(lines_[l], lines_[r], ground)) return std::nullopt;
    const Pencil p = pencil(ground);
    RunwayHypothesis h;
    h.direction = direction;
    h.left = p.lateral[l];
    h.right = p.lateral[r];
    if (!(h.width() > 0)) return std::nullopt;
    const double slack = kSameEdge * h.width();
    const Edge left = edgeAt(p, h.left, slack), right = edgeAt(p, h.right, slack);
    h.near = std::max(left.near, right.near);
    h.far = std::min(left.far, right.far);
    if (!(h.near > 0) || !(std::log(h.far / h.near) > kLeastExtent)) return std::nullopt;
    h.members.assign(lines_.size(), 0);
    for (const Edge* edge : {&left, &right})
      for (const size_t k : edge->pieces) h.members[k] = 1;
    h.evidence = std::min(left.evidence + right.evidence, kEnoughOfEdges) +
                 ofShape(h, std::min(seenLength(p, left, h), seenLength(p, right, h))) +
                 ofSurface(p, slack, h) - againstRow(p, slack, h) - against(direction) - againstSize(h);
    h.lead = h.evidence - againstLast(direction);
    return h;
  }

  /// log(far / near) of what is seen of an edge where both are.
  static double seenLength(const Pencil& p, const Edge& edge, const RunwayHypothesis& h) {
    std::vector<Interval> pieces;
    for (const size_t k : edge.pieces) {
      const double begin = std::max(p.near[k], h.near), end = std::min(p.far[k], h.far);
      if (begin < end) pieces.push_back({std::log(begin), std::log(end)});
    }
    return lengthOfUnion(pieces);
  }

  /// Evidence of a long object whose edges are not broken. seen: length of the edge that shows less.
  static double ofShape(const RunwayHypothesis& h, double seen) {
    const double extent = std::log(h.far / h.near), lengths = (h.far - h.near) / h.width();
    return kUnbroken * std::log(std::max(seen / extent, kLeastSeen)) +
           kSlender * std::min(0.0, std::log(lengths / kUsualLength)) + std::min(extent, kEnoughExtent);
  }

  /// Whether a line runs along the runway for long between its middle and its sides, where nothing is
  /// painted.
  static bool isLane(const Pencil& p, size_t k, const RunwayHypothesis& h) {
    const double across = std::abs((p.lateral[k] - h.right) / h.width() - 0.5);  // 0: middle, 0.5: edge
    const double length = std::log(std::min(p.far[k], h.far) / std::max(p.near[k], h.near));
    return across > kMiddle && across < 0.5 - kSide && length > kLane * std::log(h.far / h.near);
  }

  /// Evidence of what lies between the edges; adds what runs along the runway to the members.
  double ofSurface(const Pencil& p, double slack, RunwayHypothesis& h) const {
    double marks = 0;
    int astray = 0;
    for (size_t k = 0; k < lines_.size(); ++k) {
      if (!lines_[k].on_ground || p.lateral[k] > h.left + slack || p.lateral[k] < h.right - slack) continue;
      if (p.far[k] < (1 - kSameEnd) * h.near || p.near[k] > (1 + kSameEnd) * h.far) {
        h.members[k] = 0;
      } else if (p.passes[k] == 0) {
        astray += lines_[k].across ? 0 : 1;
      } else if (h.members[k] == 0) {
        h.members[k] = 1;
        if (isLane(p, k, h))
          ++astray;
        else
          marks += p.evidence[k];
      }
    }
    return std::min(marks, kEnoughInside) - kAstray * astray;
  }

  /// Evidence against one of many objects side by side in the same direction. Streets, crop rows and roofs
  /// come in rows, runways do not.
  double againstRow(const Pencil& p, double slack, const RunwayHypothesis& h) const {
    std::vector<double> places;
    double beside = 0;
    for (size_t k = 0; k < lines_.size(); ++k) {
      const double place = p.lateral[k];
      if (p.evidence[k] < kTelling || (place <= h.left + slack && place >= h.right - slack)) continue;
      const bool known = std::any_of(places.begin(), places.end(),
                                     [&](double other) { return std::abs(other - place) < slack; });
      if (known) continue;
      places.push_back(place);
      beside += p.evidence[k];
    }
    return std::min(kMostOfRow, kRow * std::max(0.0, beside - kUsualBeside));
  }

  static double penalty(double off, double variance, double most = kMostOff) {
    return std::min(most, 0.5 * off * off / variance);
  }
  /// Evidence against a direction by ground and path.
  double against(const Eigen::Vector3d& direction) const {
    double sum = penalty(prior_.normal.dot(direction), direction.dot(prior_.normal_covariance * direction));
    if (prior_.path) sum += penalty(azimuth(direction) - azimuth(*prior_.path), kPathSigma * kPathSigma);
    return sum;
  }
  /// Evidence against an object whose size is not the chart's.
  double againstSize(const RunwayHypothesis& h) const {
    const RunwayParameters& runway = prior_.runway;
    if (!prior_.height) return 0;
    double sum = 0;
    if (runway.length > 0) {
      // The far end is the less certain the nearer it is to the horizon.
      const double length = (h.far - h.near) * *prior_.height,
                   far_sigma = kFarSigma * h.far * h.far / (h.far - h.near);
      const double longer = std::max(0.0, std::log(length / runway.length));
      sum += penalty(longer, kSizeSigma * kSizeSigma + far_sigma * far_sigma);
    }
    if (runway.width > 0) {
      const double stripes = runway.width - 2 * runway.side_stripe_inset;
      const auto off = [&](double width) { return std::log(h.width() * *prior_.height / width); };
      sum += penalty(std::min(std::abs(off(runway.width)), std::abs(off(stripes))), kSizeSigma * kSizeSigma);
    }
    return sum;
  }
  /// Evidence against a direction other than in the pair before.
  double againstLast(const Eigen::Vector3d& direction) const {
    if (!prior_.last) return 0;
    return penalty(azimuth(direction) - azimuth(*prior_.last), kStepSigma * kStepSigma, kMostTurned);
  }

  Eigen::Matrix3d K_, Kinv_;
  RunwayPrior prior_;
  Eigen::Vector3d forward_, left_;
  Eigen::Vector2d horizon_;  // direction of the horizon in the image, unit
  std::vector<GroundLine> lines_;
};

}  // namespace

Expected<RunwayChoice> findRunwayHypothesis(const std::vector<LineSegment>& lines, const Eigen::Matrix3d& K,
                                            const RunwayPrior& prior, double tolerance) {
  const Search search(lines, K, prior, tolerance);
  std::vector<RunwayHypothesis> found = search.all();
  const auto best = std::max_element(found.begin(), found.end(),
                                     [](const auto& a, const auto& b) { return a.lead < b.lead; });
  if (best == found.end())
    return tl::make_unexpected(
        Failure{Reason::kNoRunway, text("no two of ", lines.size(), " lines may be the edges of a runway")});
  double evidence = kByChance, lead = kByChance;
  for (const RunwayHypothesis& h : found) {
    if (std::abs(search.azimuth(h.direction) - search.azimuth(best->direction)) <= kOther) continue;
    evidence = std::max(evidence, h.evidence);
    lead = std::max(lead, h.lead);
  }
  return RunwayChoice{*best, best->evidence - evidence, best->lead - lead};
}

}  // namespace uav_landing
