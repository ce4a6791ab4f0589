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
constexpr double kSure = 1e-3;  // expected coincidences of a point that is not there by chance
constexpr Sigmas kGate(3);      // between a point and the ground
// 1 sigma between the two, beyond which they say little of each other.
constexpr double kVague = 0.4 * kDegree;
constexpr Sigmas kPulled(5);                 // between the points of all lines and of the runway's
constexpr double kEnough = 0.5;              // of the lines through the other view's point
constexpr double kAnyGround = 2 * kDegree;   // 1 sigma of the ground's slope along the runway, without stereo
constexpr double kSameRunway = 1 * kDegree;  // between a vanishing point and the runway that it is of
const double kBeyondDoubt = -std::log(kLargestDoubt);  // least margin of one that counts against stereo
constexpr double kClear = 3;                           // least lead of a runway that outweighs other lines

Eigen::Matrix3d viewK(const StereoRig& rig, bool is_left) {
  Eigen::Matrix3d K = rig.K();
  if (!is_left) K(0, 2) = rig.cx_right;
  return K;
}

// What lines are looked for in.
struct View {
  const cv::Mat& image;
  const cv::Mat& mask;
  Eigen::Matrix3d K;
  const StampMap& rows;
};

// What is found in a view: its lines, the same freed of what blur does to stripes as far as the vanishing
// point depends on them, and that.
struct Found {
  std::vector<LineSegment> lines, straight;
  Expected<VanishingPoint> point = tl::make_unexpected(Failure{Reason::kNotYet, ""});
  bool refused = false;  // there is a point, but not of a runway
};

// The same edge had all rows been exposed at the stamp.
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

// The steps, with what all of them need. ground: or null.
class Search {
 public:
  Search(const SeenGround* ground, const ApproachAngleParameters& parameters, RunwayDirectionMemory& memory,
         Timings& timings)
      : ground_(ground),
        normal_(ground ? ground->plane.normal() : Eigen::Vector3d::UnitY()),
        parameters_(parameters),
        memory_(memory),
        timings_(timings) {}

  // By the view itself.
  Found in(const View& view) const {
    std::vector<LineSegment> lines;
    {
      ScopedTimer timer(timings_, "lines");
      const HeadingGate gate = gateOf(view);
      lines = findLines(view.image, ground_ ? groundPart(view) : view.mask, parameters_,
                        hasRunway() ? &gate : nullptr, memory_.lines);
    }
    return withPoint(view, std::move(lines));
  }

  // Of lines that the other view has shown already, where they are expected; by the view itself where those
  // through the other view's point are mostly lost. Needs a plane.
  Found following(const View& view, const std::vector<RoughSegment>& expected,
                  const VanishingPoint& other) const {
    std::vector<LineSegment> lines;
    {
      ScopedTimer timer(timings_, "lines");
      lines = findLinesNear(view.image, groundPart(view), expected, parameters_, gateOf(view), memory_.lines);
    }
    Found found = withPoint(view, std::move(lines));
    if (found.point && found.point->inlier_count >= kEnough * other.inlier_count) return found;
    return in(view);
  }

  // Those that may be along the runway, if there is one.
  std::vector<LineSegment> along(const View& view, const std::vector<LineSegment>& lines) const {
    if (!hasRunway()) return atStamp(lines, view.rows);
    const HeadingGate gate = gateOf(view);
    std::vector<LineSegment> passing;
    std::copy_if(lines.begin(), lines.end(), std::back_inserter(passing),
                 [&](const LineSegment& line) { return gate.passes(line.line); });
    return atStamp(std::move(passing), view.rows);
  }

  // Whether the other view's lines may be looked for where this one has them: that view is a witness of where
  // they lie then, but not of which ones are there. So half of a runway would be taken for a whole one the
  // sooner, as the edge that tells is not seen; and a point that may be there by chance, or off the ground,
  // is told by lines that the other view finds by itself: those meet elsewhere. The paper's Hough transforms,
  // and lines as those find them, are of each view alone.
  bool isSure(const Expected<VanishingPoint>& point) const {
    return hasRunway() && point && point->coincidences <= kSure && isOnGround(*point) &&
           parameters_.hough_method == HoughMethod::kScanLines && parameters_.refine_lines;
  }

  // The points of views that have none of their own, by the direction that the ground gives their lines.
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

  // Where the other view's lines are those of no runway, a point that is not clearly one's is one view's word
  // against the other's.
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

  /// Lines that meet may be those of a town. A runway among them has the say; without one, the point has to
  /// be on the ground.
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

  // The point of all lines that meet; that of the runway's own ones where it contradicts the former, as lines
  // of fields hardly turned against the runway pull at it.
  Expected<VanishingPoint> withoutOthers(const View& view, const Found& found,
                                         const std::vector<char>& members) const {
    const Expected<VanishingPoint> own =
        fitVanishingPoint(found.straight, view.K, parameters_, members, normal());
    if (!own) return found.point;
    const Eigen::Vector3d turn = own->direction - found.point->direction;
    const double variance = turn.dot((own->covariance + found.point->covariance) * turn);
    return kPulled.admits(turn.squaredNorm(), variance) ? found.point : own;
  }

  // A point off the ground contradicts stereo. It counts where it is a runway's beyond doubt.
  Expected<VanishingPoint> believed(Expected<VanishingPoint> point, const RunwayChoice& choice) const {
    if (!point) return point;
    if (!isNearGround(*point) && choice.margin < kBeyondDoubt)
      return tl::make_unexpected(
          Failure{Reason::kNoVanishingPoint, "lines meet off the horizon, and are not clearly a runway's"});
    point->runway_margin = choice.margin;
    return point;
  }

  // How clearly a point is that of a runway where nothing is known of the ground but what the point itself
  // says.
  double marginOnLevelGround(const View& view, const Found& found) const {
    const Eigen::Vector3d& p = found.point->direction;
    const RunwayPrior prior{normalFromVanishingPoint(*found.point, 0, 0).n,
                            kAnyGround * kAnyGround * Eigen::Matrix3d::Identity(), std::nullopt, std::nullopt,
                            std::nullopt};
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

  // Of the sine of a point's angle above the ground, without the runway's own slope.
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

  // Good until the next call.
  cv::Mat groundPart(const View& view) const {
    cv::Mat ground = memory_.ground.image(view.mask.size());
    keepBelowHorizon(view.mask, view.K, normal_, ground);
    return ground;
  }
  bool hasRunway() const { return ground_ != nullptr && ground_->has_runway; }
  const Eigen::Vector3d* normal() const { return ground_ ? &normal_ : nullptr; }
  // 1 sigma of a runway's own slope against the ground.
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

RunwayDirection findRunwayDirection(const StereoRig& rig, const cv::Mat& left, const cv::Mat& right,
                                    const cv::Mat& left_mask, const cv::Mat& right_mask,
                                    const SeenGround* ground, const ApproachAngleParameters& parameters,
                                    RunwayDirectionMemory& memory, Timings& timings, const ViewRows& rows) {
  const View left_view{left, left_mask, viewK(rig, true), rows.left};
  const View right_view{right, right_mask, viewK(rig, false), rows.right};
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
