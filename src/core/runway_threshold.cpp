#include "uav_landing/runway_threshold.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "multiversion.h"
#include "text.h"

namespace uav_landing {
namespace {

constexpr int kColumns = 96;            // samples across the runway
constexpr double kAcross = 0.92;        // of the width that is sampled: without the lines along the edges
constexpr double kFarthest = 60;        // heights
constexpr double kFootprint = 0.02;     // of the width: largest length on the ground of a pixel that tells
constexpr double kLeastPicture = 0.75;  // share of a station's samples that must lie in the picture
constexpr double kLeastContrast = 20;   // grey levels between bars and what lies between them
constexpr int kLeastFlips = 8;          // between light and dark across the bars
constexpr double kLargestGap = 0.25;    // of the width between two of them, or to the runway's edge
constexpr int kBlock = 3;               // stations to each side that make one pattern
constexpr double kShortestBars = 0.2;   // of the width
constexpr double kLeastLikeness = 0.7;  // correlation of the pattern with itself further on, and mirrored
constexpr double kLineSearch = 0.3;     // of the width, before the bars
constexpr double kSpanning = 0.8;       // share of the width that the threshold line takes
constexpr double kNothing = 0.25;       // share below which there is no line
constexpr double kLineContrast = 0.35;  // of the bars' contrast: weakest step onto the line
constexpr double kLocation = 0.5;       // px, 1 sigma of an edge across the runway
// Bars begin 6 m behind the threshold and are 3.5 m apart (ICAO Annex 14; FAA AC 150/5340-1); on runways that
// follow no standard they begin anywhere from the threshold on.
constexpr double kFarthestBars = 1.9;  // pitches of the bars, behind the threshold
constexpr double kUnevenPitch = 0.25;  // of the pitch, between neighbouring bars
constexpr double kLeastAlike = 0.6;    // share of the bars that are one pitch apart
constexpr double kUnevenBars = 0.35;   // of the width of a bar
constexpr int kFewestBars = 4;         // that are equally wide
constexpr double kSearched = 1.3;      // of the farthest: before the bars
constexpr double kPitchError = 0.05;   // 1 sigma, of the pitch
constexpr int kStretches = 8;          // across the runway, in which the pavement must begin alike
constexpr double kLeastStep = 8;       // grey levels where the pavement begins
constexpr double kClearStep = 5;       // the same, in standard errors over the stretches
constexpr double kFirstStep = 0.5;     // of the clearest step: a nearer one that is taken instead

/// Grey levels across the runway, not finite outside the picture.
using Across = std::array<float, kColumns>;

/// Where a picture shows points of a line in space, origin + y direction; columns below 0 behind the camera.
struct LineView {
  Eigen::Vector3d origin, direction;
  double fx, fy, cx, cy;
};
using Places = std::array<double, kColumns>;
UAV_LANDING_MULTIVERSION void project(const LineView& line, const Places& y, Places& u, Places& v) {
  const double x0 = line.origin.x(), y0 = line.origin.y(), z0 = line.origin.z();
  const double dx = line.direction.x(), dy = line.direction.y(), dz = line.direction.z();
  const double fx = line.fx, fy = line.fy, cx = line.cx, cy = line.cy;
  for (int c = 0; c < kColumns; ++c) {
    const double z = z0 + y[c] * dz, inverse = 1 / z;
    const double column = fx * (x0 + y[c] * dx) * inverse + cx;
    v[c] = fy * (y0 + y[c] * dy) * inverse + cy;
    u[c] = z > 0 ? column : -1;
  }
}

/// The runway as seen from above, one row for each pixel of distance.
class TopView {
 public:
  /// rows: memory for the rows, kept by the caller.
  TopView(const cv::Mat& image, const cv::Mat& mask, const StereoRig& rig, const GroundAxes& axes,
          const RunwayCrossSection& runway, std::vector<Across>& rows)
      : image_(image), mask_(mask), rig_(rig), axes_(axes), step_(1 / rig.fy), rows_(rows) {
    for (int c = 0; c < kColumns; ++c)
      across_[c] = runway.centre + ((c + 0.5) / kColumns - 0.5) * kAcross * runway.width;
    // Stations lie evenly in the inverse of the distance, as pixels do.
    const double farthest = std::min(kFarthest, std::sqrt(kFootprint * runway.width / step_));
    rows_.clear();
    bool begun = false;
    for (int k = 0;; ++k) {
      const double inverse = 1 / kNearest - k * step_;
      if (inverse <= 1 / farthest) break;
      rows_.emplace_back();
      if (sample(1 / inverse, rows_.back())) {
        begun = true;
        inverse_.push_back(inverse);
      } else {
        rows_.pop_back();
        if (begun) break;
      }
    }
  }

  int size() const { return static_cast<int>(rows_.size()); }
  const Across& row(int k) const { return rows_[k]; }
  /// Forward of the camera, in heights, of a station that need not be whole.
  double distance(double k) const { return 1 / (inverse_.front() - k * step_); }
  /// Of one station, in heights.
  double footprint(double k) const { return step_ * distance(k) * distance(k); }

 private:
  static constexpr double kNearest = 0.5;  // heights

  bool sample(double x, Across& row) const {
    Places columns, lines;
    project({x * axes_.forward + axes_.down, axes_.left, rig_.fx, rig_.fy, rig_.cx, rig_.cy}, across_,
            columns, lines);
    int inside = 0;
    for (int c = 0; c < kColumns; ++c) {
      row[c] = greyAt(columns[c], lines[c]);
      inside += std::isnan(row[c]) ? 0 : 1;
    }
    return inside >= kLeastPicture * kColumns;
  }

  float greyAt(double u, double v) const {
    // Beside the camera pixels are farther out than an int can say.
    if (!(u >= 0 && v >= 0 && u < image_.cols - 1 && v < image_.rows - 1))
      return std::numeric_limits<float>::quiet_NaN();
    const int i = static_cast<int>(v), j = static_cast<int>(u);
    if (mask_.at<uchar>(i, j) == 0) return std::numeric_limits<float>::quiet_NaN();
    const double s = u - j, t = v - i;
    const uchar *above = image_.ptr<uchar>(i) + j, *below = image_.ptr<uchar>(i + 1) + j;
    return static_cast<float>((1 - t) * ((1 - s) * above[0] + s * above[1]) +
                              t * ((1 - s) * below[0] + s * below[1]));
  }

  const cv::Mat &image_, &mask_;
  const StereoRig& rig_;
  const GroundAxes& axes_;
  double step_;
  Places across_;  // left of the camera, in heights
  std::vector<double> inverse_;
  std::vector<Across>& rows_;
};

double meanOf(const Across& row) {
  double sum = 0;
  int count = 0;
  for (const float value : row) {
    if (!std::isfinite(value)) continue;
    sum += value;
    ++count;
  }
  return count > 0 ? sum / count : 0;
}

/// Mean of the stations around k.
Across blockAround(const TopView& view, int k) {
  Across block = view.row(k - kBlock);
  for (int i = k - kBlock + 1; i <= k + kBlock; ++i)
    for (int c = 0; c < kColumns; ++c) block[c] += view.row(i)[c];
  for (float& value : block) value /= 2 * kBlock + 1;
  return block;
}

/// Contrast of bars side by side, grey levels; 0 when the pattern is not of bars, or of less contrast.
double barContrast(const Across& pattern, double least) {
  Across known;
  const auto end = std::copy_if(pattern.begin(), pattern.end(), known.begin(),
                                [](float value) { return std::isfinite(value); });
  const std::ptrdiff_t count = end - known.begin();
  if (count < kLeastPicture * kColumns) return 0;
  // Most of the runway is nearly of one grey: too few are lighter than the darkest by so much.
  constexpr float kSafe = 0.999F;
  const float lighter = *std::min_element(known.begin(), end) + kSafe * static_cast<float>(least);
  if (std::count_if(known.begin(), end, [=](float value) { return value >= lighter; }) <= count / 8) return 0;
  const auto from_below = known.begin() + count / 8, from_above = end - 1 - count / 8;
  std::nth_element(known.begin(), from_below, end);
  std::nth_element(from_below, from_above, end);
  const float dark = *from_below, light = *from_above;
  const float contrast = light - dark;
  if (contrast < least) return 0;
  int flips = 0, last = 0, state = 0, gap = 0;
  for (int c = 0; c < kColumns; ++c) {
    if (!std::isfinite(pattern[c])) {
      last = c;  // outside the picture: nothing is known to be missing
      continue;
    }
    const float level = (pattern[c] - dark) / contrast;
    const int now = level > 0.65F ? 1 : (level < 0.35F ? -1 : state);
    if (now != state) {
      gap = std::max(gap, c - last);
      last = c;
      if (state != 0) ++flips;
      state = now;
    }
  }
  gap = std::max(gap, kColumns - last);
  return flips >= kLeastFlips && gap <= kLargestGap * kColumns ? contrast : 0;
}

/// The median when enough of the lengths are like it; 0 otherwise.
double commonLength(std::vector<double>& lengths, double tolerance, int fewest) {
  if (lengths.empty()) return 0;
  std::nth_element(lengths.begin(), lengths.begin() + lengths.size() / 2, lengths.end());
  const double middle = lengths[lengths.size() / 2];
  const auto alike = std::count_if(lengths.begin(), lengths.end(), [&](double length) {
    return std::abs(length - middle) <= tolerance * middle;
  });
  return alike >= fewest && alike >= kLeastAlike * lengths.size() ? middle : 0;
}

/// From bar to bar, in columns; 0 when they are not evenly apart or not equally wide: the marks of the
/// aiming point with the centre line between them are no zebra.
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

/// How much of the pattern is in a station: 1 where it is as in the pattern, 0 where there is nothing of it.
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

/// Place between stations k and k + step where the share falls through one half.
double crossing(double k, double step, double inside, double outside) {
  return k + step * (inside - 0.5) / std::max(inside - outside, 1e-6);
}

/// Where the bars begin and end, stations; nothing when that is not in the picture.
struct Bars {
  double contrast = 0;
  double begin = 0, end = 0;
  double pitch = 0;  // columns
};

/// Whether the bars are the same at both ends, and on both sides of the centre line. Texture is neither.
bool areBars(const TopView& view, const Bars& bars) {
  const int first = static_cast<int>(std::ceil(bars.begin)) + 1, last = static_cast<int>(bars.end) - 1;
  if (last - first < 2 * kBlock) return false;
  const int quarter = (last - first) / 4;
  const auto block = [&](int k) {
    return blockAround(view, std::clamp(k, kBlock, view.size() - 1 - kBlock));
  };
  const Across near = block(first + quarter), far = block(last - quarter);
  Across mirrored = near;
  std::reverse(mirrored.begin(), mirrored.end());
  return correlation(near, far) >= kLeastLikeness && correlation(near, mirrored) >= kLeastLikeness;
}

std::optional<Bars> findBars(const TopView& view) {
  int anchor = -1;
  Bars bars;
  for (int k = kBlock; k + kBlock < view.size(); ++k) {
    const double contrast = barContrast(blockAround(view, k), std::max(kLeastContrast, bars.contrast));
    if (contrast <= bars.contrast) continue;
    bars.contrast = contrast;
    anchor = k;
  }
  if (anchor < 0) return std::nullopt;
  const Across pattern = blockAround(view, anchor);
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

/// Share of the width on which it gets brighter towards the far side around a station by at least this much.
/// The line may lie slightly aslant.
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

/// The near edge of the line before the bars.
struct Line {
  double spanning = 0;  // largest share of the width on which there is something like it
  double station = 0;
};

Line findLine(const TopView& view, const Bars& bars, int first) {
  Line line;
  double steepest = 0;
  const int end = static_cast<int>(bars.begin) - 2;  // what rises there is the bars
  for (int k = std::max(2, first); k < end; ++k) {
    const double spanning = rising(view, k, kLineContrast * bars.contrast);
    line.spanning = std::max(line.spanning, spanning);
    if (spanning < kSpanning) continue;
    const auto slope = [&](int i) { return meanOf(view.row(i + 1)) - meanOf(view.row(i - 1)); };
    const double here = slope(k);
    if (here <= steepest) continue;
    steepest = here;
    // Top of the parabola through three slopes.
    const double before = slope(k - 1), after = slope(k + 1), curve = before - 2 * here + after;
    line.station = k + (curve < 0 ? std::clamp(0.5 * (before - after) / curve, -1.0, 1.0) : 0.0);
  }
  return line;
}

/// Step of the brightness around a station, alike all across the runway.
struct Step {
  double mean = 0;     // grey levels, towards the far side
  bool clear = false;  // against what it varies across
};

Step stepAt(const TopView& view, int k) {
  std::vector<double> steps;
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
  if (steps.size() < kLeastPicture * kStretches) return step;
  const double count = static_cast<double>(steps.size());
  for (const double s : steps) step.mean += s / count;
  double square = 0;
  for (const double s : steps) square += std::pow(s - step.mean, 2);
  const double standard_error = std::sqrt(square / (count - 1) / count);
  const bool one_way = std::all_of(steps.begin(), steps.end(), [&](double s) { return s * step.mean > 0; });
  step.clear = one_way && std::abs(step.mean) >= std::max(kLeastStep, kClearStep * standard_error);
  return step;
}

/// Station at which the pavement of the bars begins: a step of the brightness, either way, right across.
std::optional<double> findPavement(const TopView& view, const Bars& bars, int first) {
  const int begin = std::max(2, first), end = static_cast<int>(bars.begin) - 2;  // free of the bars
  std::vector<Step> steps;
  double clearest = 0;
  for (int k = begin; k < end; ++k) {
    steps.push_back(stepAt(view, k));
    if (steps.back().clear) clearest = std::max(clearest, std::abs(steps.back().mean));
  }
  for (size_t i = 1; i + 1 < steps.size(); ++i) {
    const double here = std::abs(steps[i].mean);
    if (!steps[i].clear || here < kFirstStep * clearest) continue;
    const double sign = steps[i].mean > 0 ? 1 : -1;
    const double before = sign * steps[i - 1].mean, after = sign * steps[i + 1].mean;
    if (before > here || after > here) continue;
    const double curve = before - 2 * here + after;
    return begin + static_cast<double>(i) + (curve < 0 ? 0.5 * (before - after) / curve : 0.0);
  }
  return std::nullopt;
}

template <class... Parts>
tl::unexpected<Failure> noThreshold(const Parts&... parts) {
  return tl::make_unexpected(Failure{Reason::kNoRunway, text(parts...)});
}

}  // namespace

Expected<Threshold> findThreshold(const cv::Mat& image, const cv::Mat& mask, const StereoRig& rig,
                                  const GroundAxes& axes, const RunwayCrossSection& runway) {
  static thread_local std::vector<Across> rows;  // keep their memory
  const TopView view(image, mask, rig, axes, runway, rows);
  const std::optional<Bars> bars = findBars(view);
  if (!bars) return noThreshold("no threshold bars in the picture");
  const double begin = view.distance(bars->begin);
  if (view.distance(bars->end) - begin < kShortestBars * runway.width)
    return noThreshold("bars of the threshold are too short");
  // The line before them must be in the picture if there is one: without it the bars tell nothing.
  const double farthest = kFarthestBars * bars->pitch / kColumns * kAcross * runway.width;
  const double search = begin - std::max(kLineSearch * runway.width, kSearched * farthest);
  int first = 0;
  while (first < view.size() && view.distance(first) < search) ++first;
  if (first == 0) return noThreshold("what lies before the threshold bars is not in the picture");
  const Line line = findLine(view, *bars, first);
  std::optional<double> seen;
  if (line.spanning >= kSpanning) {
    seen = line.station;
  } else {
    while (view.distance(first) < begin - kSearched * farthest) ++first;
    seen = findPavement(view, *bars, first);
  }
  if (!seen && line.spanning > kNothing)
    return noThreshold("a mark before the bars takes ", line.spanning, " of the width");
  const double station = seen.value_or(bars->begin);
  Threshold threshold;
  threshold.distance = view.distance(station);
  const Eigen::Vector3d by_rotation =
      GroundAxes::meetByRotation({threshold.distance, runway.centre}).row(0).transpose();
  threshold.variance =
      std::pow(kLocation * view.footprint(station), 2) + by_rotation.dot(axes.covariance * by_rotation);
  if (!seen) {
    // As well at the bars as at the farthest: the standard deviation takes in both.
    threshold.distance -= 0.5 * farthest;
    threshold.systematic_variance = std::pow(0.5 * farthest, 2);
    threshold.variance += threshold.systematic_variance + std::pow(kPitchError * farthest, 2);
  }
  return threshold;
}

}  // namespace uav_landing
