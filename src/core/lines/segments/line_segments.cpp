#include "lines/segments/line_segments.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <tuple>

#include "image/input/mask_bounds.h"
#include "kernels/image/transpose.h"
#include "lines/segments/line_refinement.h"
#include "lines/segments/straight_edge.h"

namespace uav_landing {

namespace {

constexpr int kMaxCandidates = 250;  // segments refined: first those that may be along the runway, then the
                                     // longest
constexpr int kMaxLines = 150;       // lines returned, longest first
constexpr int kMaxHoughLines = 400;  // infinite lines of the standard transform, most votes first
constexpr double kHoughAngle = CV_PI / 180;
constexpr double kUnrefinedStddev = 0.5;  // px, of the ends of a line that is not refined
constexpr double kSobelScale = 8;         // 3x3 Sobel response over the gradient in grey/px
constexpr double kSameEdge = 1.0;         // px between segments of one edge

using Ends = std::pair<Eigen::Vector2d, Eigen::Vector2d>;

/// Whether the gradient keeps direction and strength for several pixels along the edge. Texture does not;
/// without it the Hough transform is both faster and cleaner.
bool isStraightHere(const cv::Mat& dx, const cv::Mat& dy, int u, int v) {
  constexpr int kSteps = 2;  // on each side
  const float gx = dx.at<short>(v, u), gy = dy.at<short>(v, u);
  const float scale = kAlongEdge / std::max(std::abs(gx), std::abs(gy));
  int agreeing = 0;
  for (const int side : {-1, 1}) {
    for (int i = 1; i <= kSteps; ++i) {
      const int x = u - cvRound(gy * scale * side * i), y = v + cvRound(gx * scale * side * i);
      if (x < 0 || y < 0 || x >= dx.cols || y >= dx.rows) break;
      if (!alikeAlongEdge(gx, gy, dx.at<short>(y, x), dy.at<short>(y, x))) break;
      ++agreeing;
    }
    if (agreeing + kSteps < kAlikeAlongEdge) return false;
  }
  return agreeing >= kAlikeAlongEdge;
}

cv::Mat straightEdges(const cv::Mat& image, const cv::Mat& ground,
                      const ApproachAngleParameters& parameters) {
  cv::Mat dx, dy, edges;
  cv::Sobel(image, dx, CV_16S, 1, 0);
  cv::Sobel(image, dy, CV_16S, 0, 1);
  cv::Canny(dx, dy, edges, parameters.canny_low, std::max(parameters.canny_low, parameters.canny_high));
  for (int v = 0; v < edges.rows; ++v) {
    uchar* edge = edges.ptr<uchar>(v);
    const uchar* inside = ground.ptr<uchar>(v);
    for (int u = 0; u < edges.cols; ++u)
      if (edge[u] != 0 && (inside[u] == 0 || !isStraightHere(dx, dy, u, v))) edge[u] = 0;
  }
  return edges;
}

struct StretchLimits {
  double min_length, max_gap;  ///< px
};

/// Stretches of an infinite line (rho, theta) with edge pixels within 1 px.
void cutLine(const cv::Mat& edges, const cv::Vec2f& line, const StretchLimits& limits,
             std::vector<RoughSegment>& segments) {
  const auto [rho, theta] = line.val;
  const Eigen::Vector2d normal(std::cos(theta), std::sin(theta)), along(-normal.y(), normal.x());
  const Eigen::Vector2d foot = rho * normal;
  const bool steep = std::abs(along.y()) > std::abs(along.x());
  const int steps = steep ? edges.rows : edges.cols;
  const auto point = [&](int i) -> Eigen::Vector2d {
    const int axis = steep ? 1 : 0;
    return foot + along * ((i - foot[axis]) / along[axis]);
  };
  const auto supported = [&](const Eigen::Vector2d& p) {
    for (const int side : {0, -1, 1}) {
      const int x = cvRound(p.x()) + (steep ? side : 0), y = cvRound(p.y()) + (steep ? 0 : side);
      if (x >= 0 && y >= 0 && x < edges.cols && y < edges.rows && edges.at<uchar>(y, x) != 0) return true;
    }
    return false;
  };
  std::optional<Ends> open;
  const auto close = [&] {
    if (open && (open->second - open->first).norm() >= limits.min_length)
      segments.push_back({open->first, open->second});
    open.reset();
  };
  for (int i = 0; i < steps; ++i) {
    const Eigen::Vector2d p = point(i);
    if (!supported(p)) continue;
    if (open && (p - open->second).norm() > limits.max_gap + 1) close();
    if (!open) open = Ends(p, p);
    open->second = p;
  }
  close();
}

std::vector<RoughSegment> houghSegments(const cv::Mat& edges, double min_length,
                                        const ApproachAngleParameters& parameters) {
  std::vector<RoughSegment> segments;
  if (parameters.hough_method == HoughMethod::kStandard) {
    std::vector<cv::Vec2f> lines;
    cv::HoughLines(edges, lines, 1, kHoughAngle, parameters.hough_threshold);
    if (lines.size() > kMaxHoughLines) lines.resize(kMaxHoughLines);
    for (const cv::Vec2f& line : lines) cutLine(edges, line, {min_length, parameters.max_line_gap}, segments);
  } else {
    std::vector<cv::Vec4i> lines;
    cv::HoughLinesP(edges, lines, 1, kHoughAngle, parameters.hough_threshold, min_length,
                    parameters.max_line_gap);
    for (const cv::Vec4i& l : lines)
      segments.push_back({{double(l[0]), double(l[1])}, {double(l[2]), double(l[3])}});
  }
  return segments;
}

/// Also transposes the image; the result is valid until the next use of the scanner.
std::vector<RoughSegment> roughSegments(EdgePicture& picture, double min_length,
                                        const ApproachAngleParameters& parameters, SegmentScanner& scanner) {
  if (parameters.hough_method != HoughMethod::kScanLines) {
    cv::transpose(picture.image, picture.transposed);
    return houghSegments(straightEdges(picture.image, picture.ground, parameters), min_length, parameters);
  }
  std::vector<RoughSegment> segments =
      scanner.find(picture.image, picture.ground,
                   {parameters.canny_low, parameters.canny_high, min_length, parameters.max_line_gap});
  picture.transposed = scanner.transposed();
  return segments;
}

/// Longest first. Equal lengths are sorted by coordinates, so that every machine gives the same result.
template <class T, class EndsOf>
void keepLongest(std::vector<T>& items, size_t count, const EndsOf& ends) {
  const auto key = [&](const T& item) {
    const auto [a, b] = ends(item);
    return std::make_tuple(-(b - a).squaredNorm(), a.x(), a.y(), b.x(), b.y());
  };
  std::sort(items.begin(), items.end(), [&](const T& l, const T& r) { return key(l) < key(r); });
  if (items.size() > count) items.resize(count);
}

/// Whether both ends of a segment lie on this line, and part of the segment within the line's ends.
bool overlaps(const LineSegment& line, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  if (std::abs(line.line.dot(a.homogeneous())) > kSameEdge ||
      std::abs(line.line.dot(b.homogeneous())) > kSameEdge)
    return false;
  const Eigen::Vector2d along = (line.b - line.a).normalized();
  const double p = along.dot(a - line.a), q = along.dot(b - line.a);
  return std::max(p, q) >= 0 && std::min(p, q) <= line.length();
}

/// Adds a refined line. If it is an edge already found, the longer of the two is kept. The other edge of a
/// thin stripe is another line, because its brighter side is the opposite one.
void addOrMerge(std::vector<LineSegment>& lines, const LineSegment& line) {
  const auto same = std::find_if(lines.begin(), lines.end(), [&line](const LineSegment& other) {
    return other.line.head<2>().dot(line.line.head<2>()) > 0 &&
           (overlaps(other, line.a, line.b) || overlaps(line, other.a, other.b));
  });
  if (same == lines.end())
    lines.push_back(line);
  else if (line.length() > same->length())
    *same = line;
}

/// Whether this rough segment is a piece of a line already found, which saves refining it again.
bool isKnown(const std::vector<LineSegment>& lines, const RoughSegment& segment) {
  return std::any_of(lines.begin(), lines.end(), [&](const LineSegment& line) {
    return line.line.head<2>().dot(segment.brighter) > 0 && overlaps(line, segment.a, segment.b);
  });
}

LineSegment asFound(const RoughSegment& s) {
  const double angle_stddev = kUnrefinedStddev * std::sqrt(12.0) / (s.b - s.a).norm();
  const LineSegment line = makeLineSegment(s.a, s.b, kUnrefinedStddev, angle_stddev);
  if (line.line.head<2>().dot(s.brighter) >= 0) return line;
  return makeLineSegment(s.b, s.a, kUnrefinedStddev, angle_stddev);
}

/// A part of an image, and the test of which of its lines are worth refining; null: all.
struct Part {
  EdgePicture picture;
  cv::Point origin;
  const HeadingGate* gate;

  Eigen::Vector2d offset() const { return {origin.x, origin.y}; }
  bool passes(const Eigen::Vector2d& a, const Eigen::Vector2d& b) const {
    return gate == nullptr || gate->passes((a + offset()).homogeneous().cross((b + offset()).homogeneous()));
  }
};

/// Refines the lines that pass and are as long as required. Those that do not pass stay as they are.
std::vector<LineSegment> refined(std::vector<RoughSegment>& candidates, const Part& part, double min_length,
                                 double min_gradient) {
  std::vector<LineSegment> lines;
  for (RoughSegment& segment : candidates) {
    if (segment.brighter.isZero()) segment.brighter = brighterSide(part.picture, segment.a, segment.b);
    if (isKnown(lines, segment)) continue;
    const std::optional<LineSegment> line = part.passes(segment.a, segment.b)
                                                ? refineLine(part.picture, segment, min_gradient)
                                                : asFound(segment);
    if (line && line->length() >= min_length) addOrMerge(lines, *line);
  }
  return lines;
}

std::vector<LineSegment> asFound(const std::vector<RoughSegment>& candidates) {
  std::vector<LineSegment> lines;
  for (const RoughSegment& s : candidates)
    if (std::none_of(lines.begin(), lines.end(),
                     [&s](const LineSegment& line) { return overlaps(line, s.a, s.b); }))
      lines.push_back(asFound(s));
  return lines;
}

/// The part of a segment inside a rectangle (Liang and Barsky 1984).
std::optional<Ends> clipped(const Ends& ends, const cv::Rect2d& inside) {
  const Eigen::Vector2d along = ends.second - ends.first;
  double from = 0, to = 1;
  const auto cut = [&](int axis, double first, double last) {
    if (along[axis] == 0) {
      if (ends.first[axis] < first || ends.first[axis] > last) to = from;
      return;
    }
    const double enter = (first - ends.first[axis]) / along[axis];
    const double leave = (last - ends.first[axis]) / along[axis];
    from = std::max(from, std::min(enter, leave));
    to = std::min(to, std::max(enter, leave));
  };
  cut(0, inside.x, inside.x + inside.width);
  cut(1, inside.y, inside.y + inside.height);
  if (!(from < to)) return std::nullopt;
  return Ends(ends.first + from * along, ends.first + to * along);
}

/// Lines in coordinates of the whole image: those that pass first, each group longest first.
std::vector<LineSegment> ofWholeImage(std::vector<LineSegment> lines, const Part& part) {
  keepLongest(lines, lines.size(), [](const LineSegment& l) { return Ends(l.a, l.b); });
  std::stable_partition(lines.begin(), lines.end(),
                        [&](const LineSegment& line) { return part.passes(line.a, line.b); });
  if (lines.size() > kMaxLines) lines.resize(kMaxLines);
  for (LineSegment& line : lines) {
    line.a += part.offset();
    line.b += part.offset();
    line.line.z() -= line.line.head<2>().dot(part.offset());
  }
  return lines;
}

/// Weakest gradient of a line, grey/px.
double minGradient(const ApproachAngleParameters& parameters) {
  return 0.5 * parameters.canny_low / kSobelScale;
}

/// The part of the image in which lines are looked for; none when it is too small.
std::optional<Part> partWithLines(const RectifiedView& view, const HeadingGate* gate) {
  constexpr int kSmallest = 8;
  const cv::Rect bounds = boundsOf(view.mask);
  if (bounds.width < kSmallest || bounds.height < kSmallest) return std::nullopt;
  return Part{{view.image(bounds), {}, view.mask(bounds)}, bounds.tl(), gate};
}

}  // namespace

std::vector<LineSegment> findLines(const RectifiedView& view, const ApproachAngleParameters& parameters,
                                   const HeadingGate* gate, LineMemory& memory) {
  std::optional<Part> part = partWithLines(view, gate);
  if (!part) return {};
  const double min_length = parameters.min_line_length * view.image.rows;
  std::vector<RoughSegment> candidates = roughSegments(part->picture, min_length, parameters, memory.scanner);
  keepLongest(candidates, candidates.size(), [](const RoughSegment& s) { return Ends(s.a, s.b); });
  if (candidates.size() > kMaxCandidates) {
    // Texture may have more lines across the runway than the limit allows, so those that pass come first.
    std::stable_partition(candidates.begin(), candidates.end(),
                          [&](const RoughSegment& s) { return part->passes(s.a, s.b); });
    candidates.resize(kMaxCandidates);
  }
  return ofWholeImage(parameters.refine_lines
                          ? refined(candidates, *part, min_length, minGradient(parameters))
                          : asFound(candidates),
                      *part);
}

std::vector<LineSegment> findLines(const RectifiedView& view, const ApproachAngleParameters& parameters,
                                   const HeadingGate* gate) {
  LineMemory memory;
  return findLines(view, parameters, gate, memory);
}

std::vector<LineSegment> findLinesNear(const RectifiedView& view, const std::vector<RoughSegment>& expected,
                                       const ApproachAngleParameters& parameters, const HeadingGate& gate,
                                       LineMemory& memory) {
  std::optional<Part> part = partWithLines(view, &gate);
  if (!part) return {};
  const cv::Size size = part->picture.image.size();
  part->picture.transposed = memory.transposed.image({size.height, size.width});
  transpose(part->picture.image, part->picture.transposed);
  const cv::Rect2d inside(0, 0, size.width - 1, size.height - 1);
  std::vector<RoughSegment> candidates;
  for (const RoughSegment& line : expected) {
    const auto ends = clipped({line.a - part->offset(), line.b - part->offset()}, inside);
    if (ends && part->passes(ends->first, ends->second))
      candidates.push_back({ends->first, ends->second, line.brighter});
  }
  const double min_length = parameters.min_line_length * view.image.rows;
  return ofWholeImage(refined(candidates, *part, min_length, minGradient(parameters)), *part);
}

}  // namespace uav_landing
