#include "uav_landing/image/patch_refinement.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "base/lanes.h"
#include "base/multiversion.h"
#include "image/parabolic_window.h"
#include "uav_landing/parameters/window_radius.h"

namespace uav_landing {
namespace {

constexpr int kLargestStride = (2 * kLargestWindowRadius + 1 + 3) / 4 * 4;
constexpr int kPlane = kLargestStride * (2 * kLargestWindowRadius + 1) + kLanes;

int strideOf(int radius) { return (2 * radius + 1 + 3) / 4 * 4; }
int paddedCount(int radius) { return wholeLanes((2 * radius + 1) * strideOf(radius)); }

// A window of the reference a, less the grey level in its middle, with its gradient x, y. Rows are filled up
// to a multiple of four and all of it to one of kLanes with zeros.
struct WindowPlanes {
  alignas(32) std::array<float, kPlane> a, x, y;
  float middle;
};

// Sums over a window of the reference and its gradient, and of their products.
struct ReferenceSums {
  double a, x, y, aa, ax, ay, xx, xy, yy;
};

// Sums over a window of the products of the reference's gradient with itself and with the distance from the
// window's centre, across and down.
struct MomentSums {
  double x, y, xx, xy, yy;
};

// Sums over a window of the other image b, and of its products.
struct OtherSums {
  double b, bb, ba, bx, by;
};

// One row of a window and its gradient.
struct WindowRow {
  float *a, *x, *y;
};

// row: of the image from the window's first column on; by stride to the next one.
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

UAV_LANDING_MULTIVERSION void loadWindow(const cv::Mat& image, int u, int v, int radius,
                                         WindowPlanes& planes) {
  const int size = 2 * radius + 1, stride = strideOf(radius);
  const std::ptrdiff_t step = static_cast<std::ptrdiff_t>(image.step1());
  const float middle = planes.middle = image.at<float>(v, u);
  const Lanes none{};
  for (int j = 0; j < size; ++j) {
    const float* row = image.ptr<float>(v - radius + j) + u - radius;
    const auto at = [&](int i) {
      return WindowRow{&planes.a[j * stride + i], &planes.x[j * stride + i], &planes.y[j * stride + i]};
    };
    // The last lanes of a row end where it does, so that nothing outside the image is read.
    for (int i = 0; size >= kLanes && i < size; i += kLanes) {
      const int first = std::min(i, size - kLanes);
      loadLanes(row + first, step, middle, at(first));
    }
    for (int i = 0; size < kLanes && i < size; ++i) loadOne(row + i, step, middle, at(i));
    // What fills the row up; where the next one begins, that comes after.
    for (float* end : {at(size).a, at(size).x, at(size).y}) store(none, end);
  }
}

UAV_LANDING_MULTIVERSION ReferenceSums addUp(const WindowPlanes& planes, int count) {
  Lanes a1{}, x1{}, y1{}, aa{}, ax{}, ay{}, xx{}, xy{}, yy{};
  for (int i = 0; i < count; i += kLanes) {
    Lanes a, x, y;
    load(&planes.a[i], a);
    load(&planes.x[i], x);
    load(&planes.y[i], y);
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

// Distances from the centre of a window's places, laid out as WindowPlanes.
struct DistancePlanes {
  alignas(32) std::array<float, kPlane> across, down;

  explicit DistancePlanes(int radius) {
    const int stride = strideOf(radius);
    for (int i = 0; i < kPlane; ++i) {
      across[i] = static_cast<float>(i % stride - radius);
      down[i] = static_cast<float>(i / stride - radius);
    }
  }
};

const DistancePlanes& distancesOf(int radius) {
  static const std::vector<DistancePlanes> all = [] {
    std::vector<DistancePlanes> planes;
    for (int r = 0; r <= kLargestWindowRadius; ++r) planes.emplace_back(r);
    return planes;
  }();
  return all[radius];
}

UAV_LANDING_MULTIVERSION MomentSums addUpBy(const float* distance, const WindowPlanes& planes, int count) {
  Lanes x1{}, y1{}, xx{}, xy{}, yy{};
  for (int i = 0; i < count; i += kLanes) {
    Lanes x, y, d;
    load(&planes.x[i], x);
    load(&planes.y[i], y);
    load(distance + i, d);
    const Lanes dx = d * x, dy = d * y;
    x1 += dx;
    y1 += dy;
    xx += dx * x;
    xy += dx * y;
    yy += dy * y;
  }
  return {sum(x1), sum(y1), sum(xx), sum(xy), sum(yy)};
}

// other: values of the other image, the reference's middle where they do not count.
UAV_LANDING_MULTIVERSION OtherSums multiply(const WindowPlanes& planes, const float* other, int count) {
  const float middle = planes.middle;
  Lanes b1{}, bb{}, ba{}, bx{}, by{};
  for (int i = 0; i < count; i += kLanes) {
    Lanes a, x, y, b;
    load(&planes.a[i], a);
    load(&planes.x[i], x);
    load(&planes.y[i], y);
    load(other + i, b);
    b -= middle;
    b1 += b;
    bb += b * b;
    ba += b * a;
    bx += b * x;
    by += b * y;
  }
  return {sum(b1), sum(bb), sum(ba), sum(bx), sum(by)};
}

// Shift and gain of: reference + gradient.shift = gain other + offset, by least squares.
struct GainShift {
  bool solved = false;
  Eigen::Vector2d shift;
  double gain = 0;
  double residual = 0;        // sum of squares
  Eigen::Vector2d projected;  // shift that a unit of gain would look like
  double left_over = 0;       // contrast that no shift explains
};

// A window of the reference with all sums of it that do not depend on the other image, about their means.
class ReferenceWindow {
 public:
  ReferenceWindow(const cv::Mat& reference, int u, int v, int radius) : radius_(radius) {
    loadWindow(reference, u, v, radius, planes_);
    const ReferenceSums sums = addUp(planes_, paddedCount(radius));
    mean_ = sums.a / count();
    gradient_mean_ = Eigen::Vector2d(sums.x, sums.y) / count();
    const Eigen::Vector2d& mean = gradient_mean_;
    G_ << sums.xx - mean.x() * sums.x, sums.xy - mean.x() * sums.y,  //
        sums.xy - mean.x() * sums.y, sums.yy - mean.y() * sums.y;
    right_ << sums.ax - mean.x() * sums.a, sums.ay - mean.y() * sums.a;
    energy_ = sums.aa - mean_ * sums.a;
    const double determinant = G_.determinant();
    usable_ = determinant > 1e-9 * G_.trace() * G_.trace();
    if (usable_) inverse_ = G_.inverse();
  }

  bool usable() const { return usable_; }
  int count() const { return (2 * radius_ + 1) * (2 * radius_ + 1); }
  double energy() const { return energy_; }

  // Best shift when the other image is looked at from `at`. The window must be inside by two pixels and
  // paddedReach().
  GainShift compare(const cv::Mat& other, const Eigen::Vector2d& at, const Eigen::Matrix2d& warp) const {
    alignas(32) std::array<float, kPlane> values;
    sampleParabolicWindow(other, at, warp, radius_, strideOf(radius_), values.data());
    const int size = 2 * radius_ + 1, stride = strideOf(radius_), padded = paddedCount(radius_);
    for (int j = 0; j < size; ++j)
      for (int i = size; i < stride; ++i) values[j * stride + i] = planes_.middle;
    for (int i = size * stride; i < padded; ++i) values[i] = planes_.middle;
    return solve(multiply(planes_, values.data(), padded));
  }
  PatchRefinement::Evidence evidence(const GainShift& found) const {
    const DistancePlanes& distances = distancesOf(radius_);
    return {G_,
            {momentsBy(distances.across.data()), momentsBy(distances.down.data())},
            found.projected,
            found.left_over,
            count()};
  }

  // Places to the right of the centre that are looked at, those filled up included.
  int paddedReach() const { return strideOf(radius_) - radius_ - 1; }

 private:
  Eigen::Matrix2d momentsBy(const float* distance) const {
    const MomentSums sums = addUpBy(distance, planes_, paddedCount(radius_));
    Eigen::Matrix2d moments;
    moments << sums.xx, sums.xy, sums.xy, sums.yy;
    return moments - gradient_mean_ * Eigen::RowVector2d(sums.x, sums.y);
  }

  GainShift solve(const OtherSums& sums) const {
    GainShift result;
    const Eigen::Vector2d gradient = Eigen::Vector2d(sums.bx, sums.by) - gradient_mean_ * sums.b;
    const double squares = sums.bb - sums.b * sums.b / count(), reference = sums.ba - mean_ * sums.b;
    const Eigen::Vector2d projected = inverse_ * gradient;
    const double left_over = squares - gradient.dot(projected);
    if (!(left_over > 1e-9 * squares)) return result;
    result.gain = (reference - projected.dot(right_)) / left_over;
    result.shift = inverse_ * (right_ - gradient * result.gain);
    result.residual = std::max(0.0, energy_ - result.shift.dot(right_) - result.gain * reference);
    result.projected = projected;
    result.left_over = left_over;
    result.solved = result.gain > 0.1;
    return result;
  }

  int radius_;
  bool usable_ = false;
  WindowPlanes planes_;
  double mean_;  // less the middle
  Eigen::Vector2d gradient_mean_;
  Eigen::Matrix2d G_, inverse_;
  Eigen::Vector2d right_;
  double energy_ = 0;
};

// Gauss-Newton steps, which all fall short by about the same share: how far one moves the place is seen by
// the next, and each is made longer by that (secant method). Then few are needed, and what the last one
// leaves has no direction of its own.
class SecantSteps {
 public:
  // The step to make where Gauss-Newton wants this one.
  Eigen::Vector2d next(const Eigen::Vector2d& wanted) {
    constexpr double kLongest = 1.0, kLeast = 0.4, kMost = 1.5;
    if (made_.squaredNorm() > 0)
      share_ = std::clamp(made_.dot(wanted_ - wanted) / made_.squaredNorm(), kLeast, kMost);
    wanted_ = wanted;
    made_ = wanted / share_;
    made_ /= std::max(1.0, made_.norm() / kLongest);
    ++count_;
    return made_;
  }
  // The place is good to about 0.005 px, little beside what matches are known to: a single step leaves a
  // tenth of itself, a secant step much less.
  bool converged() const {
    constexpr double kShort = 0.02, kShortSingle = 0.05, kShortSecant = 0.1;
    const double length = wanted_.norm();
    return length < kShortSingle ||
           (count_ > 1 && length < kShortSecant && (made_ - wanted_).norm() < kShort);
  }

 private:
  int count_ = 0;
  // Of the distance, that a step moves; short ones about as much where textures are smoothed alike.
  double share_ = 0.97;
  Eigen::Vector2d wanted_ = Eigen::Vector2d::Zero(), made_ = Eigen::Vector2d::Zero();
};

bool windowInside(const cv::Mat& image, int u, int v, int radius) {
  return u >= radius && v >= radius && u + radius < image.cols && v + radius < image.rows;
}

}  // namespace

// Noise has a gradient, too, but it says nothing: along a line, where there is no other, it would be believed
// to hold the match where it was looked for.
PatchRefinement::Claim PatchRefinement::claim(double noise_variance) const {
  // Variance of the gradient over that of the smoothed noise: (1 - its correlation two pixels on) / 2.
  constexpr double kNoiseGradient = 0.45;
  // The images are smoothed, so neighbouring residuals are not independent; share of independent ones. One in
  // 5.5 where gradients are the same all over the window, one in 4 where they change within 3 px.
  constexpr double kIndependent = 0.2;
  // Least share of the gradients' energy that can be told from none, given its scatter.
  constexpr double kLeastTexture = 0.1;
  const double of_noise = evidence.count * kNoiseGradient * std::min(noise_variance, 0.5 * residual_variance);
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes;
  axes.computeDirect(evidence.gradient);
  const Eigen::Array2d seen = axes.eigenvalues();
  const Eigen::Array2d share = (1 - of_noise / seen).max(kLeastTexture);  // of it that is of the texture
  const Eigen::Matrix2d& V = axes.eigenvectors();
  const Eigen::Matrix2d inverse = V * (1 / (seen * share)).matrix().asDiagonal() * V.transpose();
  const Eigen::Vector2d coupled = inverse * (evidence.gradient * evidence.by_gain);
  // Where the other window is smaller, its noise is that of fewer pixels.
  const double independent = kIndependent * 2 / (1 + 1 / std::min(1.0, std::abs(warp.determinant())));
  const Eigen::Matrix2d unit =
      inverse * evidence.gradient * inverse + coupled * coupled.transpose() / evidence.contrast;
  const Eigen::Matrix2d there = warp * inverse, back = warp.inverse();
  return {residual_variance / independent * warp * unit * warp.transpose(),
          {there * evidence.moments[0] * back, there * evidence.moments[1] * back}};
}

PatchRefinement refinePatch(const cv::Mat& reference, const cv::Mat& other, int u, int v,
                            const Eigen::Vector2d& position, const Eigen::Matrix2d& warp, int radius) {
  constexpr int kIterations = 12;
  constexpr double kMaxDrift = 2.0;
  PatchRefinement result;
  if (!windowInside(reference, u, v, radius + 1)) return result;
  const ReferenceWindow window(reference, u, v, radius);
  if (!window.usable()) return result;
  const double reach_x = std::abs(warp(0, 0)) * window.paddedReach() + std::abs(warp(0, 1)) * radius;
  const double reach_y = std::abs(warp(1, 0)) * window.paddedReach() + std::abs(warp(1, 1)) * radius;
  const double max_drift = kMaxDrift * std::sqrt(std::abs(warp.determinant()));
  Eigen::Vector2d at = position;
  SecantSteps steps;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    if (!(at.x() - reach_x >= 2 && at.y() - reach_y >= 2 && at.x() + reach_x < other.cols - 3 &&
          at.y() + reach_y < other.rows - 3)) {
      return result;
    }
    const GainShift found = window.compare(other, at, warp);
    if (!found.solved) return result;
    at -= warp * steps.next(found.shift);
    if ((at - position).norm() > max_drift) return result;
    if (steps.converged()) {
      result.residual_variance = found.residual / (window.count() - 4);
      result.evidence = window.evidence(found);
      result.warp = warp;
      result.score = std::sqrt(std::max(0.0, 1 - found.residual / std::max(1e-9, window.energy())));
      result.position = at;
      result.converged = true;
      return result;
    }
  }
  return result;
}

}  // namespace uav_landing
