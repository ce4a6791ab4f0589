#include "stripe_line.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "line_fit.h"

namespace uav_landing {

using namespace line_fit;

namespace {

constexpr int kReach = 12;     // px to both sides of the line, where its other side is looked for
constexpr int kOffLine = 1;    // px by which the edge may be off its line
constexpr int kStations = 80;  // rows or columns looked at, roughly
constexpr int kMinStations = 6;
constexpr double kApart = 4.0;       // px between sides that do not disturb each other, at blurs up to 1.3 px
constexpr double kBlur = 0.8;        // px, 1 sigma: by how much it misplaces a side that cannot be mended
constexpr double kMinShare = 0.4;    // gradient of the other side, of this one's
constexpr double kMinSupport = 0.6;  // share of the stations that must show the other side
constexpr double kMaxScatter = 0.6;  // px

/// Gradient across the line, positive towards the line's brighter side, at pixels around it.
struct Profile {
  std::array<double, 2 * kReach + 3> gradient;  // from -kReach - 1
  cv::Point centre;

  double at(int k) const { return gradient[k + kReach + 1]; }
  /// Extremum at pixel k and its neighbours, px from the centre.
  double peak(int k) const {
    const double curvature = at(k - 1) - 2 * at(k) + at(k + 1);
    return curvature == 0 ? k : k + 0.5 * (at(k - 1) - at(k + 1)) / curvature;
  }
};

std::optional<Profile> profileAt(const cv::Mat& image, const cv::Mat& ground, const Axis& axis, int sign,
                                 int station) {
  constexpr int kMargin = kReach + 2;
  const int centre =
      cvRound(axis.point((station - axis.origin[axis.major]) / axis.along[axis.major])[axis.minor]);
  const int size = axis.minor == 0 ? image.cols : image.rows;
  const int length = axis.major == 0 ? image.cols : image.rows;
  if (centre < kMargin || centre >= size - kMargin || station < 0 || station >= length) return std::nullopt;
  Profile profile;
  profile.centre = axis.major == 1 ? cv::Point(centre, station) : cv::Point(station, centre);
  if (ground.at<uchar>(profile.centre) == 0) return std::nullopt;
  const uchar* middle = image.ptr<uchar>(profile.centre.y) + profile.centre.x;
  const std::ptrdiff_t step = axis.minor == 0 ? 1 : static_cast<std::ptrdiff_t>(image.step);
  const double scale = 0.5 * sign / axis.across[axis.minor];
  for (int k = -kReach - 1; k <= kReach + 1; ++k)
    profile.gradient[k + kReach + 1] = scale * (middle[(k + 1) * step] - middle[(k - 1) * step]);
  return profile;
}

/// The edge at one station and, to each side, the nearest edge of the other sign; pixels across the line.
struct Station {
  double along, edge, gradient;
  std::array<double, 2> other;  // position; unset: NaN
  std::array<double, 2> other_gradient;
};

std::optional<Station> stationOf(const Profile& profile, const Axis& axis) {
  int own = 0;
  for (int k = -kOffLine; k <= kOffLine; ++k)
    if (profile.at(k) > profile.at(own)) own = k;
  const double strength = profile.at(own);
  if (!(strength > 0) || profile.at(own - 1) > strength || profile.at(own + 1) > strength)
    return std::nullopt;
  const auto place = [&](double k) {
    Eigen::Vector2d p(profile.centre.x, profile.centre.y);
    p[axis.minor] += k;
    return Eigen::Vector2d(p - axis.origin);
  };
  const Eigen::Vector2d edge = place(profile.peak(own));
  Station station{axis.along.dot(edge), axis.across.dot(edge), strength, {NAN, NAN}, {0, 0}};
  for (const int side : {0, 1}) {
    const int step = side == 0 ? -1 : 1;
    for (int k = own + step; std::abs(k) <= kReach; k += step) {
      const double here = -profile.at(k);
      if (here < kMinShare * strength || here < -profile.at(k - 1) || here < -profile.at(k + 1)) continue;
      station.other[side] = axis.across.dot(place(profile.peak(k)));
      station.other_gradient[side] = here;
      break;
    }
  }
  return station;
}

std::optional<LineSegment> fitted(const Axis& axis, const std::vector<Peak>& seen, int sign) {
  if (static_cast<int>(seen.size()) < kMinStations) return std::nullopt;
  Peaks peaks;
  peaks.resize(static_cast<int>(seen.size()));
  for (int i = 0; i < peaks.size(); ++i) peaks.set(i, seen[i]);
  double scale = 0;
  const Fit fit = fitRobustly(peaks, scale);
  if ((peaks.weight > 0).count() < kMinStations || scale > kMaxScatter) return std::nullopt;
  return segmentOf(axis, peaks, fit, sign);
}

/// Which side the stripe is on; nothing when there is none that is narrow enough to disturb the edge.
/// Between two neighbours at the same distance an edge is pushed both ways alike.
std::optional<int> narrowSide(const std::vector<Station>& stations) {
  std::array<int, 2> seen{}, close{};
  for (const Station& station : stations)
    for (const int side : {0, 1}) {
      const double width = std::abs(station.other[side] - station.edge);
      seen[side] += std::isfinite(width) ? 1 : 0;
      close[side] += width < kApart ? 1 : 0;
    }
  if (std::max(close[0], close[1]) < kMinStations / 2) return std::nullopt;
  return close[0] >= close[1] ? 0 : 1;
}

struct Replacement {
  LineSegment line;
  bool middle;  // of a stripe
};

std::optional<Replacement> replacementOf(const cv::Mat& image, const cv::Mat& ground,
                                         const LineSegment& line) {
  const Axis axis(line.middle(), line.b - line.a);
  const int sign = axis.across.dot(line.line.head<2>()) >= 0 ? 1 : -1;
  const double half = 0.5 * line.length();
  const int first = static_cast<int>(std::ceil(axis.point(-half)[axis.major]));
  const int last = static_cast<int>(std::floor(axis.point(half)[axis.major]));
  std::vector<Station> stations;
  const int step = std::max(1, (last - first) / kStations);
  for (int at = first; at <= last; at += step)
    if (const auto profile = profileAt(image, ground, axis, sign, at))
      if (const auto station = stationOf(*profile, axis)) stations.push_back(*station);
  const std::optional<int> side = narrowSide(stations);
  if (!side) return std::nullopt;

  std::vector<Peak> clear, middle;
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
