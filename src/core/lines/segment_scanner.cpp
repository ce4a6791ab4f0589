#include "lines/segment_scanner.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <opencv2/core/hal/intrin.hpp>

#include "base/multiversion.h"

namespace uav_landing {

namespace {

constexpr double kScansPerLine = 3;  // scan lines that the shortest line along an image axis crosses
constexpr double kSlopePrior = 10;   // stations that the gradient's direction at the start is worth
constexpr double kMaxScatter = 0.6;  // px, RMS of the stations about the line; whole pixels scatter by 0.3
constexpr double kMaxSlope = 1.1;    // px to the side a row; what is flatter belongs to the other axis
constexpr int kFirstLook = 3;        // stations to each side after which texture is mostly told
constexpr int kDense = 8;            // stations to each side after which every other row will do
constexpr double kLeastShare = 0.8;  // of stations that show the edge
constexpr double kLargestResponse = 4 * 255 * 2;  // across and along together

/// Straight line u = u0 + slope v through the stations seen so far, by least squares; v from the start.
class GrowingLine {
 public:
  explicit GrowingLine(double slope) : first_slope_(slope), slope_(slope) {}

  void add(double v, double u) {
    n_ += 1;
    sv_ += v;
    su_ += u;
    svv_ += v * v;
    svu_ += v * u;
    suu_ += u * u;
  }
  /// To what has been added.
  void fit() {
    const double svv = svv_ + kSlopePrior, svu = svu_ + kSlopePrior * first_slope_;
    // One division for both: the next stations wait for it.
    const double determinant = n_ * svv - sv_ * sv_, inverse = 1 / (n_ * determinant);
    slope_ = (n_ * svu - sv_ * su_) * (n_ * inverse);
    offset_ = (su_ - slope_ * sv_) * (determinant * inverse);
  }
  double at(double v) const { return offset_ + slope_ * v; }
  double slope() const { return slope_; }
  double count() const { return n_; }
  double meanSquare() const {
    const double squares = suu_ - 2 * (offset_ * su_ + slope_ * svu_) + n_ * offset_ * offset_ +
                           2 * offset_ * slope_ * sv_ + slope_ * slope_ * svv_;
    return squares / n_;
  }

 private:
  double n_ = 0, sv_ = 0, su_ = 0, svv_ = 0, svu_ = 0, suu_ = 0;
  double first_slope_, slope_, offset_ = 0;
};

/// 3x3 Sobel responses of the middle one of three rows.
UAV_LANDING_MULTIVERSION void sobel(const uchar* __restrict a, const uchar* __restrict b,
                                    const uchar* __restrict c, int columns, short* __restrict across,
                                    short* __restrict along) {
  for (int u = 1; u < columns - 1; ++u) {
    const int left = a[u - 1] + 2 * b[u - 1] + c[u - 1], right = a[u + 1] + 2 * b[u + 1] + c[u + 1];
    const int above = a[u - 1] + 2 * a[u] + a[u + 1], below = c[u - 1] + 2 * c[u] + c[u + 1];
    across[u] = static_cast<short>(right - left);
    along[u] = static_cast<short>(below - above);
  }
}

/// 1 where the response across the row is a maximum of at least this strength in all, and not less than that
/// along the row; at 2 .. columns - 3.
UAV_LANDING_MULTIVERSION void markStarts(const short* __restrict across, const short* __restrict along,
                                         int columns, short least, uchar* __restrict starts) {
  const auto size = [](short s) { return static_cast<short>(s < 0 ? -s : s); };
  for (int u = 2; u < columns - 2; ++u) {
    const short here = size(across[u]), side = size(along[u]);
    const short before = size(across[u - 1]), after = size(across[u + 1]);
    const bool strong = static_cast<short>(here + side) >= least && here >= side;
    starts[u] = static_cast<uchar>(strong && before < here && after <= here);
  }
}

/// The image's columns as rows, 16 x 16 pixels at a time: interleaving the upper half of the rows with the
/// lower one four times turns rows into columns.
UAV_LANDING_MULTIVERSION void transpose(const cv::Mat& image, cv::Mat& transposed) {
  constexpr int kBlock = 16;
  const int rows = image.rows - image.rows % kBlock, columns = image.cols - image.cols % kBlock;
  const size_t step = image.step, transposed_step = transposed.step;
  for (int v = 0; v < rows; v += kBlock)
    for (int u = 0; u < columns; u += kBlock) {
      cv::v_uint8x16 block[kBlock], mixed[kBlock];
      const uchar* from = image.ptr<uchar>(v) + u;
      for (int i = 0; i < kBlock; ++i, from += step) block[i] = cv::v_load(from);
      for (int round = 0; round < 2; ++round) {
        for (int i = 0; i < kBlock / 2; ++i)
          cv::v_zip(block[i], block[i + kBlock / 2], mixed[2 * i], mixed[2 * i + 1]);
        for (int i = 0; i < kBlock / 2; ++i)
          cv::v_zip(mixed[i], mixed[i + kBlock / 2], block[2 * i], block[2 * i + 1]);
      }
      uchar* to = transposed.ptr<uchar>(u) + v;
      for (int i = 0; i < kBlock; ++i, to += transposed_step) cv::v_store(to, block[i]);
    }
  for (int v = 0; v < image.rows; ++v)
    for (int u = v < rows ? columns : 0; u < image.cols; ++u)
      transposed.at<uchar>(u, v) = image.at<uchar>(v, u);
}

/// Where edges may be, in an image or in a transposed one.
class Ground {
 public:
  Ground(const cv::Mat& mask, bool transposed)
      : mask_(mask.ptr<uchar>()),
        along_row_(transposed ? static_cast<std::ptrdiff_t>(mask.step) : 1),
        to_next_row_(transposed ? 1 : static_cast<std::ptrdiff_t>(mask.step)) {}

  bool has(int u, int v) const { return mask_[u * along_row_ + v * to_next_row_] != 0; }

 private:
  const uchar* mask_;
  std::ptrdiff_t along_row_, to_next_row_;
};

/// Steep edges (nearer to the rows' normal than to the rows) of one image.
class SteepEdges {
 public:
  SteepEdges(const cv::Mat& image, const Ground& ground, const EdgeLimits& limits, ImageMemory& taken)
      : image_(image),
        ground_(ground),
        limits_(limits),
        spacing_(std::max(1, static_cast<int>(limits.min_length * M_SQRT1_2 / kScansPerLine))),
        least_(static_cast<int>(std::ceil(limits.low / 2))) {
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
      sobel(image_.ptr<uchar>(v - 1), image_.ptr<uchar>(v), image_.ptr<uchar>(v + 1), image_.cols,
            across.data(), along.data());
      markStarts(across.data(), along.data(), image_.cols, least, starts.data());
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

  /// Whether the gradient keeps direction and strength for several pixels along the edge; texture does not.
  bool isStraightAt(int u, int v, int gu, int gv) const {
    constexpr int kStep = 3, kNeeded = 3;                     // rows; of two places to each side
    constexpr float kMinCos2 = 0.82F, kMinStrength2 = 0.16F;  // within 25 degrees; 40 %
    const float slope = -static_cast<float>(gv) / static_cast<float>(gu);
    const float g2 = static_cast<float>(gu * gu + gv * gv);
    int missing = 0;
    for (const int rows : {kStep, -kStep, 2 * kStep, -2 * kStep}) {
      const int x = u + cvRound(slope * static_cast<float>(rows)), y = v + rows;
      bool agrees = x >= 1 && y >= 1 && x + 1 < image_.cols && y + 1 < image_.rows;
      if (agrees) {
        const uchar *a = image_.ptr<uchar>(y - 1) + x, *b = image_.ptr<uchar>(y) + x,
                    *c = image_.ptr<uchar>(y + 1) + x;
        const float hu = static_cast<float>(a[1] + 2 * b[1] + c[1] - a[-1] - 2 * b[-1] - c[-1]);
        const float hv = static_cast<float>(c[-1] + 2 * c[0] + c[1] - a[-1] - 2 * a[0] - a[1]);
        const float h2 = hu * hu + hv * hv,
                    product = hu * static_cast<float>(gu) + hv * static_cast<float>(gv);
        agrees = product > 0 && product * product >= kMinCos2 * g2 * h2 && h2 >= kMinStrength2 * g2;
      }
      if (!agrees && ++missing > 4 - kNeeded) return false;
    }
    return true;
  }

  /// Column of the strongest brightness step of this sign within a pixel of the expected place, or -1.
  int edgeAt(int v, double expected, int sign) const {
    constexpr int kLeft = 3, kRight = 4;  // pixels that are loaded with the middle one
    const int middle = static_cast<int>(expected + 0.5);
    if (!(expected >= kLeft) || middle + kRight >= image_.cols || v < 1 || v + 1 >= image_.rows) return -1;
    const uchar* row = image_.ptr<uchar>(v) + middle - kLeft;
    const std::ptrdiff_t stride = static_cast<std::ptrdiff_t>(image_.step);
    const cv::v_uint16x8 here = cv::v_load_expand(row);
    const cv::v_int16x8 sums = cv::v_reinterpret_as_s16(here + here + cv::v_load_expand(row - stride) +
                                                        cv::v_load_expand(row + stride));
    const cv::v_int16x8 steps = cv::v_rotate_right<2>(sums) - sums;  // i: across pixel middle - 2 + i
    // Of steps that are as strong the one in the middle, then the one before: that is in the lowest bits, of
    // which the lower two are the place from middle - 1.
    constexpr short kBase = 8, kPlace = 3, kBefore = 4 + 0, kMiddle = 4 + 1, kAfter = 2;
    const cv::v_int16x8 coded = cv::v_mul_wrap(steps, cv::v_setall_s16(static_cast<short>(kBase * sign))) +
                                cv::v_int16x8(0, kBefore, kMiddle, kAfter, 0, 0, 0, 0);
    const int strongest = cv::v_extract_n<1>(
        cv::v_max(coded, cv::v_max(cv::v_rotate_right<1>(coded), cv::v_rotate_right<2>(coded))));
    if (strongest < kBase * least_) return -1;
    const int best = middle - 1 + (strongest & kPlace);
    return ground_.has(best, v) ? best : -1;
  }

  template <class Emit>
  void follow(int u, int v, int sign, double slope, const Emit& emit) {
    GrowingLine line(slope);
    line.add(0, 0);
    line.fit();
    struct Side {
      int step, end = 0, misses = 0;
      bool open = true;
    } sides[] = {{1}, {-1}};
    int looked = 1;
    for (int distance = 1, skip = 1; sides[0].open || sides[1].open; distance += skip) {
      if (distance > kDense) skip = 2;
      for (Side& side : sides) {
        if (!side.open) continue;
        const int station = side.step * distance;
        ++looked;
        const double expected = u + line.at(station);
        const int found = edgeAt(v + station, expected, sign);
        if (found >= 0 && std::abs(found - expected) < 1.25) {
          line.add(station, found - u);
          side.end = station;
          side.misses = 0;
        } else if (++side.misses * skip > limits_.max_gap) {
          side.open = false;
          looked -= side.misses;
        }
      }
      line.fit();
      if (distance == kFirstLook && line.count() < kLeastShare * looked) return;
    }
    const double length = (sides[0].end - sides[1].end) * std::hypot(1, line.slope());
    if (length < limits_.min_length || std::abs(line.slope()) > kMaxSlope ||
        line.count() < kLeastShare * looked || line.meanSquare() > kMaxScatter * kMaxScatter)
      return;
    take(u, v, sign, line, sides[1].end, sides[0].end);
    emit(u + line.at(sides[1].end), v + sides[1].end, u + line.at(sides[0].end), v + sides[0].end, sign);
  }

  /// Keeps the scan rows from starting on this line again.
  void take(int u, int v, int sign, const GrowingLine& line, int from, int to) {
    const int first = spacing_ / 2;
    for (int row = std::max(0, (v + from - first + spacing_ - 1) / spacing_); row < taken_.rows; ++row) {
      const int station = first + row * spacing_ - v;
      if (station > to) break;
      const int middle = cvRound(u + line.at(station));
      uchar* taken = taken_.ptr<uchar>(row);
      for (int k = std::max(0, middle - 2); k <= std::min(taken_.cols - 1, middle + 2); ++k)
        taken[k] |= static_cast<uchar>(bit(sign));
    }
  }

  const cv::Mat& image_;
  const Ground ground_;
  const EdgeLimits& limits_;
  cv::Mat taken_;
  int spacing_;  // of the scan rows
  int least_;    // Sobel response across an edge: it may lie at 45 degrees
};

}  // namespace

std::vector<RoughSegment> SegmentScanner::find(const cv::Mat& image, const cv::Mat& ground,
                                               const EdgeLimits& limits) {
  std::vector<RoughSegment> segments;
  SteepEdges(image, Ground(ground, false), limits, taken_)
      .scan(across_, along_, starts_, [&](double u0, double v0, double u1, double v1, double sign) {
        segments.push_back({{u0, v0}, {u1, v1}, {sign, 0}});
      });
  transposed_ = memory_.image({image.rows, image.cols});
  transpose(image, transposed_);
  SteepEdges(transposed_, Ground(ground, true), limits, taken_)
      .scan(across_, along_, starts_, [&](double v0, double u0, double v1, double u1, double sign) {
        segments.push_back({{u0, v0}, {u1, v1}, {0, sign}});
      });
  return segments;
}

}  // namespace uav_landing
