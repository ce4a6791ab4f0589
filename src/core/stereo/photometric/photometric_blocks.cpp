#include "stereo/photometric/photometric_blocks.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "estimation/robust.h"
#include "kernels/lanes/lanes.h"
#include "kernels/lanes/multiversion.h"

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

// The grey levels of a block with two more pixels to all sides.
class Surroundings {
 public:
  [[gnu::always_inline]] inline void read(const cv::Mat& left, int u, int v) {
    for (int y = 0; y < kRows; ++y) {
      const uchar* row = left.ptr<uchar>(v + y - kAround) + u - kAround;
      for (const int x : {0, kLanes, kWidth + 2 * kAround - kLanes}) {
        Lanes greys;
        convert(row + x, greys);
        store(greys, &pixels_[y][x]);
      }
    }
  }

  // Of the block's pixels from (x, y) on.
  [[gnu::always_inline]] inline void greys(int x, int y, Lanes& out) const { load(at(x, y), out); }

  // The difference of the pixels to the right and to the left.
  [[gnu::always_inline]] inline void difference(int x, int y, Lanes& out) const {
    Lanes before, after;
    load(at(x - 1, y), before);
    load(at(x + 1, y), after);
    out = after - before;
  }

  // Of fourth order: the difference of two neighbours would see too little of a sharp edge.
  [[gnu::always_inline]] inline void derivative(int x, int y, int dx, int dy, Lanes& out) const {
    Lanes before2, before, after, after2;
    const float* place = at(x, y);
    const std::ptrdiff_t step = dy * kStride + dx;
    load(place - 2 * step, before2);
    load(place - step, before);
    load(place + step, after);
    load(place + 2 * step, after2);
    out = (8.f * (after - before) - (after2 - before2)) / 12.f;
  }

 private:
  static constexpr int kAround = 2, kRows = kHeight + 2 * kAround, kStride = kWidth + kLanes;
  [[gnu::always_inline]] inline const float* at(int x, int y) const {
    return &pixels_[y + kAround][x + kAround];
  }
  std::array<std::array<float, kStride>, kRows> pixels_;
};

// Derivatives of a block along the row, by Sobel's kernel, and the sums over the columns of these and of the
// grey levels.
[[gnu::always_inline]] inline void findSlopes(const Surroundings& pixels, float* slopes, BlockRow& grey_sum,
                                              BlockRow& slope_sum) {
  for (int x = 0; x < kWidth; x += kLanes) {
    Lanes total_grey{}, total{}, above, here, below, grey;
    pixels.difference(x, -1, above);
    pixels.difference(x, 0, here);
    for (int y = 0; y < kHeight; ++y) {
      pixels.difference(x, y + 1, below);
      pixels.greys(x, y, grey);
      const Lanes slope = (above + 2.f * here + below) / kSobelScale;
      store(slope, &slopes[y * kWidth + x]);
      total_grey += grey;
      total += slope;
      above = here;
      here = below;
    }
    store(total_grey, &grey_sum[x]);
    store(total, &slope_sum[x]);
  }
}

}  // namespace

PhotometricBlocks::PhotometricBlocks(cv::Mat left_mask, cv::Mat right_mask)
    : left_mask_(std::move(left_mask)), right_mask_(std::move(right_mask)) {}

bool PhotometricBlocks::usable(const StereoRig& rig, const ShiftModel& shift, int u, int v) const {
  for (const int y : {v, v + kHeight - 1}) {
    for (const int x : {u, u + kWidth - 1}) {
      const double moved = shift.at(x, y), column = x - moved;
      if (!(moved - rig.principalOffset() >= kLeastDisparity)) return false;
      if (!(column >= kMargin && column <= right_mask_.cols - 2 - kMargin)) return false;
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
  block.u = candidate.u;
  block.v = candidate.v;
  Surroundings pixels;
  pixels.read(left, block.u, block.v);
  BlockRow grey_sum, slope_sum;
  findSlopes(pixels, block.slope.data(), grey_sum, slope_sum);
  const float grey_mean = sumOf(grey_sum) / kPixels, slope_mean = sumOf(slope_sum) / kPixels;
  // Of the columns.
  BlockRow grey_squares, squares, products, downs, down_greys, down_slopes, along_greys, along_slopes;
  for (int x = 0; x < kWidth; x += kLanes) {
    Lanes gg{}, ss{}, gs{}, ss_y{}, dg{}, ds{}, ag{}, as{};
    for (int y = 0; y < kHeight; ++y) {
      Lanes down, along, grey, slope;
      pixels.derivative(x, y, 0, 1, down);
      pixels.derivative(x, y, 1, 0, along);
      pixels.greys(x, y, grey);
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
