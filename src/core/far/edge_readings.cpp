#include "far/edge_readings.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace uav_landing {
namespace {

// Share of runways with stripes along their edges. The standard asks for them on precision approach runways,
// which are broad ones, and demands them where edges lack contrast (ICAO Annex 14, 5.2.7). Of narrow runways
// nobody knows.
constexpr double kStripesShare = 0.8, kStripesShareOfFaint = 0.95, kStripesShareOfNarrow = 0.5;
constexpr double kBroad = 30;          // m
constexpr double kFaintContrast = 25;  // grey levels
// Stripes are at least so wide, m (the same place). Contrast of paint against the surface, grey levels.
constexpr double kStripe = 0.9, kStripeOfNarrow = 0.45, kPaintContrast = 95;
constexpr double kPaintSpread = 0.44;  // 1 sigma of that contrast, as a share
constexpr double kFaintest = 0.6;      // of usual stripes: a fit with fainter ones has found none
constexpr double kLargestRatio = 3;    // of the paint's contrast to that of the surface
constexpr double kLargestOffset = 4;   // px by which stripes move an edge
// Of a difference of costs only a part counts. Paint and ground are not quite as in the model, and a reading
// gains by that in all pairs alike.
constexpr double kTemper = 7;
constexpr double kPairs = 10;         // over which the cost of stripes is averaged
constexpr double kShown = 0.4;        // of a blurred stripe's grey level, in its middle
constexpr double kStripePlace = 0.5;  // m, 1 sigma of the place of a stripe that shows
constexpr double kSame = 0.5;         // px, between outlines that count as one

/// An end from another place: moved inward by shift, px.
struct Trial {
  int side;
  double shift;
};
constexpr Trial kTrials[] = {{kNearSide, 2.5},  {kFarSide, 2.5}, {kNearSide, 5},
                             {kNearSide, -2.5}, {kFarSide, 5},   {kFarSide, -2.5}};

bool isSame(const Vector8d& offset) { return offset.cwiseAbs().maxCoeff() < kSame; }

double stripeWidth(const OutlineLook& look) { return look.size.width >= kBroad ? kStripe : kStripeOfNarrow; }

/// Of runways that look like this.
double usualShare(const FittedOutline& fitted, const OutlineLook& look) {
  if (look.size.width < kBroad) return kStripesShareOfNarrow;
  return std::abs(fitted.contrast) < kFaintContrast ? kStripesShareOfFaint : kStripesShare;
}

/// m x grey levels.
double usualStripes(const OutlineLook& look) { return stripeWidth(look) * kPaintContrast; }

/// Scale at the near end, px a metre.
double nearScale(const Corners& corners, const OutlineLook& look) {
  return (corners[3] - corners[0]).norm() / look.size.width;
}

/// Grey level in the middle of a blurred stripe. stripe: its width times its contrast, m x grey levels.
double shownBy(double stripe, double scale) { return kShown * std::abs(stripe) * scale; }

/// By how far stripes would move the sides inward, px. They move the edge of a dark surface outward, and that
/// of a bright one inward.
Vector8d offsetByStripes(const FittedOutline& fitted, const OutlineLook& look) {
  const Corners corners = movedBy(fitted.seen.reference, fitted.seen.inward);
  const double metres =
      stripeWidth(look) * std::clamp(kPaintContrast / fitted.contrast, -kLargestRatio, kLargestRatio);
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

/// The outline without stripes, or the one with stripes where they stand out more than the surface does.
Expected<EdgeReadings::Reading> EdgeReadings::read(OutlineFitter& fitter, const Corners& start,
                                                   const OutlineLook& look) {
  const Expected<FittedOutline> plain = fitter.fit(Vector8d::Zero(), EdgePaint::kNone);
  const double scale = nearScale(start, look);
  if (plain && std::abs(plain->contrast) > shownBy(usualStripes(look), scale))
    return Reading{*plain, EdgePaint::kUnknown};
  const Expected<FittedOutline> striped = fitter.fit(Vector8d::Zero(), EdgePaint::kStripes);
  if (striped && std::abs(striped->contrast) < shownBy(striped->stripes, scale))
    return Reading{*striped, EdgePaint::kStripes};
  if (!plain) return tl::make_unexpected(plain.error());
  return Reading{*plain, EdgePaint::kUnknown};
}

/// The other outline that explains the image: with stripes that do not show. Where no such fit is found, it
/// is as usual stripes would make it.
EdgeReadings::Rival EdgeReadings::withStripes(OutlineFitter& fitter, const FittedOutline& plain,
                                              const OutlineLook& look) {
  const Vector8d usual = offsetByStripes(plain, look);
  const Expected<FittedOutline> found = fitter.fit(plain.seen.inward + usual, EdgePaint::kStripes);
  if (found) {
    const double excess = (found->cost - plain.cost) / kTemper;
    stripes_excess_ += (excess - stripes_excess_) / kPairs;
  }
  if (found && found->stripes > kFaintest * usualStripes(look))
    return {found->seen.inward - plain.seen.inward, found->seen.covariance, stripes_excess_};
  return {usual, plain.seen.covariance + kPaintSpread * kPaintSpread * usual * usual.transpose(),
          stripes_excess_};
}

FittedOutline EdgeReadings::withStripesInPlace(const FittedOutline& fitted, const OutlineLook& look) {
  const Corners corners = movedBy(fitted.seen.reference, fitted.seen.inward);
  Vector8d off = Vector8d::Zero();
  for (const int i : {0, 1, 4, 5}) off[i] = kStripePlace * nearScale(corners, look);
  FittedOutline all = fitted;
  all.seen.covariance += off * off.transpose();
  return all;
}

FittedOutline EdgeReadings::withPossibleStripes(const FittedOutline& plain, const Rival& striped,
                                                const OutlineLook& look) {
  const double usual = usualShare(plain, look);
  const double weight = usual * std::exp(-0.5 * striped.excess), share = weight / (weight + 1 - usual);
  FittedOutline all = plain;
  all.seen.inward += share * striped.offset;
  all.seen.covariance = share * striped.covariance + (1 - share) * plain.seen.covariance +
                        share * (1 - share) * striped.offset * striped.offset.transpose();
  return all;
}

Expected<EdgeReadings::Outline> EdgeReadings::fit(const cv::Mat& image, const cv::Mat& mask,
                                                  const Corners& start, const OutlineLook& look) {
  OutlineFitter fitter(image, mask, start, look);
  Expected<Reading> best = read(fitter, start, look);
  if (!best) return tl::make_unexpected(best.error());
  tryEnd(fitter, *best);
  const FittedOutline all = mean(best->outline);
  const Corners corners = movedBy(start, best->outline.seen.inward);
  if (best->paint == EdgePaint::kStripes) return Outline{withStripesInPlace(all, look), corners};
  return Outline{withPossibleStripes(all, withStripes(fitter, best->outline, look), look), corners};
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
