#include "image/windows/corners.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <opencv2/core.hpp>
#include <vector>

#include "image/input/mask_bounds.h"
#include "kernels/image/harris_rows.h"

namespace uav_landing {
namespace {

using Candidate = CornerCandidate;

/// The local maxima of an image, by rows.
struct Maxima {
  std::vector<Candidate>& memory;  // the first count entries are used
  size_t count = 0;
  float strongest = 0;

  /// Adds those of the marked pixels of a row that are allowed and have a response above 0. All are written
  /// and the end tells which ones stay, because the processor cannot predict that branch.
  void addRow(const std::uint64_t* marks, const uchar* allowed, const float* responses, int columns,
              int row) {
    if (memory.size() < count + columns) memory.resize(2 * (count + columns));
    Candidate* end = &memory[count];
    float largest = strongest;
    for (int begin = 0; begin < columns; begin += HarrisRows::kBlock) {
      for (std::uint64_t bits = *marks++; bits != 0; bits &= bits - 1) {
        const int u = begin + __builtin_ctzll(bits);
        const float response = allowed[u] != 0 ? responses[u] : 0;
        *end = {response, static_cast<short>(u), static_cast<short>(row)};
        end += response > 0 ? 1 : 0;
        largest = std::max(largest, response);
      }
    }
    count = end - memory.data();
    strongest = largest;
  }
};

/// Maxima of the Harris response inside the mask.
Maxima findMaxima(const cv::Mat& image, const cv::Mat& mask, double harris_k,
                  std::vector<Candidate>& memory) {
  HarrisRows harris(image, harris_k);
  Maxima maxima{memory};
  for (int v = 2; v + 2 < image.rows; ++v) {
    harris.compute(v);
    if (v >= 4)
      maxima.addRow(harris.maxima(v - 1), mask.ptr<uchar>(v - 1), harris.response(v - 1), image.cols, v - 1);
  }
  return maxima;
}

/// Candidates of at least a minimum response, in classes of nearly equal responses, the strongest first. The
/// bits of positive numbers have the same order as the numbers.
class Classes {
 public:
  static constexpr int kCount = 2048;

  /// memory: to work in.
  Classes(const Maxima& maxima, float least, std::vector<Candidate>& memory)
      : strongest_(bitsOf(maxima.strongest)), least_(least) {
    if (memory.size() < maxima.count) memory.resize(maxima.memory.size());
    candidates_ = memory.data();
    const Candidate *first = maxima.memory.data(), *last = first + maxima.count;
    for (const Candidate* candidate = first; candidate < last; ++candidate) ++ends_[classOf(*candidate) + 1];
    for (int i = 0; i <= kCount; ++i) ends_[i + 1] += ends_[i];
    for (const Candidate* candidate = first; candidate < last; ++candidate)
      candidates_[ends_[classOf(*candidate)]++] = *candidate;
  }

  Candidate* begin(int i) const { return candidates_ + (i == 0 ? 0 : ends_[i - 1]); }
  Candidate* end(int i) const { return candidates_ + ends_[i]; }

 private:
  static std::uint32_t bitsOf(float response) {
    std::uint32_t bits;
    std::memcpy(&bits, &response, sizeof(bits));
    return bits;
  }
  /// 64 classes for each halving of the response; the last class has those that are too weak.
  int classOf(const Candidate& candidate) const {
    constexpr std::uint32_t kLast = kCount - 1;
    const std::uint32_t number = (strongest_ - bitsOf(candidate.response)) >> 17;
    return static_cast<int>(candidate.response < least_ ? kCount : std::min(number, kLast));
  }

  std::uint32_t strongest_;
  float least_;
  Candidate* candidates_;
  std::array<int, kCount + 2> ends_{};
};

/// Accepts corners: not too many in a square cell, and none near another.
class Cells {
 public:
  static constexpr int kMost = 4;  // corners in a cell

  Cells(const cv::Size& area, double cell, double min_distance)
      : reach_(static_cast<int>(std::ceil(min_distance)) - 1),
        stride_((area.width + 2 * reach_) / 8 + static_cast<int>(sizeof(std::uint64_t))),
        taken_(static_cast<size_t>(stride_) * (area.height + 2 * reach_)) {
    for (int x = 0; x < area.width; ++x) columns_.push_back(static_cast<int>(x / cell));
    const int across = columns_.back() + 1;
    for (int y = 0; y < area.height; ++y) rows_.push_back(across * static_cast<int>(y / cell));
    counts_.resize(rows_.back() + across);
    drawNear(min_distance * min_distance);
  }

  /// Keeps the candidates whose cell has room and that are not too near a corner, and returns their end. All
  /// are written, because the processor cannot predict which ones stay.
  Candidate* keepFree(Candidate* begin, Candidate* end) const {
    const int *columns = columns_.data(), *rows = rows_.data();
    const uchar *counts = counts_.data(), *taken = taken_.data() + static_cast<size_t>(reach_) * stride_;
    const std::ptrdiff_t stride = stride_;
    const unsigned reach = reach_;
    Candidate* kept = begin;
    for (const Candidate* candidate = begin; candidate < end; ++candidate) {
      const int x = candidate->x, y = candidate->y;
      const unsigned place = x + reach;
      const bool has_room = counts[rows[y] + columns[x]] < kMost;
      *kept = *candidate;
      const int is_taken = taken[y * stride + place / 8] >> place % 8 & 1;
      kept += has_room ? 1 - is_taken : 0;
    }
    return kept;
  }

  /// Accepts a candidate that is free, and returns how many corners its cell had before.
  int add(const Candidate& candidate) {
    const int size = 2 * reach_ + 1, shift = candidate.x % 8;
    const std::uint64_t* near = near_.data();
    for (int x = 0; x < size; x += kTogether, near += size) {
      uchar* place = &taken_[static_cast<size_t>(candidate.y) * stride_ + (candidate.x + x) / 8];
      for (int row = 0; row < size; ++row, place += stride_) {
        std::uint64_t bits;
        std::memcpy(&bits, place, sizeof(bits));
        bits |= near[row] << shift;
        std::memcpy(place, &bits, sizeof(bits));
      }
    }
    return counts_[rows_[candidate.y] + columns_[candidate.x]]++;
  }

 private:
  // Pixels that are marked at once: those of a word, without those by which the first one may lie behind the
  // start of a byte.
  static constexpr int kTogether = 56;

  void drawNear(double squared_distance) {
    for (int first = -reach_; first <= reach_; first += kTogether)
      for (int y = -reach_; y <= reach_; ++y) {
        std::uint64_t bits = 0;
        for (int x = 0; x < kTogether && first + x <= reach_; ++x)
          if ((first + x) * (first + x) + y * y < squared_distance) bits |= std::uint64_t(1) << x;
        near_.push_back(bits);
      }
  }

  int reach_, stride_;
  std::vector<int> columns_, rows_;  // cell of a pixel's column and row; rows: the first cell of that row
  std::vector<uchar> counts_;        // corners of each cell
  std::vector<std::uint64_t> near_;  // marks of places too near a corner, words below each other
  std::vector<uchar> taken_;         // one bit per pixel: too near a corner; with margins
};

/// Accepts the free candidates of a class, strongest first, equal ones by rows. Each is added to the list of
/// its rank, which is the number of corners that its cell had before.
void accept(Candidate* begin, Candidate* end, Cells& cells,
            std::array<std::vector<Candidate>, Cells::kMost>& ranked) {
  // Most are not free already. Finding that out is quicker than sorting them.
  end = cells.keepFree(begin, end);
  std::sort(begin, end, [](const Candidate& a, const Candidate& b) {
    if (a.response != b.response) return a.response > b.response;
    return a.y != b.y ? a.y < b.y : a.x < b.x;
  });
  for (Candidate* candidate = begin; candidate < end; ++candidate)
    if (cells.keepFree(candidate, candidate + 1) != candidate)
      ranked[cells.add(*candidate)].push_back(*candidate);
}

}  // namespace

std::vector<cv::Point> findCorners(const cv::Mat& image, const cv::Mat& mask, const CornerOptions& options,
                                   CornerMemory& memory) {
  const cv::Rect area = boundsOf(mask);
  if (area.width < 7 || area.height < 7) return {};
  const Maxima maxima = findMaxima(image(area), mask(area), options.harris_k, memory.maxima);
  const Classes classes(maxima, static_cast<float>(options.quality) * maxima.strongest, memory.sorted);

  // Sorted by the rank within cells first, so that strong markings do not take all corners, then by strength.
  Cells cells(area.size(), std::max(options.min_distance, std::sqrt(double(area.area()) / options.count)),
              options.min_distance);
  std::array<std::vector<Candidate>, Cells::kMost> ranked;
  for (int i = 0; i < Classes::kCount; ++i) accept(classes.begin(i), classes.end(i), cells, ranked);
  std::vector<cv::Point> corners;
  for (const std::vector<Candidate>& rank : ranked)
    for (const Candidate& corner : rank) corners.push_back(cv::Point(corner.x, corner.y) + area.tl());
  if (corners.size() > static_cast<size_t>(options.count)) corners.resize(options.count);
  std::sort(corners.begin(), corners.end(),
            [](const cv::Point& a, const cv::Point& b) { return a.y != b.y ? a.y < b.y : a.x < b.x; });
  return corners;
}

std::vector<cv::Point> findCorners(const cv::Mat& image, const cv::Mat& mask, const CornerOptions& options) {
  CornerMemory memory;
  return findCorners(image, mask, options, memory);
}

int cornerBudget(const cv::Size& image, int most, int pixels_per_corner) {
  constexpr int kFewest = 20;  // as for the parameter of the number of corners
  return std::min(most, std::max(kFewest, image.area() / pixels_per_corner));
}

}  // namespace uav_landing
