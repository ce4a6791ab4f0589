#include "far/edge_readings.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace uav_landing {
namespace {

// Most paved runways have stripes along their edges.
constexpr double kStripesShare = 0.8;
// Of a difference of costs only a part counts. Paint and ground are not quite as in the model, and a reading
// gains by that in all pairs alike.
constexpr double kTemper = 12;
constexpr double kUsualStripes = 80;  // m x grey levels
constexpr double kFaintest = 20;      // of a stripe that makes a difference
constexpr double kLargestOffset = 4;  // px from one reading to the other
constexpr double kSame = 0.5;         // px, between outlines that count as one

/// What each pair tries besides the best reading: the other paint, or one end moved inward by shift, px.
/// Bars, and strips of ground that are as dark as the runway, hold an end where it is not.
struct Trial {
  int rival;  // where its result is kept
  int side;
  double shift;
};
constexpr int kOtherPaint = 0;
constexpr Trial kTrials[] = {{kOtherPaint, 0, 0}, {1, kNearSide, 2.5}, {2, kFarSide, 2.5},
                             {kOtherPaint, 0, 0}, {3, kNearSide, 5},   {4, kNearSide, -2.5},
                             {kOtherPaint, 0, 0}, {5, kFarSide, 5},    {6, kFarSide, -2.5}};

EdgePaint opposite(EdgePaint paint) {
  return paint == EdgePaint::kStripes ? EdgePaint::kNone : EdgePaint::kStripes;
}

/// -2 log of the share of runways with such paint.
double priorCost(EdgePaint paint) {
  return -2 * std::log(paint == EdgePaint::kStripes ? kStripesShare : 1 - kStripesShare);
}

double probabilityCost(const FittedOutline& fitted, EdgePaint paint) {
  return fitted.cost / kTemper + priorCost(paint);
}

/// By how far the other reading's edges lie inside of this one's. Stripes move the edge of a dark surface
/// inward, and that of a bright one outward.
Vector8d expectedOffset(const FittedOutline& fitted, EdgePaint paint, const OutlineLook& look) {
  const Corners corners = movedBy(fitted.seen.reference, fitted.seen.inward);
  const bool painted = paint == EdgePaint::kStripes;
  const double stripes = painted ? std::max(fitted.stripes, kFaintest) : -kUsualStripes;
  const double metres = -stripes / fitted.contrast;
  const auto pixels = [&](int one, int other) {
    const double scale = (corners[one] - corners[other]).norm() / look.size.width;
    return std::clamp(metres * scale, -kLargestOffset, kLargestOffset);
  };
  const double near = pixels(3, 0), far = pixels(2, 1);
  Vector8d offset;
  offset << near, far, 0, 0, far, near, 0, 0;
  return offset;
}

}  // namespace

Expected<EdgeReadings::Outline> EdgeReadings::fit(const cv::Mat& image, const cv::Mat& mask,
                                                  const Corners& start, const OutlineLook& look) {
  OutlineFitter fitter(image, mask, start, look);
  Expected<FittedOutline> best = fitter.fit(Vector8d::Zero(), paint_);
  if (!best) return tl::make_unexpected(best.error());
  compare(fitter, look, *best);
  return Outline{mean(*best, look), movedBy(start, best->seen.inward)};
}

void EdgeReadings::compare(OutlineFitter& fitter, const OutlineLook& look, FittedOutline& best) {
  const Trial& trial = kTrials[turn_];
  turn_ = (turn_ + 1) % static_cast<int>(std::size(kTrials));
  std::optional<Rival>& rival = rivals_[trial.rival];
  const bool other_paint = trial.rival == kOtherPaint;
  const EdgePaint paint = other_paint ? opposite(paint_) : paint_;
  Vector8d from = best.seen.inward;
  if (other_paint)
    from += rival ? rival->offset : expectedOffset(best, paint_, look);
  else
    from.segment<2>(2 * trial.side).array() += trial.shift;
  const Expected<FittedOutline> found = fitter.fit(from, paint);
  if (!found) {
    rival.reset();
    return;
  }
  rival = Rival{found->seen.inward - best.seen.inward, found->seen.covariance,
                probabilityCost(*found, paint) - probabilityCost(best, paint_)};
  if (rival->excess >= 0) return;
  const Rival winner = *rival;
  rival = Rival{Vector8d::Zero(), best.seen.covariance, 0};
  tellFrom(winner);
  best = *found;
  paint_ = paint;
}

/// Tells all rivals from this one, which becomes the best outline.
void EdgeReadings::tellFrom(const Rival& winner) {
  for (std::optional<Rival>& rival : rivals_) {
    if (!rival) continue;
    rival->offset -= winner.offset;
    rival->excess -= winner.excess;
  }
}

FittedOutline EdgeReadings::mean(const FittedOutline& best, const OutlineLook& look) const {
  // A paint that could not be fitted counts by how usual it is.
  const double usual = priorCost(opposite(paint_)) - priorCost(paint_);
  const Rival unknown{expectedOffset(best, paint_, look), best.seen.covariance, std::max(0.0, usual)};
  std::vector<const Rival*> others;
  for (int i = 0; i < kRivals; ++i) {
    const Rival* rival = rivals_[i] ? &*rivals_[i] : i == kOtherPaint ? &unknown : nullptr;
    const auto is_same = [&](const Rival* other) {
      return (other->offset - rival->offset).cwiseAbs().maxCoeff() < kSame;
    };
    if (!rival || rival->offset.cwiseAbs().maxCoeff() < kSame) continue;
    if (std::none_of(others.begin(), others.end(), is_same)) others.push_back(rival);
  }
  double sum = 1;
  Vector8d offset = Vector8d::Zero();
  Matrix8d covariance = best.seen.covariance;
  for (const Rival* rival : others) {
    const double weight = std::exp(-0.5 * rival->excess);
    sum += weight;
    offset += weight * rival->offset;
    covariance += weight * (rival->covariance + rival->offset * rival->offset.transpose());
  }
  offset /= sum;
  FittedOutline all = best;
  all.seen.inward += offset;
  all.seen.covariance = covariance / sum - offset * offset.transpose();
  return all;
}

}  // namespace uav_landing
