#include "stereo/photometric_blocks.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "base/lanes.h"
#include "base/median.h"
#include "base/multiversion.h"

namespace uav_landing {
namespace {

constexpr int kWidth = PhotometricBlocks::kWidth, kHeight = PhotometricBlocks::kHeight;
constexpr int kPixels = PhotometricBlocks::kPixels;
// Pixels to the left and right that interpolation and derivatives read.
constexpr int kMargin = 2;
// Ground nearer the horizon than this disparity (pixels) says nothing about the height.
constexpr double kLeastDisparity = 0.3;
// Sobel's kernel is this many times a derivative; the sum of its squares over that squared.
constexpr float kSobelScale = 8.f;
constexpr double kSlopeNoise = 0.1875;
// Squares of grey levels in a block below which it shows nothing.
constexpr float kLeastEnergy = 0.25f * PhotometricBlocks::kPixels;
// Variance of the noise in the right image after interpolation over that before (0.64 of it is left half-way
// between two pixels).
constexpr double kInterpolated = 0.8;
// The variance that a block of nothing but noise may show, over the lower quartile: three sigma of
// chi-square.
constexpr double kNoiseScatter = 1.45;
// Squared correlation, noise taken off, below which a block does not show what the other image has there.
constexpr double kLeastCorrelation = 0.75;
// Shares of a block's grey levels and derivatives that must be more than noise.
constexpr double kLeastShareOfGrey = 0.25, kLeastShareOfSlope = 0.1;
// Least gain of the right image over the left one.
constexpr double kLeastGain = 0.2;
// Variance of rounding to whole grey levels in two images.
constexpr double kLeastVariance = 1.0 / 6.0;

// The lower quartile of the variances that blocks of noise show, over their mean (chi-square).
constexpr double kQuartile = 0.915;
// Sum of the products of Sobel's kernel, as a derivative, and the one of fourth order; variance per pixel of
// the products of what they make of noise with a variance of 1, summed over a block.
constexpr double kProductNoise = 1.0 / 3, kProductScatter = 0.505;
// Of the usual signal over the noise: less cannot be told from none.
constexpr double kLeastUsual = 0.05;

// What of a signal measured with normal errors was there: the mean by Bayes' rule. A signal is positive, and
// strong ones are rare but not unheard of (density 1 / (usual + signal)^2, its logarithm taken as linear near
// what was measured). Among many blocks with next to nothing to see, noise makes some look as if they had;
// believed, they would be weighted, and claim to know, as much as that.
double signalBehind(double measured, double stddev, double usual) {
  constexpr double kCertain = 6;
  const double most_likely = measured - 2 * stddev * stddev / (usual + std::max(measured, 0.0));
  const double z = most_likely / stddev;
  if (z > kCertain) return most_likely;
  if (z < -kCertain) return -stddev / z;
  const double density = std::exp(-0.5 * z * z) / std::sqrt(2 * M_PI);
  return most_likely + stddev * density / (0.5 * std::erfc(-z / std::sqrt(2.0)));
}

double lowerQuartileOf(const std::vector<double>& values) {
  return orderStatistic(values.data(), values.size(), values.size() / 4);
}

bool set(const cv::Mat& mask, double u, double v) {
  const int x = cvRound(u), y = cvRound(v);
  return x >= 0 && y >= 0 && x < mask.cols && y < mask.rows && mask.at<uchar>(y, x) != 0;
}

// Sum of the squares of a block of derivatives less their mean.
UAV_LANDING_MULTIVERSION int blockEnergy(const short* first, size_t stride) {
  using Row = short __attribute__((vector_size(kWidth * sizeof(short))));
  alignas(Row) std::array<short, kPixels>
      all;  // one after the other: the compiler knows instructions for that
  alignas(Row) std::array<short, kWidth> columns;
  Row sums{};  // of eight derivatives of up to 4 * 255
  for (int y = 0; y < kHeight; ++y, first += stride) {
    Row row;
    std::memcpy(&row, first, sizeof row);
    std::memcpy(&all[y * kWidth], &row, sizeof row);
    sums += row;
  }
  std::memcpy(columns.data(), &sums, sizeof sums);
  int total = 0, energy = 0;
  for (const short value : columns) total += value;
  for (const short value : all) energy += value * value;
  return energy - static_cast<int>(static_cast<int64_t>(total) * total / kPixels);
}

}  // namespace

PhotometricBlocks::PhotometricBlocks(cv::Mat left_mask, cv::Mat right_mask)
    : left_mask_(std::move(left_mask)), right_mask_(std::move(right_mask)) {}

bool PhotometricBlocks::usable(const StereoRig& rig, const ShiftModel& shift, int u, int v) const {
  for (const int y : {v, v + kHeight - 1}) {
    for (const int x : {u, u + kWidth - 1}) {
      const double column = x - shift.at(x, y);
      if (shift.at(x, y) - rig.principalOffset() < kLeastDisparity) return false;
      if (column < kMargin || column > right_mask_.cols - 2 - kMargin) return false;
      if (!set(left_mask_, x, y) || !set(right_mask_, column, y)) return false;
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
  gradient_.create(left.size(), CV_16S);
  cv::Mat ground = gradient_.rowRange(first_row_, left.rows);
  cv::Sobel(left.rowRange(first_row_, left.rows), ground, CV_16S, 1, 0);
  for (int v = first_row_; v + kHeight + kMargin <= left.rows; v += kHeight) {
    for (int u = kMargin; u + kWidth + kMargin <= left.cols; u += kWidth) {
      if (!usable(rig, shift, u, v)) continue;
      const int energy = blockEnergy(gradient_.ptr<short>(v) + u, gradient_.step1());
      candidates_.push_back({u, v, energy, false});
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
                                                           Block& block) const {
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
  BlockRow grey_sum{}, slope_sum{};
  for (int y = 0; y < kHeight; ++y) {
    const float* grey = &pixels[y + kAround][kAround];
    const short* gradient = gradient_.ptr<short>(candidate.v + y) + candidate.u;
    float* slope = &block.slope[y * kWidth];
    for (int x = 0; x < kWidth; x += kLanes) {
      Lanes slopes;
      convert(gradient + x, slopes);
      store(slopes / kSobelScale, slope + x);
    }
    for (int x = 0; x < kWidth; ++x) {
      grey_sum[x] += grey[x];
      slope_sum[x] += slope[x];
    }
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
  blocks_.clear();
  blocks_.reserve(count);
  for (const Candidate& candidate : candidates_) {
    if (!candidate.chosen) continue;
    blocks_.emplace_back();
    if (!makeBlock(left, candidate, blocks_.back())) blocks_.pop_back();
  }
}

void PhotometricBlocks::multiply(const cv::Mat& right, const ShiftModel& shift) {
  products_.clear();
  const float step = static_cast<float>(1 - shift.a);
  for (const Block& block : blocks_) {
    const double begin = block.u - shift.at(block.u, block.v), end = begin + step * (kWidth - 1);
    const double down = -shift.b * (kHeight - 1);
    if (std::min({begin, end, begin + down, end + down}) < kMargin ||
        std::max({begin, end, begin + down, end + down}) > right.cols - 1 - kMargin) {
      continue;
    }
    const float reference = right.at<uchar>(block.v, static_cast<int>(begin));
    const BlockSums sums = addUp(right.rowRange(block.v, block.v + kHeight), begin, -shift.b, step, reference,
                                 block.grey.data(), block.slope.data());
    const double total = sums.r, grey = sums.greys;
    const double explained = total * total / kPixels + grey * grey / block.grey_energy;
    products_.push_back({&block, grey, sums.slopes, (sums.squares - explained) / (kPixels - 2)});
  }
}

double PhotometricBlocks::Products::varianceAt(double gain) const {
  const double energy = block->grey_energy, beside_own = variance * (kPixels - 2);
  return (beside_own + grey * grey / energy - 2 * gain * grey + gain * gain * energy) / (kPixels - 1);
}

std::optional<PhotometricBlocks::Photometry> PhotometricBlocks::photometry() const {
  constexpr int kRounds = 3;
  std::vector<double> variances(products_.size());
  Photometry found{1, 0, 0};
  for (int round = 0; round < kRounds; ++round) {
    // Blocks have their own gains while the common one is not known. That of a block of nothing but noise is
    // about none, so its residuals lack the left image's noise: alone they would make the noise half as large
    // as it is.
    std::transform(products_.begin(), products_.end(), variances.begin(), [&](const Products& products) {
      return round == 0 ? products.variance : products.varianceAt(found.gain);
    });
    // Blocks that are not on the plane leave large residuals, so those of the best fitting ones tell the
    // noise.
    found.residual = lowerQuartileOf(variances);
    found.noise = found.residual / kQuartile / (found.gain * found.gain + kInterpolated);
    // The noise of the left image makes its squares larger than what both images have in common.
    double in_common = 0, squares = 0;
    for (const Products& products : products_) {
      in_common += products.grey;
      squares += products.block->grey_energy - found.noise * kPixels;
    }
    found.gain = in_common / squares;
    if (!(squares > 0 && found.gain > kLeastGain)) return std::nullopt;
  }
  return found;
}

int PhotometricBlocks::compare(const cv::Mat& right, const ShiftModel& shift, std::vector<Match>& matches) {
  matches.clear();
  multiply(right, shift);
  if (products_.empty()) return 0;
  const std::optional<Photometry> common_to_all = photometry();
  if (!common_to_all) return 0;
  const auto [gain, noise, residual] = *common_to_all;
  const double grey_noise = noise * kPixels, slope_noise = noise * kPixels * kSlopeNoise;
  const double product_noise = noise * kPixels * kProductNoise;
  const double product_stddev = noise * std::sqrt(kPixels * kProductScatter);
  const double usual = std::max(usual_energy_ - slope_noise, kLeastUsual * slope_noise);
  int informative = 0;
  for (const Products& products : products_) {
    const Block& block = *products.block;
    const double common = block.grey_energy - grey_noise;
    if (common < kLeastShareOfGrey * block.grey_energy) continue;
    // The derivative less what of it looks like a gain: slope - mixed grey.
    const double mixed = block.both / common;
    const double energy = block.slope_energy - 2 * mixed * block.both + mixed * mixed * block.grey_energy;
    // What a shift by a pixel does to the score.
    const double signal =
        signalBehind(block.along_slope - mixed * block.along_grey - product_noise, product_stddev, usual);
    const double response = gain * signal;
    if (signal < kLeastShareOfSlope * energy) continue;
    const double score = products.slope - mixed * products.grey;
    const double variance = std::max(products.variance - score * score / energy / kPixels, kLeastVariance);
    ++informative;
    // What the right image has beside noise: the part that is like the block, and the rest.
    const double alike = products.grey * products.grey / block.grey_energy * (common / block.grey_energy);
    const double other = kPixels * std::max(0.0, variance - kNoiseScatter * residual);
    if (alike < kLeastCorrelation * (alike + other)) continue;
    matches.push_back({block.centre_u, block.centre_v, score / response,
                       std::sqrt(variance * energy) / response,
                       (block.down_slope - mixed * block.down_grey) / signal});
  }
  return informative;
}

}  // namespace uav_landing
