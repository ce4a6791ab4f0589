#include "runway/threshold/threshold_bars.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "estimation/robust.h"
#include "kernels/image/line_shades.h"
#include "kernels/lanes/order_statistic.h"

namespace uav_landing {

namespace {

using Across = TopView::Across;

constexpr int kColumns = TopView::kColumns, kBlock = TopView::kBlock;
constexpr double kLeastContrast = 20;  // grey levels between the bars and the gaps
constexpr int kLeastFlips = 8;         // changes between light and dark across the bars
// Largest distance between two changes, or to the runway's edge, as a share of the width.
constexpr double kLargestGap = 0.25;
// Correlation of the pattern with itself farther on, and with its mirror image.
constexpr double kLeastLikeness = 0.7;
constexpr double kUnevenPitch = 0.25;  // share of the pitch, between neighbouring bars
constexpr double kLeastAlike = 0.6;    // share of the bars that are one pitch apart
constexpr double kUnevenBars = 0.35;   // share of the width of a bar
constexpr int kFewestBars = 4;         // of equal width

/// An eighth of the pattern is darker than `dark`, and an eighth is lighter than `light`.
struct Greys {
  float dark = 0, light = 0;
};

/// Whether the pattern alternates between light and dark often enough and without a large gap.
bool alternate(const LineShades& shades) {
  int flips = 0, last = 0, state = kBetweenShade, gap = 0;
  for (int c = 0; c < kColumns; ++c) {
    if (shades[c] == kBetweenShade || shades[c] == state) continue;
    if (shades[c] == kUnknownShade) {
      last = c;  // outside the image, so nothing is missing for certain
      continue;
    }
    gap = std::max(gap, c - last);
    last = c;
    if (state != kBetweenShade) ++flips;
    state = shades[c];
  }
  gap = std::max(gap, kColumns - last);
  return flips >= kLeastFlips && gap <= kLargestGap * kColumns;
}

/// Contrast of bars side by side, grey levels; 0 when the pattern shows no bars or less contrast than
/// `least`. greys: on entry those of the previous station, as they are similar; on return of this one.
double barContrast(const Across& pattern, double least, Greys& greys) {
  KnownGreys known;
  takeKnown(pattern, known);
  if (known.count < TopView::kLeastPicture * kColumns) return 0;
  // Quick exit: most of the runway has nearly one grey. So too few samples are lighter by this contrast than
  // the darkest one, or than `dark`.
  constexpr float kSafe = 0.999F;
  const int outermost = known.count / 8;
  const float lighter = known.darkest + kSafe * static_cast<float>(least);
  if (countFrom(lighter, known) <= outermost) return 0;
  const auto statistic = [&](int rank, float guess) {
    return orderStatistic(known.greys, rank, guess > 0 ? guess : lighter);
  };
  greys.dark = statistic(outermost, greys.dark);
  if (countFrom(greys.dark + kSafe * static_cast<float>(least), known) <= outermost) return 0;
  greys.light = statistic(known.count - 1 - outermost, greys.light);
  const float contrast = greys.light - greys.dark;
  if (contrast < least) return 0;
  LineShades shades;
  findShades(known, greys.dark, greys.light, shades);
  return alternate(shades) ? contrast : 0;
}

/// The median if enough of the lengths are close to it, else 0.
double commonLength(const std::vector<double>& lengths, double tolerance, int fewest) {
  if (lengths.empty()) return 0;
  const double middle = medianOf(lengths);
  const auto alike = std::count_if(lengths.begin(), lengths.end(), [&](double length) {
    return std::abs(length - middle) <= tolerance * middle;
  });
  return alike >= fewest && alike >= kLeastAlike * lengths.size() ? middle : 0;
}

/// Distance from bar to bar, in columns; 0 when the bars are not evenly spaced or not equally wide. The marks
/// of the aiming point with the centre line between them are no bars, for example.
double pitchOf(const Across& pattern) {
  const double level = meanOf(pattern);
  std::vector<double> pitches, widths;
  double rise = std::numeric_limits<double>::quiet_NaN();
  for (int c = 1; c < kColumns; ++c) {
    const double edge = c - (pattern[c] - level) / (pattern[c] - pattern[c - 1]);
    if (pattern[c - 1] < level && pattern[c] >= level) {
      if (std::isfinite(rise)) pitches.push_back(edge - rise);
      rise = edge;
    } else if (pattern[c - 1] >= level && pattern[c] < level && std::isfinite(rise)) {
      widths.push_back(edge - rise);
    }
  }
  if (commonLength(widths, kUnevenBars, kFewestBars) == 0) return 0;
  return commonLength(pitches, kUnevenPitch, 1);
}

/// Share of the pattern in a station: 1 where the station shows it fully, 0 where it shows nothing of it.
double share(const Across& pattern, const Across& row) {
  const double pattern_mean = meanOf(pattern), row_mean = meanOf(row);
  double product = 0, square = 0;
  for (int c = 0; c < kColumns; ++c) {
    if (!std::isfinite(pattern[c]) || !std::isfinite(row[c])) continue;
    const double p = pattern[c] - pattern_mean;
    product += p * (row[c] - row_mean);
    square += p * p;
  }
  return square > 0 ? product / square : 0;
}

/// Correlation of two patterns across the runway.
double correlation(const Across& a, const Across& b) {
  const double product = share(a, b) * share(b, a);
  return share(a, b) > 0 ? std::sqrt(std::max(0.0, product)) : 0;
}

/// Place between the stations k and k + step at which the share falls below one half.
double crossing(double k, double step, double inside, double outside) {
  return k + step * (inside - 0.5) / std::max(inside - outside, 1e-6);
}

/// Whether the bars look the same at both ends, and on both sides of the centre line. Texture does not.
bool areBars(const TopView& view, const ThresholdBars& bars) {
  const int first = static_cast<int>(std::ceil(bars.begin)) + 1, last = static_cast<int>(bars.end) - 1;
  if (last - first < 2 * kBlock) return false;
  const int quarter = (last - first) / 4;
  const auto block = [&](int k) { return view.blockAround(std::clamp(k, kBlock, view.size() - 1 - kBlock)); };
  const Across near = block(first + quarter), far = block(last - quarter);
  Across mirrored = near;
  std::reverse(mirrored.begin(), mirrored.end());
  return correlation(near, far) >= kLeastLikeness && correlation(near, mirrored) >= kLeastLikeness;
}

}  // namespace

std::optional<ThresholdBars> findThresholdBars(const TopView& view) {
  int anchor = -1;
  ThresholdBars bars;
  Greys greys;
  for (int k = kBlock; k + kBlock < view.size(); ++k) {
    const double contrast = barContrast(view.blockAround(k), std::max(kLeastContrast, bars.contrast), greys);
    if (contrast <= bars.contrast) continue;
    bars.contrast = contrast;
    anchor = k;
  }
  if (anchor < 0) return std::nullopt;
  const Across pattern = view.blockAround(anchor);
  bars.pitch = pitchOf(pattern);
  if (bars.pitch == 0) return std::nullopt;
  const auto follow = [&](int step, double& place) {
    double inside = 1;
    for (int k = anchor; k >= 0 && k < view.size(); k += step) {
      const double s = share(pattern, view.row(k));
      if (s < 0.5) {
        place = crossing(k - step, step, inside, s);
        return true;
      }
      inside = s;
    }
    return false;
  };
  if (!follow(-1, bars.begin)) return std::nullopt;
  if (!follow(1, bars.end)) bars.end = view.size() - 1;
  if (!areBars(view, bars)) return std::nullopt;
  return bars;
}

}  // namespace uav_landing
