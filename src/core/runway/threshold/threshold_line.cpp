#include "runway/threshold/threshold_line.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace uav_landing {

namespace {

constexpr int kColumns = TopView::kColumns;
constexpr double kSpanning = 0.8;       // least share of the width that the threshold's line covers
constexpr double kNothing = 0.25;       // below this share there is no line
constexpr double kLineContrast = 0.35;  // weakest step onto the line, as a share of the bars' contrast
constexpr int kStretches = 8;           // parts of the width in which the pavement must begin alike
constexpr double kLeastStep = 8;        // least step at the beginning of the pavement, grey levels
constexpr double kClearStep = 5;        // the same in standard errors over the stretches
constexpr double kFirstStep = 0.5;  // share of the clearest step; a nearer one above this is taken instead
// On bright ground the near edge of the line is no clear step, but its far edge is.
constexpr double kWidestLine = 1.1;  // in pitches of the bars
constexpr double kPaint = 0.5;       // least step down behind a line, as a share of the bars' contrast

/// Share of the width on which the brightness rises towards the far side by at least this much. The line may
/// be slightly skewed.
double rising(const TopView& view, int k, double least) {
  int up = 0, known = 0;
  for (int c = 0; c < kColumns; ++c) {
    const float before = std::min(view.row(k - 2)[c], view.row(k - 1)[c]);
    const float after = std::max(view.row(k + 1)[c], view.row(k + 2)[c]);
    if (!std::isfinite(after - before)) continue;
    ++known;
    if (after - before >= least) ++up;
  }
  return known > 0 ? static_cast<double>(up) / known : 0;
}

/// Step of the brightness at a station, over the whole width.
struct Step {
  double mean = 0;     // grey levels, towards the far side
  bool clear = false;  // large against its scatter across the width
};

Step stepAt(const TopView& view, int k) {
  std::vector<double> steps;
  steps.reserve(kStretches);
  for (int stretch = 0; stretch < kStretches; ++stretch) {
    double sum = 0;
    int known = 0;
    for (int c = stretch * kColumns / kStretches; c < (stretch + 1) * kColumns / kStretches; ++c) {
      const float step =
          0.5F * (view.row(k + 1)[c] + view.row(k + 2)[c] - view.row(k - 1)[c] - view.row(k - 2)[c]);
      if (!std::isfinite(step)) continue;
      sum += step;
      ++known;
    }
    if (known > 0) steps.push_back(sum / known);
  }
  Step step;
  if (steps.size() < TopView::kLeastPicture * kStretches) return step;
  const double count = static_cast<double>(steps.size());
  for (const double s : steps) step.mean += s / count;
  double square = 0;
  for (const double s : steps) square += std::pow(s - step.mean, 2);
  const double standard_error = std::sqrt(square / (count - 1) / count);
  const bool one_way = std::all_of(steps.begin(), steps.end(), [&](double s) { return s * step.mean > 0; });
  step.clear = one_way && std::abs(step.mean) >= std::max(kLeastStep, kClearStep * standard_error);
  return step;
}

/// Vertex of the parabola through a step and its neighbours. Nothing when one of the neighbours is steeper.
std::optional<double> topOf(const std::vector<Step>& steps, size_t i) {
  const double here = std::abs(steps[i].mean), sign = steps[i].mean > 0 ? 1 : -1;
  const double before = sign * steps[i - 1].mean, after = sign * steps[i + 1].mean;
  if (before > here || after > here) return std::nullopt;
  const double curve = before - 2 * here + after;
  return static_cast<double>(i) + (curve < 0 ? 0.5 * (before - after) / curve : 0.0);
}

/// Place of the largest clear rise from the step `first` to before `end`.
std::optional<double> clearestRise(const std::vector<Step>& steps, size_t first, size_t end) {
  std::optional<double> found;
  double largest = 0;
  for (size_t i = std::max<size_t>(1, first); i < end; ++i) {
    if (!steps[i].clear || steps[i].mean <= largest) continue;
    if (const std::optional<double> top = topOf(steps, i)) {
      found = top;
      largest = steps[i].mean;
    }
  }
  return found;
}

/// Near edge of the line whose far edge is the i-th step. first: station of the first step.
std::optional<double> nearEdge(const TopView& view, const std::vector<Step>& steps, int first, size_t i,
                               double pitch) {
  const double far = view.distance(first + static_cast<double>(i));
  size_t near = i;
  while (near > 0 && far - view.distance(first + static_cast<double>(near)) < kWidestLine * pitch) --near;
  return clearestRise(steps, near, i);
}

}  // namespace

bool ThresholdLine::spans() const { return spanning >= kSpanning; }
bool ThresholdLine::isSomething() const { return spanning > kNothing; }

ThresholdLine findThresholdLine(const TopView& view, const ThresholdBars& bars, int first) {
  ThresholdLine line;
  double steepest = 0;
  const int end = static_cast<int>(bars.begin) - 2;  // a rise beyond belongs to the bars
  for (int k = std::max(2, first); k < end; ++k) {
    const double spanning = rising(view, k, kLineContrast * bars.contrast);
    line.spanning = std::max(line.spanning, spanning);
    if (spanning < kSpanning) continue;
    const auto slope = [&](int i) { return meanOf(view.row(i + 1)) - meanOf(view.row(i - 1)); };
    const double here = slope(k);
    if (here <= steepest) continue;
    steepest = here;
    // Vertex of the parabola through three slopes.
    const double before = slope(k - 1), after = slope(k + 1), curve = before - 2 * here + after;
    line.station = k + (curve < 0 ? std::clamp(0.5 * (before - after) / curve, -1.0, 1.0) : 0.0);
  }
  return line;
}

std::optional<double> findPavement(const TopView& view, const ThresholdBars& bars, double pitch, int first) {
  const int begin = std::max(2, first), end = static_cast<int>(bars.begin) - 2;  // before the bars
  std::vector<Step> steps;
  double clearest = 0;
  for (int k = begin; k < end; ++k) {
    steps.push_back(stepAt(view, k));
    if (steps.back().clear) clearest = std::max(clearest, std::abs(steps.back().mean));
  }
  for (size_t i = 1; i + 1 < steps.size(); ++i) {
    if (!steps[i].clear || std::abs(steps[i].mean) < kFirstStep * clearest) continue;
    std::optional<double> top = topOf(steps, i);
    if (!top) continue;
    if (steps[i].mean <= -kPaint * bars.contrast) {
      top = nearEdge(view, steps, begin, i, pitch);
      if (!top) return std::nullopt;
    }
    return begin + *top;
  }
  return std::nullopt;
}

}  // namespace uav_landing
