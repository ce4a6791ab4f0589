#include "runway/position/runway_tracker.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "estimation/limits.h"
#include "runway/direction/runway_object.h"
#include "runway/threshold/runway_threshold.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr Sigmas kGate(4);       // between measured and expected values
constexpr double kSlack = 0.01;  // addition to the gate, as a share of the runway's width
// Share of the width; between the edges of the surface and the lines along them.
constexpr double kSameWidth = 0.1;
constexpr double kVague = 0.1;  // share of the width; an expected centre with a larger tolerance is useless
constexpr double kPatience = 1.0;  // s without the edges, after which they are forgotten
constexpr double kThresholdPatience = 0.5;
constexpr double kHalfPatience = 3.0;  // s for which half of a runway is known to be one
// 1 sigma of the movement in an unknown step, as a share of the height.
constexpr double kUnknownMotion = 0.1;
constexpr double kLongestStep = 1.0;  // s

}  // namespace

void RunwayTracker::Follower::predict(double scale, double motion, double variance) {
  if (!value_) return;
  value_ = *value_ * scale - motion;
  variance_ = variance_ * scale * scale + variance;
}

std::optional<ExpectedCentre> RunwayTracker::Follower::expected(double slack) const {
  if (!value_) return std::nullopt;
  return ExpectedCentre{*value_, kGate.bound(variance_) + slack};
}

bool RunwayTracker::Follower::update(double value, double variance, double slack) {
  missed_ = 0;
  if (!value_ || std::abs(value - *value_) > kGate.bound(variance_ + variance) + slack) {
    value_ = value;
    variance_ = variance;
    confirmations_ = 1;
    return false;
  }
  // Errors of successive pairs are similar, so their mean is hardly better than one of them.
  const double gain = variance_ / (variance_ + variance);
  value_ = *value_ + gain * (value - *value_);
  variance_ = std::max((1 - gain) * variance_, std::min(variance_, 0.5 * variance));
  confirmations_ = std::min(confirmations_ + 1, kConfirmations);
  return confirmations_ >= kConfirmations;
}

void RunwayTracker::Follower::miss(double seconds, double patience) {
  missed_ += seconds;
  if (confirmations_ < kConfirmations || missed_ > patience) *this = Follower();
}

RunwayTracker::RunwayTracker(const RigModel& rig, const ApproachAngleParameters& parameters,
                             const RunwayParameters& runway)
    : model_(rig), parameters_(parameters), known_width_(runway.width) {}

void RunwayTracker::reset() {
  last_stamp_.reset();
  forgetRunway();
}

void RunwayTracker::forgetRunway() {
  centre_ = threshold_ = width_ = wider_ = half_ = Follower();
  contradicted_ = 0;
}

bool RunwayTracker::follows(double stamp) const {
  return last_stamp_ && stamp > *last_stamp_ && stamp - *last_stamp_ <= kLongestStep;
}

double RunwayTracker::advance(double stamp) {
  if (!follows(stamp)) reset();
  const double seconds = last_stamp_ ? stamp - *last_stamp_ : 0;
  last_stamp_ = stamp;
  return seconds;
}

void RunwayTracker::skip(double stamp) {
  const double seconds = advance(stamp);
  predict(nullptr, {});
  missAll(seconds);
}

void RunwayTracker::missAll(double seconds) {
  missCentre(seconds);
  threshold_.miss(seconds, kThresholdPatience);
}

// Another runway, or this one from elsewhere, has another width in heights. So the width is forgotten with
// the centre.
void RunwayTracker::missCentre(double seconds) {
  centre_.miss(seconds, kPatience);
  if (centre_.confirmations() == 0) width_ = wider_ = Follower();
}

ApproachAngleResult::Runway RunwayTracker::process(const RectifiedView& left,
                                                   const ApproachAngleResult& approach,
                                                   const RunwayDirection& direction, double height) {
  const double seconds = advance(approach.stamp);
  ApproachAngleResult::Runway result;
  if (!approach.n.allFinite() || !direction.combined) {
    result.failure = approach.n.allFinite()
                         ? direction.combined.error()
                         : Failure{Reason::kNoGroundNormal, "the position over the runway needs it"};
    result.threshold_failure = result.failure;
    predict(nullptr, approach.step);
    missAll(seconds);
    return result;
  }
  // The runway's own slope and curve move its vanishing point up and down, not to the sides.
  const Eigen::Vector3d& p = direction.combined->direction;
  const double straightness = std::pow(parameters_.runway_straightness_deg * kDegree, 2);
  const Eigen::Matrix3d own =
      direction.combined->covariance - straightness * (Eigen::Matrix3d::Identity() - p * p.transpose());
  const GroundAxes axes(approach.n, approach.n_covariance, p, own);
  predict(&axes, approach.step);
  findCentre(seconds, axes, direction, height, result);
  findThresholdLine(seconds, left, axes, result);
  const double doubt = approach.other_runway_probability;
  if (result.failure || doubt <= kLargestDoubtOfEdges) return result;
  // It is followed all the same, as the next pairs may show what it is.
  ApproachAngleResult::Runway refused;
  refused.failure = refused.threshold_failure = {
      Reason::kNoRunway, text("the edges may be those of something else, with a probability of ",
                              rounded(doubt), ", at most ", kLargestDoubtOfEdges, " allowed")};
  return refused;
}

void RunwayTracker::predict(const GroundAxes* axes, const ApproachAngleResult::Motion& step) {
  if (axes == nullptr || step.failure || !step.translation_over_height.allFinite()) {
    const double variance = kUnknownMotion * kUnknownMotion;
    centre_.predict(1, 0, variance);
    half_.predict(1, 0, variance);
    width_.predict(1, 0, variance);
    wider_.predict(1, 0, variance);
    threshold_.predict(1, 0, variance);
    return;
  }
  const Eigen::Vector3d& t = step.translation_over_height;
  const Eigen::Matrix3d covariance = step.covariance.bottomRightCorner<3, 3>();
  const double scale = 1 + axes->down.dot(t);
  const auto variance = [&](const Eigen::Vector3d& axis) {
    return axis.dot(covariance * axis) + t.squaredNorm() * axes->covariance(2, 2);
  };
  centre_.predict(scale, axes->left.dot(t), variance(axes->left));
  half_.predict(scale, axes->left.dot(t), variance(axes->left));
  width_.predict(scale, 0, 0);
  wider_.predict(scale, 0, 0);
  threshold_.predict(scale, axes->forward.dot(t), variance(axes->forward));
}

RunwayTracker::Edges RunwayTracker::edgesOf(const GroundAxes& axes, const RunwayDirection& direction,
                                            double height) const {
  const auto view = [&](const std::vector<LineSegment>& lines, const ViewCamera& camera) {
    return groundEdges(model_.rig, axes, lines, linesAlong(model_.rig, axes, lines, camera.cx), camera);
  };
  const std::vector<GroundEdge> left = view(direction.left_lines, {model_.rig.cx});
  if (!std::isfinite(height)) return {left, left};
  const std::vector<GroundEdge> right =
      view(direction.right_lines, {model_.rig.cx_right, model_.rig.baseline / height});
  return {matchEdges(axes, left, right), joinEdges(axes, left, right)};
}

void RunwayTracker::findCentre(double seconds, const GroundAxes& axes, const RunwayDirection& direction,
                               double height, ApproachAngleResult::Runway& result) {
  const Edges edges = edgesOf(axes, direction, height);
  RunwayWidth width;
  if (std::isfinite(height)) width = {known_width_ / height, std::max(kWidestRunway, known_width_) / height};
  const Outlook outlook{model_.rig, edges.either};
  const auto find = [&](const std::vector<GroundEdge>& among, const std::optional<ExpectedCentre>& expected,
                        const Outlook* outlook) {
    FoundRunway found = findRunwayEdges(axes, among, width, expected, outlook);
    if (found || width.known <= 0) return found;
    // The visible edges may be those of stripes within the chart's width.
    return findRunwayEdges(axes, among, {0, width.widest}, expected, outlook);
  };
  FoundRunway seen = withoutKnownHalf(seconds, find(edges.both, std::nullopt, &outlook));
  if (centre_.confirmations() >= kConfirmations) {
    const ExpectedCentre expected = *centre_.expected(kSlack * width_.value());
    const bool contradicts = seen && std::abs(seen->centre - expected.centre) > expected.tolerance;
    contradicted_ = contradicts ? contradicted_ + seconds : 0;
    if (contradicted_ > kPatience) {
      forgetRunway();
    } else if ((!seen || contradicts) && expected.tolerance <= kVague * width_.value()) {
      seen = find(edges.both, expected, nullptr);
      if (!seen) seen = find(edges.either, expected, nullptr);
    }
  }
  if (!seen) {
    result.failure = seen.error();
    missCentre(seconds);
    return;
  }
  if (!centre_.update(seen->centre, seen->variance, kSlack * seen->width)) {
    result.failure = {Reason::kNotYet, text(centre_.confirmations(), " of ", kConfirmations,
                                            " pairs that agree on the runway")};
    return;
  }
  result.y = -seen->centre;
  result.y_variance = seen->variance;
  result.y_without = seen->centre_without;
  for (CentreSolutions::Solution& solution : result.y_without.without) solution.value *= -1;
  followWidth(*seen, result);
}

FoundRunway RunwayTracker::withoutKnownHalf(double seconds, FoundRunway seen) {
  const auto isKnownHalf = [this](double centre, double width) {
    if (half_.confirmations() < kConfirmations) return false;
    const ExpectedCentre half = *half_.expected(kSlack * width);
    return std::abs(centre - half.centre) <= half.tolerance;
  };
  const std::optional<LinePair> half = seen ? std::nullopt : seen.error().half;
  // What is known is not forgotten for a single pair that shows something else.
  if (half && (half_.confirmations() < kConfirmations || isKnownHalf(half->centre, half->width))) {
    half_.update(half->centre, half->variance, kSlack * half->width);
    return seen;
  }
  half_.miss(seconds, kHalfPatience);
  if (!seen || centre_.confirmations() >= kConfirmations || !isKnownHalf(seen->centre, seen->width))
    return seen;
  return tl::make_unexpected(EdgeRefusal{
      {Reason::kNoRunway, "these lines were half of a wider runway, whose other half is out of sight"},
      std::nullopt});
}

void RunwayTracker::followWidth(const RunwayCrossSection& seen, ApproachAngleResult::Runway& result) {
  if (width_.confirmations() == 0 || std::abs(seen.width - width_.value()) <= kSameWidth * seen.width) {
    width_.update(seen.width, seen.width_variance, kSameWidth * seen.width);
    result.width = seen.width;
    result.width_variance = seen.width_variance;
    // The pairs contradict each other, so no width is reported.
  } else if (width_.confirmations() < kConfirmations) {
    width_.update(seen.width, seen.width_variance, kSameWidth * seen.width);
  } else if (seen.width > width_.value() &&
             wider_.update(seen.width, seen.width_variance, kSameWidth * seen.width)) {
    width_ = wider_;
    wider_ = Follower();
  }
}

void RunwayTracker::findThresholdLine(double seconds, const RectifiedView& left, const GroundAxes& axes,
                                      ApproachAngleResult::Runway& result) {
  if (result.failure || width_.confirmations() < kConfirmations) {
    result.threshold_failure =
        result.failure ? result.failure : Failure{Reason::kNotYet, "the runway's width is not known"};
    threshold_.miss(seconds, kThresholdPatience);
    return;
  }
  const Expected<Threshold> seen =
      findThreshold(left, model_.rig, axes, {-result.y, result.y_variance, width_.value(), 0}, rows_);
  if (!seen) {
    result.threshold_failure = seen.error();
    threshold_.miss(seconds, kThresholdPatience);
    return;
  }
  if (!threshold_.update(seen->distance, seen->variance, kSlack * width_.value())) {
    result.threshold_failure = {Reason::kNotYet, text(threshold_.confirmations(), " of ", kConfirmations,
                                                      " pairs that agree on the threshold")};
    return;
  }
  result.x = -seen->distance;
  result.x_variance = seen->variance;
  result.x_systematic_variance = seen->systematic_variance;
}

}  // namespace uav_landing
