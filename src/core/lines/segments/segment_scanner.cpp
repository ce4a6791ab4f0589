#include "lines/segments/segment_scanner.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <opencv2/core.hpp>

#include "kernels/edges/edge_growth.h"
#include "kernels/edges/edge_starts.h"
#include "kernels/image/transpose.h"
#include "lines/segments/straight_edge.h"

namespace uav_landing {

namespace {

constexpr double kScansPerLine = 3;  // scan lines that the shortest line along an image axis crosses
constexpr double kMaxScatter = 0.6;  // px, RMS of the stations about the line; whole pixels scatter by 0.3
constexpr double kMaxSlope = 1.1;    // px to the side per row; a flatter line belongs to the other axis
constexpr double kLargestResponse = 4 * 255 * 2;  // across and along together

/// The steep edges of an image: those whose normal is nearer to the rows than to the columns.
class SteepEdges {
 public:
  SteepEdges(const cv::Mat& image, const EdgeMask& ground, const EdgeLimits& limits, ImageMemory& taken)
      : image_(image),
        ground_(ground),
        limits_(limits),
        spacing_(std::max(1, static_cast<int>(limits.min_length * M_SQRT1_2 / kScansPerLine))),
        least_(static_cast<int>(std::ceil(limits.low / 2))),
        rows_{image.ptr<uchar>(), static_cast<std::ptrdiff_t>(image.step), image.cols, image.rows} {
    taken_ = taken.image({image.cols, image.rows / spacing_ + 1});
    taken_.setTo(0);
  }

  /// Follows the edges that cross the scan rows. emit(u0, v0, u1, v1, sign): sign is that of the gradient
  /// along the rows.
  template <class Emit>
  void scan(std::vector<short>& across, std::vector<short>& along, std::vector<uchar>& starts,
            const Emit& emit) {
    across.assign(image_.cols, 0);
    along.assign(image_.cols, 0);
    starts.assign(image_.cols, 0);
    const short least = static_cast<short>(std::min(std::ceil(limits_.high), kLargestResponse));
    for (int row = 0, v = spacing_ / 2; v < image_.rows; ++row, v += spacing_) {
      if (v < 1 || v + 1 >= image_.rows) continue;
      sobelRow(image_.ptr<uchar>(v - 1), image_.ptr<uchar>(v), image_.ptr<uchar>(v + 1), image_.cols,
               across.data(), along.data());
      markEdgeStarts(across.data(), along.data(), image_.cols, least, starts.data());
      const uchar* taken = taken_.ptr<uchar>(row);
      const auto next = [&](int from) {
        const void* start = std::memchr(&starts[from], 1, starts.size() - from);
        return start ? static_cast<int>(static_cast<const uchar*>(start) - starts.data()) : image_.cols;
      };
      for (int u = next(0); u < image_.cols; u = next(u + 1)) {
        const int gu = across[u], sign = gu > 0 ? 1 : -1;
        if (!ground_.has(u, v) || (taken[u] & bit(sign)) != 0 || !isStraightAt(u, v, gu, along[u])) continue;
        follow(u, v, sign, -static_cast<double>(along[u]) / gu, emit);
      }
    }
  }

 private:
  static int bit(int sign) { return sign > 0 ? 1 : 2; }

  /// Whether the gradient keeps direction and strength for several pixels along the edge; that of texture
  /// does not.
  bool isStraightAt(int u, int v, int gu, int gv) const {
    const float slope = -static_cast<float>(gv) / static_cast<float>(gu);
    int missing = 0;
    for (const int rows : {kAlongEdge, -kAlongEdge, 2 * kAlongEdge, -2 * kAlongEdge}) {
      const int x = u + cvRound(slope * static_cast<float>(rows)), y = v + rows;
      bool agrees = x >= 1 && y >= 1 && x + 1 < image_.cols && y + 1 < image_.rows;
      if (agrees) {
        const uchar *a = image_.ptr<uchar>(y - 1) + x, *b = image_.ptr<uchar>(y) + x,
                    *c = image_.ptr<uchar>(y + 1) + x;
        const float hu = static_cast<float>(a[1] + 2 * b[1] + c[1] - a[-1] - 2 * b[-1] - c[-1]);
        const float hv = static_cast<float>(c[-1] + 2 * c[0] + c[1] - a[-1] - 2 * a[0] - a[1]);
        agrees = alikeAlongEdge(static_cast<float>(gu), static_cast<float>(gv), hu, hv);
      }
      if (!agrees && ++missing > 4 - kAlikeAlongEdge) return false;
    }
    return true;
  }

  template <class Emit>
  void follow(int u, int v, int sign, double slope, const Emit& emit) {
    const GrownEdge edge = growEdge(rows_, ground_, {u, v, sign, slope}, {least_, limits_.max_gap});
    const GrowingLine& line = edge.line;
    if (!edge.isShown() || std::abs(line.slope()) > kMaxSlope ||
        (edge.to - edge.from) * std::hypot(1, line.slope()) < limits_.min_length ||
        line.meanSquare() > kMaxScatter * kMaxScatter)
      return;
    take(u, v, sign, line, edge.from, edge.to);
    emit(u + line.at(edge.from), v + edge.from, u + line.at(edge.to), v + edge.to, sign);
  }

  /// Marks this line, so that no scan row starts on it again.
  void take(int u, int v, int sign, const GrowingLine& line, int from, int to) {
    const int first = spacing_ / 2;
    for (int row = std::max(0, (v + from - first + spacing_ - 1) / spacing_); row < taken_.rows; ++row) {
      const int station = first + row * spacing_ - v;
      if (station > to) break;
      const int middle = cvRound(u + line.at(station));
      const int begin = std::max(0, middle - 2), end = std::min(taken_.cols, middle + 3);
      uchar* taken = taken_.ptr<uchar>(row);
      for (int k = begin; k < end; ++k) taken[k] |= static_cast<uchar>(bit(sign));
    }
  }

  const cv::Mat& image_;
  const EdgeMask ground_;
  const EdgeLimits& limits_;
  cv::Mat taken_;
  int spacing_;  // of the scan rows
  int least_;    // Sobel response across an edge, which may lie at 45 degrees
  PixelRows rows_;
};

}  // namespace

std::vector<RoughSegment> SegmentScanner::find(const cv::Mat& image, const cv::Mat& ground,
                                               const EdgeLimits& limits) {
  std::vector<RoughSegment> segments;
  SteepEdges(image, EdgeMask(ground, false), limits, taken_)
      .scan(across_, along_, starts_, [&](double u0, double v0, double u1, double v1, double sign) {
        segments.push_back({{u0, v0}, {u1, v1}, {sign, 0}});
      });
  transposed_ = memory_.image({image.rows, image.cols});
  transpose(image, transposed_);
  SteepEdges(transposed_, EdgeMask(ground, true), limits, taken_)
      .scan(across_, along_, starts_, [&](double v0, double u0, double v1, double u1, double sign) {
        segments.push_back({{u0, v0}, {u1, v1}, {0, sign}});
      });
  return segments;
}

}  // namespace uav_landing
