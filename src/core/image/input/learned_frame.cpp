#include "image/input/learned_frame.h"

#include <algorithm>
#include <cstdlib>

namespace uav_landing {
namespace {

constexpr double kBetweenLooks = 0.33;  // s
constexpr double kLongestGap = 1.0;     // s between pairs
constexpr int kLooks = 3;               // looks in a row after which a cell belongs to the frame: about a
                                        // second
// Change of grey level from pixel to pixel that makes an edge pixel, and the number of such pixels that a
// cell needs.
constexpr int kLeastSlope = 6, kLeastEdges = 6;
// An edge pixel has stayed when it changes by no more than this part of the slope: half a pixel.
constexpr int kPartOfSlope = 2;
// Grey levels by which the mean of a cell without edges may change.
constexpr int kFlatChange = 2;
// The ground moves when enough cells on it have moved, in the cell's own row and the rows above it. kRows:
// number of these rows. kLeastGround: cells on the ground that they need. kMovingShare: share of these that
// has to move.
constexpr int kRows = 8, kLeastGround = 4;
constexpr double kMovingShare = 0.75;

}  // namespace

LearnedFrame::LearnedFrame(const cv::Size& size) : size_(size), cells_(size / kSize) { reset(); }

void LearnedFrame::reset() {
  all_.assign(static_cast<size_t>(cells_.area()), Cell());
  known_ = false;
  left_out_ = 0;
}

LearnedFrame::Cell* LearnedFrame::at(const cv::Point& pixel) {
  const cv::Point cell = pixel / kSize;
  if (!cv::Rect({}, cells_).contains(cell)) return nullptr;
  return &all_[static_cast<size_t>(cell.y) * cells_.width + cell.x];
}

void LearnedFrame::observe(double stamp, const cv::Mat& image, const std::vector<cv::Point>& tried,
                           const std::vector<cv::Point>& on_ground) {
  if (!(stamp > stamp_ && stamp - stamp_ < kLongestGap)) reset();
  stamp_ = stamp;
  for (const cv::Point& corner : tried)
    if (Cell* cell = at(corner)) cell->tried = true;
  for (const cv::Point& corner : on_ground)
    if (Cell* cell = at(corner)) cell->on_ground = true;
  if (known_ && stamp - looked_ < kBetweenLooks) return;
  looked_ = stamp;
  if (known_) look(image);
  keep(image);
}

void LearnedFrame::look(const cv::Mat& image) {
  compare(image);
  for (int row = 0; row < cells_.height; ++row) count(row);
  findFrame();
}

void LearnedFrame::compare(const cv::Mat& image) {
  for (int i = 0; i < cells_.area(); ++i) {
    const int left = i % cells_.width * kSize, top = i / cells_.width * kSize;
    int edges = 0, staying = 0, sum = 0;
    for (int y = 1; y < kSize - 1; ++y) {
      const uchar *then = all_[i].grey.data() + y * kSize, *now = image.ptr<uchar>(top + y) + left;
      for (int x = 1; x < kSize - 1; ++x) {
        const int change = now[x] - then[x];
        const int across = std::abs(then[x + 1] - then[x - 1]),
                  down = std::abs(then[x + kSize] - then[x - kSize]);
        const int slope = std::max(across, down) / 2;
        sum += change;
        if (slope < kLeastSlope) continue;
        ++edges;
        staying += kPartOfSlope * std::abs(change) <= slope;
      }
    }
    const bool flat = edges < kLeastEdges;
    const bool stays = flat ? std::abs(sum) <= kFlatChange * (kSize - 2) * (kSize - 2) : 2 * staying > edges;
    all_[i].change = !stays ? Change::kMoves : flat ? Change::kFlat : Change::kStays;
  }
}

bool LearnedFrame::groundMoves(int row) const {
  int ground = 0, moving = 0;
  const int first = std::max(0, row - kRows + 1) * cells_.width;
  for (int i = first; i < (row + 1) * cells_.width; ++i) {
    if (!all_[i].on_ground || all_[i].change == Change::kFlat) continue;
    ++ground;
    moving += all_[i].change == Change::kMoves;
  }
  return ground >= kLeastGround && moving >= kMovingShare * ground;
}

void LearnedFrame::count(int row) {
  const bool ground_moves = groundMoves(row);
  for (int i = row * cells_.width; i < (row + 1) * cells_.width; ++i) {
    Cell& cell = all_[i];
    if (cell.own && cell.change != Change::kMoves && !cell.on_ground)
      continue;  // no corner is looked for in it any more
    const bool stays = cell.change == Change::kStays && !cell.on_ground && ground_moves;
    cell.stays = stays ? cell.stays + 1 : 0;
    cell.fails = stays && cell.tried ? cell.fails + 1 : 0;
  }
}

void LearnedFrame::findFrame() {
  std::vector<int> found;
  for (int i = 0; i < cells_.area(); ++i) {
    all_[i].own = all_[i].fails >= kLooks;
    if (all_[i].own) found.push_back(i);
  }
  for (size_t next = 0; next < found.size(); ++next) {
    const int row = found[next] / cells_.width, column = found[next] % cells_.width;
    for (int y = std::max(0, row - 1); y <= std::min(cells_.height - 1, row + 1); ++y)
      for (int x = std::max(0, column - 1); x <= std::min(cells_.width - 1, column + 1); ++x) {
        const int beside = y * cells_.width + x;
        if (all_[beside].own || all_[beside].stays < kLooks) continue;
        all_[beside].own = true;
        found.push_back(beside);
      }
  }
  left_out_ = static_cast<int>(found.size());
}

void LearnedFrame::keep(const cv::Mat& image) {
  for (int i = 0; i < cells_.area(); ++i) {
    Cell& cell = all_[i];
    const int left = i % cells_.width * kSize, top = i / cells_.width * kSize;
    for (int y = 0; y < kSize; ++y) {
      const uchar* row = image.ptr<uchar>(top + y) + left;
      std::copy(row, row + kSize, cell.grey.begin() + y * kSize);
    }
    cell.tried = cell.on_ground = false;
  }
  known_ = true;
}

double LearnedFrame::share() const { return left_out_ * kSize * kSize / static_cast<double>(size_.area()); }

cv::Mat LearnedFrame::leftOut(const cv::Mat& mask, int margin) {
  if (empty()) return mask;
  mask.copyTo(mask_);
  const cv::Rect picture({}, mask.size());
  const int size = kSize + 2 * margin;
  for (int i = 0; i < cells_.area(); ++i) {
    if (!all_[i].own) continue;
    const cv::Point first(i % cells_.width * kSize - margin, i / cells_.width * kSize - margin);
    mask_(cv::Rect(first, cv::Size(size, size)) & picture) = 0;
  }
  return mask_;
}

}  // namespace uav_landing
