#include "far/edge_readings.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "far/runway_paint.h"

namespace uav_landing {
namespace {

constexpr double kFaintest = 0.6;  // of usual stripes: a fit with fainter ones has found none
// Limits of what stripes do: of the paint's contrast over that of the surface, and px of an edge.
constexpr double kLargestRatio = 3, kLargestOffset = 4;
constexpr double kStripePlace = 0.5;  // m, 1 sigma of the place of a stripe that shows
// Stripes that would stand out so many times as much as the surface, and do not show, are not there.
constexpr double kClearlyShown = 1.5;
// Of a difference of costs only a part counts. Paint and ground are not quite as in the model, and a reading
// gains by that in all pairs alike.
constexpr double kTemper = 7;
constexpr int kPairs = 10;     // over which the cost of stripes is averaged
constexpr double kSame = 0.5;  // px, between outlines that count as one

/// An end from another place: moved inward by shift, px.
struct Trial {
  int side;
  double shift;
};
constexpr Trial kTrials[] = {{kNearSide, 2.5},  {kFarSide, 2.5}, {kNearSide, 5},
                             {kNearSide, -2.5}, {kFarSide, 5},   {kFarSide, -2.5}};

bool isSame(const Vector8d& offset) { return offset.cwiseAbs().maxCoeff() < kSame; }

/// Scale at the near end, px a metre.
double nearScale(const Corners& corners, const OutlineLook& look) {
  return (corners[3] - corners[0]).norm() / look.size.width;
}

/// By how far stripes would move the sides inward, px. They move the edge of a dark surface outward, and that
/// of a bright one inward.
Vector8d offsetByStripes(const FittedOutline& fitted, const OutlineLook& look) {
  const Corners corners = movedBy(fitted.seen.reference, fitted.seen.inward);
  const EdgeStripes stripes = usualStripes(look.size.width);
  const double metres =
      stripes.width * std::clamp(stripes.contrast / fitted.contrast, -kLargestRatio, kLargestRatio);
  const auto pixels = [&](int one, int other) {
    const double scale = (corners[one] - corners[other]).norm() / look.size.width;
    return std::clamp(metres * scale, -kLargestOffset, kLargestOffset);
  };
  const double near = pixels(3, 0), far = pixels(2, 1);
  Vector8d offset;
  offset << near, far, 0, 0, far, near, 0, 0;
  return offset;
}

bool findsStripes(const Expected<FittedOutline>& fitted, const OutlineLook& look) {
  return fitted && fitted->stripes > kFaintest * usualStripes(look.size.width).amplitude();
}

/// An outline by stripes that show: they may lie nearer to the edge, or farther from it.
FittedOutline withStripesInPlace(const FittedOutline& fitted, const OutlineLook& look) {
  const Corners corners = movedBy(fitted.seen.reference, fitted.seen.inward);
  Vector8d off = Vector8d::Zero();
  for (const int i : {0, 1, 4, 5}) off[i] = kStripePlace * nearScale(corners, look);
  FittedOutline all = fitted;
  all.seen.covariance += off * off.transpose();
  return all;
}

}  // namespace

/// The outline without stripes, or the one with stripes where they stand out more than the surface does.
Expected<EdgeReadings::Reading> EdgeReadings::read(OutlineFitter& fitter, const Corners& start,
                                                   const OutlineLook& look) {
  const Expected<FittedOutline> plain = fitter.fit(Vector8d::Zero(), EdgePaint::kNone);
  const double scale = nearScale(start, look);
  const double usual = shownStripe(usualStripes(look.size.width).amplitude(), scale);
  if (plain && std::abs(plain->contrast) > usual) return Reading{*plain, EdgePaint::kUnknown};
  Expected<FittedOutline> striped = fitter.fit(Vector8d::Zero(), EdgePaint::kStripes);
  if (plain && !findsStripes(striped, look))
    striped = fitter.fit(plain->seen.inward + offsetByStripes(*plain, look), EdgePaint::kStripes);
  if (striped && std::abs(striped->contrast) < shownStripe(striped->stripes, scale))
    return Reading{*striped, EdgePaint::kStripes};
  if (!plain) return tl::make_unexpected(plain.error());
  const bool denied = kClearlyShown * std::abs(plain->contrast) < usual && !findsStripes(striped, look);
  return Reading{*plain, denied ? EdgePaint::kNone : EdgePaint::kUnknown};
}

Expected<EdgeReadings::Outline> EdgeReadings::fit(const cv::Mat& image, const cv::Mat& mask,
                                                  const Corners& start, const OutlineLook& look) {
  OutlineFitter fitter(image, mask, start, look);
  Expected<Reading> best = read(fitter, start, look);
  if (!best) return tl::make_unexpected(best.error());
  tryEnd(fitter, *best);
  Outline outline{mean(best->outline), movedBy(start, best->outline.seen.inward)};
  if (best->paint == EdgePaint::kStripes) outline.fitted = withStripesInPlace(outline.fitted, look);
  if (best->paint != EdgePaint::kUnknown) return outline;
  const Rival striped = withStripes(fitter, best->outline, look);
  const double odds = std::exp(-0.5 * striped.excess), share = odds / (1 + odds);
  SeenOutline& seen = outline.fitted.seen;
  seen.inward += share * striped.offset;
  seen.covariance = share * striped.covariance + (1 - share) * seen.covariance +
                    share * (1 - share) * striped.offset * striped.offset.transpose();
  return outline;
}

/// The other outline that explains the image, with stripes that do not show. Where no such fit is found, it
/// is as usual stripes would make it.
EdgeReadings::Rival EdgeReadings::withStripes(OutlineFitter& fitter, const FittedOutline& plain,
                                              const OutlineLook& look) {
  const EdgeStripes usual = usualStripes(look.size.width);
  Vector8d offset = offsetByStripes(plain, look);
  const Matrix8d spread = usual.spread * usual.spread * offset * offset.transpose();
  const Expected<FittedOutline> found = fitter.fit(plain.seen.inward + offset, EdgePaint::kStripes);
  Matrix8d covariance = plain.seen.covariance;
  if (found) {
    compared_ = std::min(compared_ + 1, kPairs);
    stripes_excess_ += ((found->cost - plain.cost) / kTemper - stripes_excess_) / compared_;
  }
  if (findsStripes(found, look)) {
    offset = found->seen.inward - plain.seen.inward;
    covariance = found->seen.covariance;
  }
  return {offset, covariance + spread, stripes_excess_ - 2 * std::log(usual.share / (1 - usual.share))};
}

void EdgeReadings::tryEnd(OutlineFitter& fitter, Reading& reading) {
  FittedOutline& best = reading.outline;
  const Trial& trial = kTrials[turn_];
  std::optional<Rival>& rival = rivals_[turn_];
  turn_ = (turn_ + 1) % kRivals;
  Vector8d from = best.seen.inward;
  from.segment<2>(2 * trial.side).array() += trial.shift;
  const bool striped = reading.paint == EdgePaint::kStripes;
  const Expected<FittedOutline> found = fitter.fit(from, striped ? EdgePaint::kStripes : EdgePaint::kNone);
  if (!found) {
    rival.reset();
    return;
  }
  rival = Rival{found->seen.inward - best.seen.inward, found->seen.covariance,
                (found->cost - best.cost) / kTemper};
  if (rival->excess >= 0) return;
  const Rival winner = *rival;
  rival = Rival{Vector8d::Zero(), best.seen.covariance, 0};
  tellFrom(winner);
  best = *found;
}

/// Tells all rivals from this one, which becomes the best outline.
void EdgeReadings::tellFrom(const Rival& winner) {
  for (std::optional<Rival>& rival : rivals_) {
    if (!rival) continue;
    rival->offset -= winner.offset;
    rival->excess -= winner.excess;
  }
}

FittedOutline EdgeReadings::mean(const FittedOutline& best) const {
  std::vector<const Rival*> others;
  for (const std::optional<Rival>& rival : rivals_) {
    if (!rival || isSame(rival->offset)) continue;
    const auto is_known = [&](const Rival* other) { return isSame(other->offset - rival->offset); };
    if (std::none_of(others.begin(), others.end(), is_known)) others.push_back(&*rival);
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
