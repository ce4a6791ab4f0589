#include "uav_landing/image/corners.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <opencv2/core.hpp>
#include <optional>

#include "image/harris_rows.h"
#include "image/mask_bounds.h"

namespace uav_landing {
namespace {

struct Candidate {
  float response;  // > 0
  short x, y;
};

/// Appends the marked pixels of a row and returns the end. There must be room for all of the row: two of each
/// block are written, and only the end tells which ones stay, as how many there are a processor cannot guess.
Candidate* addMarked(const uchar* marks, const float* responses, int columns, int row, Candidate* end) {
  static_assert(HarrisRows::kBlock == sizeof(std::uint64_t), "a block's marks are looked at as one number");
  constexpr std::uint64_t kOnes = 0x0101010101010101, kLast = std::uint64_t(1) << 63;
  for (int begin = 0; begin < columns; begin += HarrisRows::kBlock) {
    std::uint64_t bits;
    std::memcpy(&bits, marks + begin, sizeof(bits));
    if (bits == 0) continue;
    const auto put = [&](Candidate* place) {
      const int u = begin + __builtin_ctzll(bits | kLast) / 8;
      *place = {responses[u], static_cast<short>(u), static_cast<short>(row)};
      bits &= bits - 1;
    };
    Candidate* const stop = end + (bits * kOnes >> 56);
    put(end++);
    put(end++);
    while (end < stop) put(end++);
    end = stop;
  }
  return end;
}

/// Local maxima of the Harris response inside the mask, by rows, with a response of at least quality times
/// the strongest one.
void findMaxima(const cv::Mat& image, const cv::Mat& mask, double quality, double harris_k,
                std::vector<Candidate>& maxima) {
  HarrisRows harris(image, harris_k);
  size_t count = 0;
  for (int v = 2; v + 2 < image.rows; ++v) {
    harris.compute(v);
    if (v < 4) continue;
    if (maxima.size() < count + image.cols) maxima.resize(2 * (count + image.cols));
    const uchar* marks = harris.maxima(v - 1, mask.ptr<uchar>(v - 1));
    count = addMarked(marks, harris.response(v - 1), image.cols, v - 1, &maxima[count]) - maxima.data();
  }
  maxima.resize(count);
  float strongest = 0;
  for (const Candidate& candidate : maxima) strongest = std::max(strongest, candidate.response);
  const float threshold = static_cast<float>(quality) * strongest;
  maxima.erase(std::remove_if(maxima.begin(), maxima.end(),
                              [threshold](const Candidate& c) { return c.response < threshold; }),
               maxima.end());
}

/// Strongest first, equals as they come: digit by digit of the response's bits, which are in the order of
/// positive numbers. sorted: memory to work in.
void sortByResponse(std::vector<Candidate>& candidates, std::vector<Candidate>& sorted) {
  constexpr int kBits = 11, kDigits = 1 << kBits;
  sorted.resize(candidates.size());
  const auto digit = [](const Candidate& candidate, int shift) {
    std::uint32_t bits;
    std::memcpy(&bits, &candidate.response, sizeof(bits));
    return kDigits - 1 - static_cast<int>((bits >> shift) & (kDigits - 1));
  };
  for (int shift = 0; shift < 32; shift += kBits) {
    std::array<int, kDigits + 1> begin{};
    for (const Candidate& candidate : candidates) ++begin[digit(candidate, shift) + 1];
    for (int i = 0; i < kDigits; ++i) begin[i + 1] += begin[i];
    for (const Candidate& candidate : candidates) sorted[begin[digit(candidate, shift)]++] = candidate;
    candidates.swap(sorted);
  }
}

/// The corners accepted so far, in square cells.
class Cells {
 public:
  static constexpr int kMost = 4;  // corners in a cell

  Cells(const cv::Size& area, double cell, double min_distance)
      : min_squared_(min_distance * min_distance), reach_(static_cast<int>(std::ceil(min_distance))) {
    columns_.reserve(area.width);
    rows_.reserve(area.height);
    for (int x = 0; x < area.width; ++x) columns_.push_back(static_cast<int>(x / cell));
    for (int y = 0; y < area.height; ++y) rows_.push_back(static_cast<int>(y / cell));
    cells_.resize(static_cast<size_t>(columns_.back() + 1) * (rows_.back() + 1));
  }

  /// How many stronger ones the cell of a corner has, which is added to it; nothing when it is full, or when
  /// there is a stronger corner nearer than the least distance.
  std::optional<int> add(const cv::Point& point) {
    Cell& own = at(columns_[point.x], rows_[point.y]);
    if (own.count == kMost || !isFree(point)) return std::nullopt;
    own.corners[own.count] = point;
    return own.count++;
  }

 private:
  struct Cell {
    int count = 0;
    std::array<cv::Point, kMost> corners;
  };

  Cell& at(int column, int row) { return cells_[static_cast<size_t>(row) * (columns_.back() + 1) + column]; }

  bool isFree(const cv::Point& point) {
    const auto last = [&](const std::vector<int>& cell_of, int place) {
      return cell_of[std::min(place + reach_, static_cast<int>(cell_of.size()) - 1)];
    };
    for (int y = rows_[std::max(point.y - reach_, 0)]; y <= last(rows_, point.y); ++y)
      for (int x = columns_[std::max(point.x - reach_, 0)]; x <= last(columns_, point.x); ++x) {
        const Cell& cell = at(x, y);
        for (int i = 0; i < cell.count; ++i) {
          const cv::Point step = cell.corners[i] - point;
          if (step.dot(step) < min_squared_) return false;
        }
      }
    return true;
  }

  double min_squared_;
  int reach_;
  std::vector<int> columns_, rows_;  // of cells, of a pixel
  std::vector<Cell> cells_;
};

}  // namespace

std::vector<cv::Point> findCorners(const cv::Mat& image, const cv::Mat& mask, int count, double quality,
                                   double min_distance, double harris_k) {
  const cv::Rect area = boundsOf(mask);
  if (area.width < 7 || area.height < 7) return {};
  static thread_local std::vector<Candidate> maxima, memory;  // kept, as there are many
  findMaxima(image(area), mask(area), quality, harris_k, maxima);
  sortByResponse(maxima, memory);

  // Rank within cells first, so that strong markings do not take all corners, then by strength.
  Cells cells(area.size(), std::max(min_distance, std::sqrt(double(area.area()) / count)), min_distance);
  std::array<std::vector<cv::Point>, Cells::kMost> ranked;
  for (const Candidate& candidate : maxima) {
    const cv::Point point(candidate.x, candidate.y);
    if (const std::optional<int> rank = cells.add(point)) ranked[*rank].push_back(point + area.tl());
  }
  std::vector<cv::Point> corners;
  for (const std::vector<cv::Point>& rank : ranked) corners.insert(corners.end(), rank.begin(), rank.end());
  if (corners.size() > static_cast<size_t>(count)) corners.resize(count);
  std::sort(corners.begin(), corners.end(),
            [](const cv::Point& a, const cv::Point& b) { return a.y != b.y ? a.y < b.y : a.x < b.x; });
  return corners;
}

int cornerBudget(const cv::Size& image, int most, int pixels_per_corner) {
  constexpr int kFewest = 20;  // as of the parameters for their count
  return std::min(most, std::max(kFewest, image.area() / pixels_per_corner));
}

}  // namespace uav_landing
