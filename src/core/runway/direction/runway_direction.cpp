#include "runway/direction/runway_direction.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "estimation/limits.h"
#include "geometry/half_plane.h"
#include "lines/segments/stripe_line.h"
#include "lines/vanishing/vanishing_search.h"
#include "runway/direction/ground_direction.h"
#include "runway/direction/right_view.h"
#include "runway/direction/runway_hypothesis.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr double kSure = 1e-3;  // largest number of expected coincidences of a point that is certain
constexpr Sigmas kGate(3);      // between a vanishing point and the ground
// With a larger 1 sigma between them, the point and the ground say little about each other.
constexpr double kVague = 0.4 * kDegree;
constexpr Sigmas kPulled(5);     // between the points of all lines and of the runway's lines
constexpr double kEnough = 0.5;  // share of the lines through the other view's point
// 1 sigma of the ground's slope along the runway when there is no stereo.
constexpr double kAnyGround = 2 * kDegree;
constexpr double kSameRunway = 1 * kDegree;  // between a vanishing point and the runway that it belongs to
const double kBeyondDoubt = -std::log(kLargestDoubt);  // least margin of a runway that may contradict stereo
constexpr double kClear = 3;                           // least lead of a runway that outweighs other lines

Eigen::Matrix3d viewK(const StereoRig& rig, bool is_left) {
  Eigen::Matrix3d K = rig.K();
  if (!is_left) K(0, 2) = rig.cx_right;
  return K;
}

// A view with all that is needed to search for its lines.
struct View {
  const cv::Mat& image;
  const cv::Mat& mask;
  Eigen::Matrix3d K;
  const StampMap& rows;
};

// Result of one view. straight: the lines without the effect of blur on stripes as far as the vanishing point
// depends on it, and at the stamp.
struct Found {
  std::vector<LineSegment> lines, straight;
  Expected<VanishingPoint> point = tl::make_unexpected(Failure{Reason::kNotYet, ""});
  bool refused = false;  // there was a point, but it was not a runway's
};

// The same edge with all rows exposed at the stamp.
LineSegment atStamp(const LineSegment& segment, const StampMap& rows) {
  const auto onLine = [&](const Eigen::Vector2d& end) -> Eigen::Vector2d {
    return end - segment.line.dot(end.homogeneous()) * segment.line.head<2>();
  };
  LineSegment moved = makeLineSegment(rows.toStamp(onLine(segment.a)), rows.toStamp(onLine(segment.b)),
                                      segment.offset_stddev, segment.angle_stddev);
  if (moved.line.head<2>().dot(segment.line.head<2>()) < 0) moved.line = -moved.line;
  return moved;
}

std::vector<LineSegment> atStamp(std::vector<LineSegment> lines, const StampMap& rows) {
  if (rows.changesNothing()) return lines;
  for (LineSegment& line : lines) line = atStamp(line, rows);
  return lines;
}

double angleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return (a - b).norm(); }

ApproachAngleResult::View reportOf(const Found& found) {
  ApproachAngleResult::View view;
  for (size_t i = 0; i < found.lines.size(); ++i)
    view.lines.push_back({found.lines[i].a, found.lines[i].b, found.point && found.point->inliers[i] != 0});
  if (found.point) {
    view.vanishing_direction = found.point->direction;
    view.vanishing_covariance = found.point->covariance;
  } else {
    view.failure = found.point.error();
  }
  return view;
}

// The steps of the search, with what all of them need. ground: or null.
class Search {
 public:
  Search(const SeenGround* ground, const ApproachAngleParameters& parameters, RunwayDirectionMemory& memory,
         Timings& timings)
      : ground_(ground),
        normal_(ground ? ground->plane.normal() : Eigen::Vector3d::UnitY()),
        parameters_(parameters),
        memory_(memory),
        timings_(timings) {}

  // Searches one view on its own.
  Found in(const View& view) const {
    std::vector<LineSegment> lines;
    {
      ScopedTimer timer(timings_, "lines");
      const HeadingGate gate = gateOf(view);
      lines = findLines({view.image, ground_ ? groundPart(view) : view.mask}, parameters_,
                        hasRunway() ? &gate : nullptr, memory_.lines);
    }
    return withPoint(view, std::move(lines));
  }

  // Searches only where lines of the other view are expected. If that loses most of the lines through the
  // other view's point, the view is searched on its own. Needs a plane.
  Found following(const View& view, const std::vector<RoughSegment>& expected,
                  const VanishingPoint& other) const {
    std::vector<LineSegment> lines;
    {
      ScopedTimer timer(timings_, "lines");
      lines =
          findLinesNear({view.image, groundPart(view)}, expected, parameters_, gateOf(view), memory_.lines);
    }
    Found found = withPoint(view, std::move(lines));
    if (found.point && found.point->inlier_count >= kEnough * other.inlier_count) return found;
    return in(view);
  }

  // While a runway is followed: only the lines that may run along it.
  std::vector<LineSegment> along(const View& view, const std::vector<LineSegment>& lines) const {
    if (!hasRunway()) return atStamp(lines, view.rows);
    const HeadingGate gate = gateOf(view);
    std::vector<LineSegment> passing;
    std::copy_if(lines.begin(), lines.end(), std::back_inserter(passing),
                 [&](const LineSegment& line) { return gate.passes(line.line); });
    return atStamp(std::move(passing), view.rows);
  }

  // Whether the right view may be searched only where the left view's lines lead. It then shows where these
  // lines lie, but not which other lines exist. So these conditions must hold:
  // - A runway is already followed. Otherwise half of a runway could pass for a whole one, because the edge
  //   that shows the error is not searched for.
  // - The left view's point is certain and on the ground. A wrong point would be exposed by lines that the
  //   right view finds on its own, as those meet elsewhere.
  // - Lines are found row by row and refined. The paper's Hough transforms, and lines without refinement,
  //   belong to each view alone.
  bool isSure(const Expected<VanishingPoint>& point) const {
    return hasRunway() && point && point->coincidences <= kSure && isOnGround(*point) &&
           parameters_.hough_method == HoughMethod::kScanLines && parameters_.refine_lines;
  }

  // Finds points for views that have none of their own, from the direction that known ground gives their
  // lines.
  void tryTogether(const View& left_view, const View& right_view, Found& left, Found& right) const {
    if (ground_ == nullptr || (left.point && right.point)) return;
    ScopedTimer timer(timings_, "ransac");
    const auto along = findLinesAlong({{left.straight, left_view.K}, {right.straight, right_view.K}}, normal_,
                                      ground_->plane.normalCovariance(), maxYaw());
    if (!along) return;
    const auto retry = [&](const View& view, Found& found, const std::vector<char>& members) {
      if (found.point || found.refused) return;
      Expected<VanishingPoint> fitted =
          fitVanishingPoint(found.straight, view.K, parameters_, members, normal());
      if (!fitted) return;
      found.point = std::move(fitted);
      found.point = ofRunway(view, found);
    };
    retry(left_view, left, along->front());
    retry(right_view, right, along->back());
  }

  // If the other view refused its point, this view's point is one word against another. It stays only if it
  // is clearly a runway's.
  void settle(Found& view, const Found& other) const {
    if (!other.refused || !view.point || view.point->runway_margin >= kClear) return;
    view.point = tl::make_unexpected(other.point.error());
  }

 private:
  Found withPoint(const View& view, std::vector<LineSegment> lines) const {
    Found found;
    found.lines = std::move(lines);
    found.straight = atStamp(straight(view, found.lines), view.rows);
    ScopedTimer timer(timings_, "ransac");
    found.point = findVanishingPoint(found.straight, view.K, parameters_, normal());
    if (ground_ == nullptr) {
      if (found.point) found.point->runway_margin = marginOnLevelGround(view, found);
      return found;
    }
    const bool any = found.point.has_value();
    found.point = ofRunway(view, found);
    found.refused = any && !found.point;
    return found;
  }

  /// Lines that meet may belong to a town. If there is a runway among them, it decides. Without one, the
  /// point has to be on the ground.
  Expected<VanishingPoint> ofRunway(const View& view, const Found& found) const {
    const Expected<RunwayChoice> choice = findRunwayHypothesis(found.straight, view.K, parameters_, prior());
    const bool needs_edges = !ground_->runway.paved;
    if (!choice && needs_edges) return tl::make_unexpected(choice.error());
    if (!choice) {
      if (!found.point || isNearGround(*found.point)) return found.point;
      return tl::make_unexpected(Failure{Reason::kNoVanishingPoint, "the lines meet off the horizon"});
    }
    const bool agrees =
        found.point && angleBetween(found.point->direction, choice->best.direction) < kSameRunway;
    if (agrees && (!needs_edges || choice->lead >= kClear))
      return believed(withoutOthers(view, found, choice->best.members), *choice);
    if (choice->lead < kClear)
      return tl::make_unexpected(
          Failure{Reason::kNoVanishingPoint, "lines meet in one point, but it is not clearly a runway's"});
    Expected<VanishingPoint> point =
        fitVanishingPoint(found.straight, view.K, parameters_, choice->best.members, normal());
    return believed(point, *choice);
  }

  // Returns the point of all lines that meet, or that of the runway's own lines if both contradict each
  // other. The reason is that field borders which are hardly turned against the runway pull at the point.
  Expected<VanishingPoint> withoutOthers(const View& view, const Found& found,
                                         const std::vector<char>& members) const {
    const Expected<VanishingPoint> own =
        fitVanishingPoint(found.straight, view.K, parameters_, members, normal());
    if (!own) return found.point;
    const Eigen::Vector3d turn = own->direction - found.point->direction;
    const double variance = turn.dot((own->covariance + found.point->covariance) * turn);
    return kPulled.admits(turn.squaredNorm(), variance) ? found.point : own;
  }

  // A point off the ground contradicts stereo. It is believed only when it is a runway's beyond doubt.
  Expected<VanishingPoint> believed(Expected<VanishingPoint> point, const RunwayChoice& choice) const {
    if (!point) return point;
    if (!isNearGround(*point) && choice.margin < kBeyondDoubt)
      return tl::make_unexpected(
          Failure{Reason::kNoVanishingPoint, "lines meet off the horizon, and are not clearly a runway's"});
    point->runway_margin = choice.margin;
    return point;
  }

  // Margin of a point's runway when nothing but the point itself says where the ground is.
  double marginOnLevelGround(const View& view, const Found& found) const {
    const Eigen::Vector3d& p = found.point->direction;
    const std::optional<GroundNormal> level = normalFromVanishingPoint(*found.point, 0, 0);
    if (!level) return 0;
    const RunwayPrior prior{level->vector(), kAnyGround * kAnyGround * Eigen::Matrix3d::Identity(),
                            std::nullopt, std::nullopt, std::nullopt};
    const Expected<RunwayChoice> choice = findRunwayHypothesis(found.straight, view.K, parameters_, prior);
    return choice && angleBetween(p, choice->best.direction) < kSameRunway ? choice->margin : 0;
  }

  RunwayPrior prior() const {
    return {normal_,
            ground_->plane.normalCovariance() + slope() * slope() * Eigen::Matrix3d::Identity(),
            ground_->plane.height(),
            ground_->path,
            ground_->last,
            ground_->runway,
            ground_->last_doubt};
  }

  bool isNearGround(const VanishingPoint& point) const {
    return kGate.admits(normal_.dot(point.direction), heightVariance(point) + slope() * slope());
  }

  // Variance of the sine of the point's angle above the ground, without the runway's own slope.
  double heightVariance(const VanishingPoint& point) const {
    return point.direction.dot(ground_->plane.normalCovariance() * point.direction) +
           normal_.dot(point.covariance * normal_);
  }

  std::vector<LineSegment> straight(const View& view, const std::vector<LineSegment>& lines) const {
    if (!parameters_.stripe_centres) return lines;
    ScopedTimer timer(timings_, "lines");
    if (ground_ == nullptr) return withoutStripeBias(view.image, view.mask, lines);
    const HeadingGate gate = gateOf(view);
    std::vector<size_t> places;
    std::vector<LineSegment> chosen;
    for (size_t i = 0; i < lines.size(); ++i) {
      if (!gate.passes(lines[i].line)) continue;
      places.push_back(i);
      chosen.push_back(lines[i]);
    }
    chosen = withoutStripeBias(view.image, view.mask, chosen);
    std::vector<LineSegment> result = lines;
    for (size_t k = 0; k < places.size(); ++k) result[places[k]] = chosen[k];
    return result;
  }

  bool isOnGround(const VanishingPoint& point) const {
    const double straightness = parameters_.runway_straightness_deg * kDegree;
    const double variance = heightVariance(point) + straightness * straightness;
    return variance <= kVague * kVague && std::abs(normal_.dot(point.direction)) <= kGate.bound(variance);
  }

  // The result is valid until the next call.
  cv::Mat groundPart(const View& view) const {
    cv::Mat ground = memory_.ground.image(view.mask.size());
    keepBelowHorizon(view.mask, view.K, normal_, ground);
    return ground;
  }
  bool hasRunway() const { return ground_ != nullptr && ground_->has_runway; }
  const Eigen::Vector3d* normal() const { return ground_ ? &normal_ : nullptr; }
  // 1 sigma of the runway's own slope against the ground, rad.
  double slope() const { return parameters_.runway_slope_stddev_deg * kDegree; }
  double maxYaw() const { return parameters_.max_yaw_deg * kDegree; }
  HeadingGate gateOf(const View& view) const { return {view.K, normal_, maxYaw()}; }

  const SeenGround* ground_;
  Eigen::Vector3d normal_;
  const ApproachAngleParameters& parameters_;
  RunwayDirectionMemory& memory_;
  Timings& timings_;
};

}  // namespace

RunwayDirection findRunwayDirection(const StereoViews& views, const SeenGround* ground,
                                    const ApproachAngleParameters& parameters, RunwayDirectionMemory& memory,
                                    Timings& timings) {
  const StereoRig& rig = views.rig;
  const View left_view{views.left.image, views.left.mask, viewK(rig, true), views.left.rows};
  const View right_view{views.right.image, views.right.mask, viewK(rig, false), views.right.rows};
  const Search search(ground, parameters, memory, timings);
  Found in_left = search.in(left_view);
  Found in_right =
      search.isSure(in_left.point)
          ? search.following(right_view, linesInRightView(rig, *ground, in_left.lines), *in_left.point)
          : search.in(right_view);
  search.tryTogether(left_view, right_view, in_left, in_right);

  search.settle(in_left, in_right);
  search.settle(in_right, in_left);

  RunwayDirection result;
  result.left = reportOf(in_left);
  result.right = reportOf(in_right);
  result.left_lines = search.along(left_view, in_left.lines);
  result.right_lines = search.along(right_view, in_right.lines);
  result.combined =
      combineVanishingPoints(in_left.point, in_right.point, parameters.runway_straightness_deg * kDegree);
  return result;
}

}  // namespace uav_landing
