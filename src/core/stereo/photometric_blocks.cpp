#include "stereo/photometric_blocks.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/lanes.h"
#include "base/median.h"
#include "base/multiversion.h"

namespace uav_landing {
namespace {

constexpr int kWidth = PhotometricBlocks::kWidth, kHeight = PhotometricBlocks::kHeight;
constexpr int kPixels = PhotometricBlocks::kPixels, kMargin = PhotometricBlocks::kMargin;
// Ground nearer the horizon than this disparity (pixels) says nothing about the height.
constexpr double kLeastDisparity = 0.3;
// Sobel's kernel is this many times a derivative.
constexpr float kSobelScale = 8.f;
// Squares of grey levels in a block below which it shows nothing.
constexpr float kLeastEnergy = 0.25f * PhotometricBlocks::kPixels;

// Sum of the squares of a block's derivatives along the row, by Sobel's kernel, less their mean. first: its
// first pixel.
UAV_LANDING_MULTIVERSION int blockEnergy(const uchar* first, std::ptrdiff_t stride) {
  std::array<short, kPixels + 2 * kWidth> differences;  // of neighbours, also of the rows above and below
  std::array<short, kPixels> slopes;    // one after the other: the compiler knows instructions for that
  std::array<short, kWidth> columns{};  // sums of eight of up to 4 * 255
  const uchar* row = first - stride;
  for (int y = 0; y < kHeight + 2; ++y, row += stride)
    for (int x = 0; x < kWidth; ++x)
      differences[y * kWidth + x] = static_cast<short>(row[x + 1] - row[x - 1]);
  for (int i = 0; i < kPixels; ++i)
    slopes[i] =
        static_cast<short>(differences[i] + 2 * differences[i + kWidth] + differences[i + 2 * kWidth]);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) columns[x] = static_cast<short>(columns[x] + slopes[y * kWidth + x]);
  int total = 0, energy = 0;
  for (const short value : columns) total += value;
  for (const short value : slopes) energy += value * value;
  return energy - static_cast<int>(static_cast<int64_t>(total) * total / kPixels);
}

}  // namespace

PhotometricBlocks::PhotometricBlocks(cv::Mat left_mask, cv::Mat right_mask)
    : left_mask_(std::move(left_mask)), right_mask_(std::move(right_mask)) {}

bool PhotometricBlocks::usable(const StereoRig& rig, const ShiftModel& shift, int u, int v) const {
  for (const int y : {v, v + kHeight - 1}) {
    for (const int x : {u, u + kWidth - 1}) {
      const double moved = shift.at(x, y), column = x - moved;
      if (moved - rig.principalOffset() < kLeastDisparity) return false;
      if (column < kMargin || column > right_mask_.cols - 2 - kMargin) return false;
      if (left_mask_.at<uchar>(y, x) == 0 || right_mask_.at<uchar>(y, cvRound(column)) == 0) return false;
    }
  }
  return true;
}

void PhotometricBlocks::findCandidates(const cv::Mat& left, const StereoRig& rig, const ShiftModel& shift) {
  candidates_.clear();
  // The highest row that may be ground, at either side.
  const double limit = kLeastDisparity + rig.principalOffset();
  const auto horizon = [&](double u) { return (limit - shift.c - shift.a * u) / shift.b; };
  const double highest = shift.b > 0 ? std::min(horizon(0), horizon(left.cols - 1)) : 0;
  first_row_ = static_cast<int>(std::clamp<double>(std::ceil(highest), kMargin, left.rows - 1));
  if (left.rows - first_row_ < kHeight + kMargin) return;
  const auto stride = static_cast<std::ptrdiff_t>(left.step);
  for (int v = first_row_; v + kHeight + kMargin <= left.rows; v += kHeight) {
    for (int u = kMargin; u + kWidth + kMargin <= left.cols; u += kWidth) {
      if (!usable(rig, shift, u, v)) continue;
      candidates_.push_back({u, v, blockEnergy(left.ptr<uchar>(v) + u, stride), false});
    }
  }
}

double PhotometricBlocks::usualEnergy() const {
  if (candidates_.empty()) return 0;
  std::vector<double> energies;
  energies.reserve(candidates_.size());
  for (const Candidate& candidate : candidates_) energies.push_back(candidate.energy);
  return medianOf(energies) / (kSobelScale * kSobelScale);
}

// The strongest block of each cell of a coarse grid, so that every part of the ground has a say, and then the
// strongest of all.
void PhotometricBlocks::pick(int count) {
  constexpr int kCell = 4;  // blocks to each side of a cell
  if (static_cast<int>(candidates_.size()) <= count) {
    for (Candidate& candidate : candidates_) candidate.chosen = true;
    return;
  }
  const int columns = left_mask_.cols / (kCell * kWidth) + 1, rows = left_mask_.rows / (kCell * kHeight) + 1;
  std::vector<Candidate*> strongest(static_cast<size_t>(columns) * rows, nullptr), order;
  for (Candidate& candidate : candidates_) {
    const size_t cell = static_cast<size_t>((candidate.v - first_row_) / (kCell * kHeight)) * columns +
                        candidate.u / (kCell * kWidth);
    if (strongest[cell] == nullptr || strongest[cell]->energy < candidate.energy)
      strongest[cell] = &candidate;
    order.push_back(&candidate);
  }
  for (Candidate* candidate : strongest) {
    if (candidate == nullptr) continue;
    candidate->chosen = true;
    --count;
  }
  const auto stronger = [](const Candidate* a, const Candidate* b) { return a->energy > b->energy; };
  const auto end = order.begin() + std::clamp<int>(count, 0, static_cast<int>(order.size()));
  std::nth_element(order.begin(), end, order.end(), stronger);
  std::for_each(order.begin(), end, [](Candidate* candidate) { candidate->chosen = true; });
}

UAV_LANDING_MULTIVERSION bool PhotometricBlocks::makeBlock(const cv::Mat& left, const Candidate& candidate,
                                                           Block& block) {
  constexpr int kAround = 2;  // pixels read to all sides
  block.u = candidate.u;
  block.v = candidate.v;
  std::array<std::array<float, kWidth + kLanes>, kHeight + 2 * kAround> pixels;
  for (int y = 0; y < kHeight + 2 * kAround; ++y) {
    const uchar* row = left.ptr<uchar>(candidate.v + y - kAround) + candidate.u - kAround;
    for (const int x : {0, kLanes, kWidth + 2 * kAround - kLanes}) {
      Lanes greys;
      convert(row + x, greys);
      store(greys, &pixels[y][x]);
    }
  }
  BlockRow grey_sum, slope_sum;
  for (int x = 0; x < kWidth; x += kLanes) {
    const auto difference = [&](int y, Lanes& out) {
      const float* p = &pixels[y + kAround][x + kAround];
      Lanes before, after;
      load(p - 1, before);
      load(p + 1, after);
      out = after - before;
    };
    Lanes greys{}, slopes{}, above, here, below;
    difference(-1, above);
    difference(0, here);
    for (int y = 0; y < kHeight; ++y) {
      difference(y + 1, below);
      const Lanes slope = (above + 2.f * here + below) / kSobelScale;
      store(slope, &block.slope[y * kWidth + x]);
      Lanes grey;
      load(&pixels[y + kAround][x + kAround], grey);
      greys += grey;
      slopes += slope;
      above = here;
      here = below;
    }
    store(greys, &grey_sum[x]);
    store(slopes, &slope_sum[x]);
  }
  const float grey_mean = sumOf(grey_sum) / kPixels, slope_mean = sumOf(slope_sum) / kPixels;
  // Of the columns.
  BlockRow grey_squares, squares, products, downs, down_greys, down_slopes, along_greys, along_slopes;
  for (int x = 0; x < kWidth; x += kLanes) {
    Lanes gg{}, ss{}, gs{}, ss_y{}, dg{}, ds{}, ag{}, as{};
    for (int y = 0; y < kHeight; ++y) {
      // Of fourth order: the difference of two neighbours would see too little of a sharp edge.
      const auto derivative = [&](int dx, int dy, Lanes& out) {
        const float* p = &pixels[y + kAround][x + kAround];
        constexpr int kStride = kWidth + kLanes;
        Lanes before2, before, after, after2;
        load(p - 2 * (dy * kStride + dx), before2);
        load(p - (dy * kStride + dx), before);
        load(p + (dy * kStride + dx), after);
        load(p + 2 * (dy * kStride + dx), after2);
        out = (8.f * (after - before) - (after2 - before2)) / 12.f;
      };
      Lanes down, along, grey, slope;
      derivative(0, 1, down);
      derivative(1, 0, along);
      load(&pixels[y + kAround][x + kAround], grey);
      load(&block.slope[y * kWidth + x], slope);
      grey -= grey_mean;
      slope -= slope_mean;
      store(grey, &block.grey[y * kWidth + x]);
      store(slope, &block.slope[y * kWidth + x]);
      ag += along * grey;
      as += along * slope;
      gg += grey * grey;
      gs += grey * slope;
      ss += slope * slope;
      ss_y += slope * slope * static_cast<float>(y);
      dg += down * grey;
      ds += down * slope;
    }
    store(gg, &grey_squares[x]);
    store(ss, &squares[x]);
    store(gs, &products[x]);
    store(ss_y, &downs[x]);
    store(dg, &down_greys[x]);
    store(ds, &down_slopes[x]);
    store(ag, &along_greys[x]);
    store(as, &along_slopes[x]);
  }
  block.grey_energy = sumOf(grey_squares);
  block.slope_energy = sumOf(squares);
  block.both = sumOf(products);
  block.down_grey = sumOf(down_greys);
  block.down_slope = sumOf(down_slopes);
  block.along_grey = sumOf(along_greys);
  block.along_slope = sumOf(along_slopes);
  float along = 0;
  for (int x = 0; x < kWidth; ++x) along += squares[x] * static_cast<float>(x);
  block.centre_u = static_cast<float>(block.u) + along / block.slope_energy;
  block.centre_v = static_cast<float>(block.v) + sumOf(downs) / block.slope_energy;
  return block.grey_energy > kLeastEnergy && block.slope_energy > 0;
}

void PhotometricBlocks::choose(const cv::Mat& left, const StereoRig& rig, const ShiftModel& shift,
                               int count) {
  findCandidates(left, rig, shift);
  usual_energy_ = usualEnergy();
  pick(count);
  size_t made = 0;  // in the memory of the blocks before
  for (const Candidate& candidate : candidates_) {
    if (!candidate.chosen) continue;
    if (made == blocks_.size()) blocks_.emplace_back();
    if (makeBlock(left, candidate, blocks_[made])) ++made;
  }
  blocks_.resize(made);
}

}  // namespace uav_landing
