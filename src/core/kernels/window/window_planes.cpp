#include "kernels/window/window_planes.h"

#include <algorithm>
#include <vector>

#include "kernels/lanes/multiversion.h"

namespace uav_landing {
namespace {

// One row of a window and its gradient.
struct WindowRow {
  float *a, *x, *y;

  WindowRow from(int i) const { return {a + i, x + i, y + i}; }
};

// row: of the image, from the window's first column on. stride: to the next row.
[[gnu::always_inline]] inline void loadLanes(const float* row, std::ptrdiff_t stride, float middle,
                                             const WindowRow& out) {
  Lanes value, before, after, above, below;
  load(row, value);
  load(row - 1, before);
  load(row + 1, after);
  load(row - stride, above);
  load(row + stride, below);
  store(value - middle, out.a);
  store(-0.5f * (after - before), out.x);
  store(-0.5f * (below - above), out.y);
}

[[gnu::always_inline]] inline void loadOne(const float* row, std::ptrdiff_t stride, float middle,
                                           const WindowRow& out) {
  *out.a = *row - middle;
  *out.x = -0.5f * (row[1] - row[-1]);
  *out.y = -0.5f * (row[stride] - row[-stride]);
}

[[gnu::always_inline]] inline void loadRows(const cv::Mat& image, int u, int v, int radius, int out_stride,
                                            WindowRow out) {
  const int size = 2 * radius + 1;
  const std::ptrdiff_t stride = rowStride(image);
  const float* row = image.ptr<float>(v - radius) + u - radius;
  const float middle = row[radius * stride + radius];
  const Lanes none{};
  for (int j = 0; j < size; ++j, row += stride) {
    // The last lanes of a row end with the row, so that nothing outside the image is read.
    for (int i = 0; size >= kLanes && i < size; i += kLanes) {
      const int first = std::min(i, size - kLanes);
      loadLanes(row + first, stride, middle, out.from(first));
    }
    for (int i = 0; size < kLanes && i < size; ++i) loadOne(row + i, stride, middle, out.from(i));
    // Fills up the row. The next row may overwrite the end of this, as it is written later.
    const WindowRow end = out.from(size);
    for (float* plane : {end.a, end.x, end.y}) store(none, plane);
    out = out.from(out_stride);
  }
}

// The usual size is known to the compiler, which then needs no loop for a row.
UAV_LANDING_MULTIVERSION void loadWindow(const cv::Mat& image, int u, int v, int radius,
                                         const WindowRow& out) {
  if (radius == kUsualWindowRadius) {
    loadRows(image, u, v, kUsualWindowRadius, windowStride(kUsualWindowRadius), out);
  } else {
    loadRows(image, u, v, radius, windowStride(radius), out);
  }
}

// Distances of a window's places from its centre, laid out as the window.
struct Distances {
  alignas(sizeof(Lanes)) WindowValues across, down;

  explicit Distances(int radius) {
    const int stride = windowStride(radius);
    for (int i = 0; i < static_cast<int>(across.size()); ++i) {
      across[i] = static_cast<float>(i % stride - radius);
      down[i] = static_cast<float>(i / stride - radius);
    }
  }
};

const Distances& distancesOf(int radius) {
  static const std::vector<Distances> all = [] {
    std::vector<Distances> of_radius;
    for (int r = 0; r <= kLargestWindowRadius; ++r) of_radius.emplace_back(r);
    return of_radius;
  }();
  return all[radius];
}

// Products of the gradient with a distance.
struct MomentLanes {
  Lanes x{}, y{}, xx{}, xy{}, yy{};

  [[gnu::always_inline]] inline void add(const Lanes& own_x, const Lanes& own_y, const float* distance) {
    Lanes d;
    load(distance, d);
    const Lanes dx = d * own_x, dy = d * own_y;
    x += dx;
    y += dy;
    xx += dx * own_x;
    xy += dx * own_y;
    yy += dy * own_y;
  }
  [[gnu::always_inline]] inline WindowPlanes::MomentSums sums() const {
    return {sum(x), sum(y), sum(xx), sum(xy), sum(yy)};
  }
};

// The gradient's response to a window that grows, times a distance.
struct GrowthLanes {
  Lanes s_across{}, s_down{}, x_across{}, x_down{}, y_across{}, y_down{};

  [[gnu::always_inline]] inline void add(const Lanes& x, const Lanes& y, const float* to_right,
                                         const float* below) {
    Lanes across, down;
    load(to_right, across);
    load(below, down);
    const Lanes s = x * across + y * down;
    across *= s;
    down *= s;
    s_across += across;
    s_down += down;
    x_across += x * across;
    x_down += x * down;
    y_across += y * across;
    y_down += y * down;
  }
  [[gnu::always_inline]] inline WindowPlanes::GrowthSums sums() const {
    return {sum(s_across), sum(s_down), sum(x_across), sum(x_down), sum(y_across), sum(y_down)};
  }
};

}  // namespace

WindowPlanes::WindowPlanes(const cv::Mat& image, int u, int v, int radius)
    : radius_(radius), middle_(image.at<float>(v, u)) {
  loadWindow(image, u, v, radius, {a_.data(), x_.data(), y_.data()});
}

UAV_LANDING_MULTIVERSION WindowPlanes::OwnSums WindowPlanes::sums() const {
  Lanes a1{}, x1{}, y1{}, aa{}, ax{}, ay{}, xx{}, xy{}, yy{};
  const int count = filled();
  for (int i = 0; i < count; i += kLanes) {
    Lanes a, x, y;
    load(&a_[i], a);
    load(&x_[i], x);
    load(&y_[i], y);
    a1 += a;
    x1 += x;
    y1 += y;
    aa += a * a;
    ax += a * x;
    ay += a * y;
    xx += x * x;
    xy += x * y;
    yy += y * y;
  }
  return {sum(a1), sum(x1), sum(y1), sum(aa), sum(ax), sum(ay), sum(xx), sum(xy), sum(yy)};
}

UAV_LANDING_MULTIVERSION WindowPlanes::DistanceSums WindowPlanes::distanceSums() const {
  const Distances& distances = distancesOf(radius_);
  MomentLanes across, down;
  GrowthLanes growth;
  const int count = filled();
  for (int i = 0; i < count; i += kLanes) {
    Lanes x, y;
    load(&x_[i], x);
    load(&y_[i], y);
    across.add(x, y, &distances.across[i]);
    down.add(x, y, &distances.down[i]);
    growth.add(x, y, &distances.across[i], &distances.down[i]);
  }
  return {{across.sums(), down.sums()}, growth.sums()};
}

UAV_LANDING_MULTIVERSION WindowPlanes::OtherSums WindowPlanes::multiply(WindowValues& other) const {
  const float middle = middle_;
  const int count = filled();
  fillUp(radius_, middle, other.data());  // values that do not count
  Lanes b1{}, bb{}, ba{}, bx{}, by{};
  UAV_LANDING_UNROLL
  for (int i = 0; i < count; i += kLanes) {
    Lanes a, x, y, b;
    load(&a_[i], a);
    load(&x_[i], x);
    load(&y_[i], y);
    load(&other[i], b);
    b -= middle;
    b1 += b;
    bb += b * b;
    ba += b * a;
    bx += b * x;
    by += b * y;
  }
  return {sum(b1), sum(bb), sum(ba), sum(bx), sum(by)};
}

}  // namespace uav_landing
