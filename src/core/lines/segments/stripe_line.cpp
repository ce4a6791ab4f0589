#include "lines/segments/stripe_line.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "kernels/edges/falls.h"
#include "lines/segments/line_fit.h"

namespace uav_landing {

using namespace line_fit;

namespace {

constexpr int kReach = kFallReach;  // px on each side of the line in which its other side is looked for
constexpr int kOffLine = 1;         // px by which the edge may be off its line
constexpr int kStations = 40;       // rows or columns looked at, roughly
constexpr int kMinStations = 6;
constexpr double kApart = 4.0;       // px between sides that do not disturb each other, at blurs up to 1.3 px
constexpr double kBlur = 0.8;        // px, 1 sigma: error of a side that cannot be corrected
constexpr double kMinShare = 0.4;    // gradient of the other side over that of this one
constexpr double kMinSupport = 0.6;  // share of the stations that must show the other side
constexpr double kMaxScatter = 0.6;  // px

/// The pixels across the line at one station.
struct Profile {
  static constexpr int kMargin = kFallMargin;  // pixels on each side

  const uchar* grey;    // at the middle, among the pixels across
  int station, centre;  // row and column of the middle, or the other way round
  int sign;
  std::array<uchar, 2 * kMargin + 1> column;  // for pixels that are not next to each other in the image

  /// Twice the gradient along the row or column, k pixels from the middle, positive towards the brighter
  /// side.
  int at(int k) const { return sign * (grey[k + 1] - grey[k - 1]); }
  /// Extremum at pixel k and its neighbours, px from the middle.
  double peak(int k) const {
    const int curvature = at(k - 1) - 2 * at(k) + at(k + 1);
    return curvature == 0 ? k : k + 0.5 * (at(k - 1) - at(k + 1)) / curvature;
  }
};

/// Looks at the pixels across one line.
class Profiles {
 public:
  /// sign: of the line's own gradient across it.
  Profiles(const cv::Mat& image, const cv::Mat& ground, const Axis& axis, int sign)
      : image_(image),
        ground_(ground),
        axis_(axis),
        sign_(axis.across[axis.minor] < 0 ? -sign : sign),
        size_(axis.minor == 0 ? image.cols : image.rows),
        length_(axis.major == 0 ? image.cols : image.rows),
        neighbour_(axis.minor == 0 ? 1 : static_cast<std::ptrdiff_t>(image.step)),
        slope_(axis.along[axis.minor] / axis.along[axis.major]) {}

  /// False when the line is not on the ground or too near the border.
  bool look(int station, Profile& profile) const {
    const int centre = cvRound(axis_.origin[axis_.minor] + slope_ * (station - axis_.origin[axis_.major]));
    constexpr int kMargin = Profile::kMargin;
    if (centre < kMargin || centre >= size_ - kMargin || station < 0 || station >= length_) return false;
    const cv::Point pixel = axis_.major == 1 ? cv::Point(centre, station) : cv::Point(station, centre);
    if (ground_.at<uchar>(pixel) == 0) return false;
    profile.grey = image_.ptr<uchar>(pixel.y) + pixel.x;
    profile.station = station;
    profile.centre = centre;
    profile.sign = sign_;
    if (neighbour_ == 1) return true;
    const uchar* grey = profile.grey - kMargin * neighbour_;
    for (uchar& to : profile.column) {
      to = *grey;
      grey += neighbour_;
    }
    profile.grey = &profile.column[kMargin];
    return true;
  }
  /// Distances along and across the line of a place this many pixels from the profile's middle.
  Eigen::Vector2d place(const Profile& profile, double k) const {
    const double major = profile.station - axis_.origin[axis_.major];
    const double minor = profile.centre + k - axis_.origin[axis_.minor];
    return {axis_.along[axis_.major] * major + axis_.along[axis_.minor] * minor,
            axis_.across[axis_.major] * major + axis_.across[axis_.minor] * minor};
  }
  /// Gradient across the line, grey/px.
  double gradient(int twice) const { return 0.5 * twice / std::abs(axis_.across[axis_.minor]); }

 private:
  const cv::Mat &image_, &ground_;
  const Axis& axis_;
  int sign_, size_, length_;
  std::ptrdiff_t neighbour_;
  double slope_;
};

/// The edge at one station, and the nearest edge of the other sign on each side; pixels across the line.
struct Station {
  double along, edge, gradient;
  std::array<double, 2> other;  // position; NaN: none
  std::array<double, 2> other_gradient;
};

std::optional<Station> stationOf(const Profiles& profiles, const Profile& profile) {
  int own = 0;
  for (int k = -kOffLine; k <= kOffLine; ++k)
    if (profile.at(k) > profile.at(own)) own = k;
  const int strength = profile.at(own);
  if (!(strength > 0) || profile.at(own - 1) > strength || profile.at(own + 1) > strength)
    return std::nullopt;
  const Eigen::Vector2d edge = profiles.place(profile, profile.peak(own));
  Station station{edge.x(), edge.y(), profiles.gradient(strength), {NAN, NAN}, {0, 0}};
  // Places where the gradient has minima.
  const unsigned minima =
      markFalls(profile.grey, profile.sign, static_cast<int>(std::ceil(kMinShare * strength)));
  const unsigned before = minima & ((1U << (own + kReach)) - 1), after = minima >> (own + kReach + 1);
  const auto set = [&](int side, int k) {
    station.other[side] = profiles.place(profile, profile.peak(k)).y();
    station.other_gradient[side] = profiles.gradient(-profile.at(k));
  };
  if (before != 0) set(0, 31 - __builtin_clz(before) - kReach);
  if (after != 0) set(1, own + 1 + __builtin_ctz(after));
  return station;
}

std::optional<LineSegment> fitted(const Axis& axis, const std::vector<Peak>& seen, int sign) {
  if (static_cast<int>(seen.size()) < kMinStations) return std::nullopt;
  Peaks peaks;
  for (const Peak& peak : seen) peaks.add(peak);
  double scale = 0;
  const Fit fit = fitRobustly(peaks, scale);
  if (peaks.used() < kMinStations || scale > kMaxScatter) return std::nullopt;
  return segmentOf(axis, peaks, fit, sign);
}

/// The side on which the stripe is; nothing when no stripe is narrow enough to disturb the edge. Between two
/// neighbours at the same distance an edge is pushed equally to both sides.
std::optional<int> narrowSide(const std::vector<Station>& stations) {
  std::array<int, 2> close{};
  for (const Station& station : stations)
    for (const int side : {0, 1})
      close[side] += std::abs(station.other[side] - station.edge) < kApart ? 1 : 0;
  if (std::max(close[0], close[1]) < kMinStations / 2) return std::nullopt;
  return close[0] >= close[1] ? 0 : 1;
}

/// Stations of a line that reaches half this way on each side of its middle.
std::vector<Station> stationsAlong(const Profiles& profiles, const Axis& axis, double half) {
  std::vector<Station> stations;
  const int first = static_cast<int>(std::ceil(axis.point(-half)[axis.major]));
  const int last = static_cast<int>(std::floor(axis.point(half)[axis.major]));
  const int step = std::max(1, (last - first) / kStations);
  stations.reserve(2 * kStations);
  // All stations are looked up first, so that the waiting times for their memory overlap.
  std::array<Profile, 2 * kStations> seen;
  size_t count = 0;
  for (int at = first; at <= last; at += step) count += profiles.look(at, seen[count]) ? 1 : 0;
  for (size_t i = 0; i < count; ++i)
    if (const auto station = stationOf(profiles, seen[i])) stations.push_back(*station);
  return stations;
}

struct Replacement {
  LineSegment line;
  bool middle;  // of a stripe
};

std::optional<Replacement> replacementOf(const cv::Mat& image, const cv::Mat& ground,
                                         const LineSegment& line) {
  const Axis axis(line.middle(), line.b - line.a);
  const int sign = axis.across.dot(line.line.head<2>()) >= 0 ? 1 : -1;
  const Profiles profiles(image, ground, axis, sign);
  const std::vector<Station> stations = stationsAlong(profiles, axis, 0.5 * line.length());
  const std::optional<int> side = narrowSide(stations);
  if (!side) return std::nullopt;

  std::vector<Peak> clear, middle;
  clear.reserve(stations.size());
  middle.reserve(stations.size());
  for (const Station& station : stations) {
    const double other = station.other[*side];
    if (!(std::abs(other - station.edge) < kApart))
      clear.push_back({station.along, station.edge, station.gradient});
    if (std::isfinite(other))
      middle.push_back({station.along, 0.5 * (station.edge + other),
                        std::min(station.gradient, station.other_gradient[*side])});
  }
  if (static_cast<double>(middle.size()) < kMinSupport * static_cast<double>(stations.size())) middle.clear();
  const std::optional<LineSegment> edge = fitted(axis, clear, sign);
  const std::optional<LineSegment> centre = fitted(axis, middle, sign);
  if (!edge && !centre) {
    LineSegment uncertain = line;
    uncertain.offset_stddev = std::hypot(uncertain.offset_stddev, kBlur);
    return Replacement{uncertain, false};
  }
  if (centre && (!edge || centre->angle_stddev < edge->angle_stddev)) return Replacement{*centre, true};
  return Replacement{*edge, false};
}

bool isSame(const LineSegment& a, const LineSegment& b) {
  constexpr double kSame = 0.5;  // px
  return std::abs(a.line.dot(b.middle().homogeneous())) < kSame &&
         std::abs(b.line.dot(a.middle().homogeneous())) < kSame;
}

}  // namespace

std::vector<LineSegment> withoutStripeBias(const cv::Mat& image, const cv::Mat& ground,
                                           const std::vector<LineSegment>& lines) {
  std::vector<LineSegment> result = lines;
  std::vector<size_t> middles;
  for (size_t i = 0; i < lines.size(); ++i) {
    const std::optional<Replacement> replacement = replacementOf(image, ground, lines[i]);
    if (!replacement) continue;
    result[i] = replacement->line;
    if (replacement->middle) middles.push_back(i);
  }
  std::vector<double> shared;
  for (const size_t i : middles)
    shared.push_back(std::sqrt(static_cast<double>(std::count_if(
        middles.begin(), middles.end(), [&](size_t j) { return i == j || isSame(result[i], result[j]); }))));
  for (size_t k = 0; k < middles.size(); ++k) {
    result[middles[k]].offset_stddev *= shared[k];
    result[middles[k]].angle_stddev *= shared[k];
  }
  return result;
}

}  // namespace uav_landing
