#include "kernels/block/block_texture.h"

#include <cstdint>

#include "kernels/lanes/lanes.h"
#include "kernels/lanes/multiversion.h"

namespace uav_landing {
namespace {

constexpr int kWidth = kBlockWidth, kHeight = kBlockHeight, kPixels = kBlockPixels;

// The grey levels of a block with two more pixels on all sides.
class Surroundings {
 public:
  [[gnu::always_inline]] inline void read(const cv::Mat& image, int u, int v) {
    for (int y = 0; y < kRows; ++y) {
      const uchar* row = image.ptr<uchar>(v + y - kAround) + u - kAround;
      for (const int x : {0, kLanes, kWidth + 2 * kAround - kLanes}) {
        Lanes greys;
        convert(row + x, greys);
        store(greys, &pixels_[y][x]);
      }
    }
  }

  // The block's pixels from (x, y) on.
  [[gnu::always_inline]] inline void greys(int x, int y, Lanes& out) const { load(at(x, y), out); }

  // Difference between the pixels to the right and to the left.
  [[gnu::always_inline]] inline void difference(int x, int y, Lanes& out) const {
    Lanes before, after;
    load(at(x - 1, y), before);
    load(at(x + 1, y), after);
    out = after - before;
  }

  // Derivative of fourth order, because the difference of two neighbours sees too little of a sharp edge.
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

UAV_LANDING_MULTIVERSION int slopeEnergy(const uchar* first, std::ptrdiff_t stride) {
  std::array<short, kPixels + 2 * kWidth> differences;  // of neighbours, also for the rows above and below
  std::array<short, kPixels> slopes;    // one after the other, as the compiler knows instructions for that
  std::array<short, kWidth> columns{};  // sums of eight values of up to 4 * 255
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

UAV_LANDING_MULTIVERSION void measureTexture(const cv::Mat& image, int u, int v, BlockTexture& texture) {
  Surroundings pixels;
  pixels.read(image, u, v);
  BlockRow grey_sum, slope_sum;
  findSlopes(pixels, texture.slope.data(), grey_sum, slope_sum);
  const float grey_mean = sumOf(grey_sum) / kPixels, slope_mean = sumOf(slope_sum) / kPixels;
  // Sums of the columns.
  BlockRow grey_squares, squares, products, downs, down_greys, down_slopes, along_greys, along_slopes;
  for (int x = 0; x < kWidth; x += kLanes) {
    Lanes gg{}, ss{}, gs{}, ss_y{}, dg{}, ds{}, ag{}, as{};
    for (int y = 0; y < kHeight; ++y) {
      Lanes down, along, grey, slope;
      pixels.derivative(x, y, 0, 1, down);
      pixels.derivative(x, y, 1, 0, along);
      pixels.greys(x, y, grey);
      load(&texture.slope[y * kWidth + x], slope);
      grey -= grey_mean;
      slope -= slope_mean;
      store(grey, &texture.grey[y * kWidth + x]);
      store(slope, &texture.slope[y * kWidth + x]);
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
  texture.grey_energy = sumOf(grey_squares);
  texture.slope_energy = sumOf(squares);
  texture.both = sumOf(products);
  texture.down_grey = sumOf(down_greys);
  texture.down_slope = sumOf(down_slopes);
  texture.along_grey = sumOf(along_greys);
  texture.along_slope = sumOf(along_slopes);
  texture.moment_u = 0;
  for (int x = 0; x < kWidth; ++x) texture.moment_u += squares[x] * static_cast<float>(x);
  texture.moment_v = sumOf(downs);
}

}  // namespace uav_landing
