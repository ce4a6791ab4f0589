#include "uav_landing/stereo/row_refinement.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/multiversion.h"
#include "image/parabolic_window.h"
#include "image/window_layout.h"

namespace uav_landing {
namespace {

// A window of the reference, less the grey level in its middle, and its change along the row; filled up by
// zeros (window_layout.h).
struct RowPlanes {
  int size, stride, count;  // count: with all zeros
  float middle;
  alignas(32) WindowValues value, gradient;
};

[[gnu::always_inline]] inline void loadRows(const cv::Mat& image, int u, int v, int radius, int out_stride,
                                            RowPlanes& planes) {
  const int size = 2 * radius + 1;
  const float middle = planes.middle = image.at<float>(v, u);
  const Lanes none{};
  for (int j = 0; j < size; ++j) {
    const float* row = image.ptr<float>(v - radius + j) + u - radius;
    float *a = &planes.value[j * out_stride], *g = &planes.gradient[j * out_stride];
    // The last lanes of a row end where it does, so that nothing outside the image is read.
    for (int i = 0; size >= kLanes && i < size; i += kLanes) {
      const int first = std::min(i, size - kLanes);
      Lanes value, before, after;
      load(row + first, value);
      load(row + first - 1, before);
      load(row + first + 1, after);
      store(value - middle, a + first);
      store(0.5f * (after - before), g + first);
    }
    for (int i = 0; size < kLanes && i < size; ++i) {
      a[i] = row[i] - middle;
      g[i] = 0.5f * (row[i + 1] - row[i - 1]);
    }
    // What fills the row up; where the next one begins, that comes after.
    store(none, a + size);
    store(none, g + size);
  }
}

// The usual size is known to the compiler, which then needs no loop for a row.
UAV_LANDING_MULTIVERSION void loadWindow(const cv::Mat& image, int u, int v, int radius, RowPlanes& planes) {
  planes.size = 2 * radius + 1;
  planes.stride = windowStride(radius);
  planes.count = wholeLanes(planes.size * planes.stride);
  if (radius == kUsualWindowRadius) {
    loadRows(image, u, v, kUsualWindowRadius, windowStride(kUsualWindowRadius), planes);
  } else {
    loadRows(image, u, v, radius, windowStride(radius), planes);
  }
}

// Sums over a window of the values a, their gradient g and their products.
struct RowWindowSums {
  double a, g, aa, ag, gg;
};

UAV_LANDING_MULTIVERSION RowWindowSums addUp(const RowPlanes& planes) {
  Lanes a1{}, g1{}, aa{}, ag{}, gg{};
  for (int i = 0; i < planes.count; i += kLanes) {
    Lanes a, g;
    load(&planes.value[i], a);
    load(&planes.gradient[i], g);
    a1 += a;
    g1 += g;
    aa += a * a;
    ag += a * g;
    gg += g * g;
  }
  return {sum(a1), sum(g1), sum(aa), sum(ag), sum(gg)};
}

// Sums over a window b of the other image: itself, its square, and with the reference and its gradient.
struct OtherSums {
  double b, bb, ab, bg;
};

UAV_LANDING_MULTIVERSION OtherSums multiply(const RowPlanes& planes, const float* other) {
  const float middle = planes.middle;
  Lanes b1{}, bb{}, ab{}, bg{};
  for (int i = 0; i < planes.count; i += kLanes) {
    Lanes a, g, b;
    load(&planes.value[i], a);
    load(&planes.gradient[i], g);
    load(other + i, b);
    b -= middle;
    b1 += b;
    bb += b * b;
    ab += b * a;
    bg += b * g;
  }
  return {sum(b1), sum(bb), sum(ab), sum(bg)};
}

void sampleRows(const cv::Mat& image, int v, double position, const RowWarp& warp, const RowPlanes& planes,
                float* out) {
  const int radius = planes.size / 2;
  const double start = position - warp.shear * radius - warp.scale * radius;
  sampleParabolicRows(image, v - radius, start, warp.shear, warp.scale, planes.size, planes.stride, out);
  fillUp(radius, planes.middle, out);  // what does not count
}

// The reference's window with the sums that do not depend on the other image, about the means.
struct RowWindow {
  RowPlanes planes;
  RowWindowSums sums;
  double aa, ag, gg;

  RowWindow(const cv::Mat& image, int u, int v, int radius) {
    loadWindow(image, u, v, radius, planes);
    sums = addUp(planes);
    aa = sums.aa - sums.a * sums.a / count();
    ag = sums.ag - sums.a * sums.g / count();
    gg = sums.gg - sums.g * sums.g / count();
  }
  int count() const { return planes.size * planes.size; }
};

// Sums over a window of the other image, about the means: with itself, with the reference and its gradient.
struct RowSums {
  double bb, ab, bg;
};

RowSums compareAlongRow(const RowWindow& window, const cv::Mat& other, int v, double position,
                        const RowWarp& warp) {
  alignas(32) WindowValues values;
  sampleRows(other, v, position, warp, window.planes, values.data());
  const OtherSums sums = multiply(window.planes, values.data());
  const double mean = sums.b / window.count();
  return {sums.bb - mean * sums.b, sums.ab - mean * window.sums.a, sums.bg - mean * window.sums.g};
}

}  // namespace

RowRefinement refineAlongRow(const cv::Mat& reference, const cv::Mat& other, int u, int v, double position,
                             const RowWarp& warp, int radius) {
  constexpr int kIterations = 8;
  // A step leaves about a tenth of itself: little beside what matches are known to.
  constexpr double kConverged = 0.05, kMaxDrift = 1.5;
  // The images are smoothed, so neighbouring residuals are not independent; share of independent ones.
  constexpr double kIndependent = 0.25;
  RowRefinement result;
  if (u < radius + 1 || v < radius || u + radius + 1 >= reference.cols || v + radius >= reference.rows)
    return result;
  const RowWindow window(reference, u, v, radius);
  if (window.aa <= 0 || window.gg <= 0) return result;
  const int padded = window.planes.stride - radius - 1;
  const double reach = std::abs(warp.scale) * padded + std::abs(warp.shear) * radius;
  double x0 = position;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    if (!(x0 - reach >= 2 && x0 + reach < other.cols - 3)) return result;
    const RowSums sums = compareAlongRow(window, other, v, x0, warp);
    // a = gain b + shift g + offset, by least squares for gain and shift (pixels of the reference).
    const double determinant = sums.bb * window.gg - sums.bg * sums.bg;
    if (!(determinant > 1e-9 * sums.bb * window.gg)) return result;
    const double gain = (sums.ab * window.gg - window.ag * sums.bg) / determinant;
    const double shift = (window.ag * sums.bb - sums.ab * sums.bg) / determinant;
    if (!(gain > 0.1)) return result;
    const double delta = shift * warp.scale;
    x0 += std::clamp(delta, -1.0, 1.0);
    if (std::abs(x0 - position) > kMaxDrift) return result;
    if (std::abs(delta) < kConverged) {
      const double residual = std::max(0.0, window.aa - gain * sums.ab - shift * window.ag);
      const double noise = residual / (window.count() - 3) / kIndependent;
      result.stddev = std::abs(warp.scale) * std::sqrt(noise * sums.bb / determinant);
      result.score = sums.ab / std::sqrt(window.aa * sums.bb);
      result.position = x0;
      result.converged = true;
      return result;
    }
  }
  return result;
}

}  // namespace uav_landing
