#include "far/surface_disparity.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "estimation/robust.h"
#include "kernels/lanes/interpolation.h"
#include "rig/rig_rotation.h"

namespace uav_landing {
namespace {

constexpr double kAround = 4;  // px beside the outline: the edges, and ground at the same distance
constexpr double kMostPixels = 2000;
constexpr size_t kFewest = 60;
constexpr int kIterations = 8, kRounds = 3;
constexpr double kSettled = 0.001;  // px
constexpr double kFarthest = 2;     // px from the start
constexpr double kLeastGain = 0.4, kMostGain = 2.5;
constexpr double kLeastAlike = 0.5;  // share of the left image's contrast that the right one has, too
constexpr double kLeastNoise = 0.5, kAnyNoise = 1e6;  // grey levels
// Interpolated noise, and what both cameras show differently, are alike in neighbouring pixels.
constexpr double kTogether = 2;

/// A pixel of the left image. about: disparity by the plane that is known roughly.
struct Pixel {
  int u, v;
  double grey, slope, about;
};

std::vector<Pixel> pixelsOf(const cv::Mat& image, const RigModel& model, const Corners& corners,
                            const GroundPlane& about) {
  const Eigen::Vector2d low = boxOf(corners).min(), high = boxOf(corners).max();
  const std::array<OutlineSide, kSides> sides{OutlineSide(corners, 0), OutlineSide(corners, 1),
                                              OutlineSide(corners, 2), OutlineSide(corners, 3)};
  const auto isNear = [&](const Eigen::Vector2d& place) {
    return std::all_of(sides.begin(), sides.end(), [&](const OutlineSide& side) {
      return side.inward.dot(place - side.from) >= -kAround;
    });
  };
  const int left = std::max(1, static_cast<int>(low.x() - kAround)),
            right = std::min(image.cols - 2, static_cast<int>(high.x() + kAround) + 1),
            top = std::max(0, static_cast<int>(low.y() - kAround)),
            bottom = std::min(image.rows - 1, static_cast<int>(high.y() + kAround) + 1);
  const double area = std::max(0, right - left + 1) * static_cast<double>(std::max(0, bottom - top + 1));
  const int stride = std::max(1, static_cast<int>(std::ceil(area / kMostPixels)));  // of rows
  std::vector<Pixel> pixels;
  for (int v = top; v <= bottom; v += stride) {
    const uchar *grey = image.ptr<uchar>(v), *usable = model.left_mask.ptr<uchar>(v);
    for (int u = left; u <= right; ++u) {
      if (usable[u - 1] == 0 || usable[u + 1] == 0 || !isNear({u, v})) continue;
      const double disparity = about.disparity(model.rig, u, v);
      if (disparity > 0)
        pixels.push_back({u, v, double(grey[u]), 0.5 * (grey[u + 1] - grey[u - 1]), disparity});
    }
  }
  return pixels;
}

/// Where the disparity of the whole is that of a pixel: the middle of what tells it.
std::optional<Eigen::Vector2d> middleOf(const std::vector<Pixel>& pixels) {
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  double sum = 0;
  for (const Pixel& pixel : pixels) {
    const double weight = pixel.slope * pixel.slope * pixel.about;
    middle += weight * Eigen::Vector2d(pixel.u, pixel.v);
    sum += weight;
  }
  if (!(sum > 0)) return std::nullopt;
  return middle / sum;
}

/// The right image, between its pixels.
class RightImage {
 public:
  RightImage(const cv::Mat& image, const RigModel& model, const RightCamera& camera)
      : image_(image), model_(model), camera_(camera) {}

  /// 1 sigma of the disparity by what is not known of the camera's rotation, px.
  double biasStddev(const Eigen::Vector2d& left, double disparity) const {
    if (!camera_.turned.known()) return 0;
    const Eigen::RowVector3d by = byRotation(left, disparity);
    return std::sqrt(by.dot(camera_.turned.covariance * by.transpose()));
  }

  /// What it shows of a pixel of the left image with this disparity; NaN where it shows nothing.
  double at(const Pixel& pixel, double disparity) const {
    const Eigen::Vector2d left(pixel.u, pixel.v);
    if (camera_.turned.known()) disparity += byRotation(left, disparity).dot(camera_.turned.w);
    const Eigen::Vector2d place = placeInRightImage(model_.rig, camera_.rows, left, disparity);
    const int u = static_cast<int>(std::floor(place.x())), v = static_cast<int>(std::floor(place.y()));
    if (u < 1 || u + 2 >= image_.cols || v < 0 || v + 1 >= image_.rows) return std::nan("");
    const cv::Mat& usable = model_.right_mask;
    if (usable.at<uchar>(v, u) == 0 || usable.at<uchar>(v + 1, u + 1) == 0) return std::nan("");
    const double right = place.x() - u, down = place.y() - v;
    return (1 - down) * inRow(v, u, right) + down * inRow(v + 1, u, right);
  }

 private:
  /// What the disparity of a place is moved by, per rad of the camera's rotation, px.
  Eigen::RowVector3d byRotation(const Eigen::Vector2d& left, double disparity) const {
    return disparityByRotation(model_.rig, left.x() - disparity - model_.rig.principalOffset(), left.y());
  }

  double inRow(int v, int u, double right) const {
    const uchar* row = image_.ptr<uchar>(v) + u;
    return parabolicBetween(row[-1], row[0], row[1], row[2], static_cast<float>(right));
  }

  const cv::Mat& image_;
  const RigModel& model_;
  const RightCamera& camera_;
};

/// Solution of: left = gain right + offset - growth about slope. growth: of the disparities, as a share.
struct Alignment {
  double gain, offset, growth;
  double growth_variance;
  double alike;  // share of the left image's contrast that is explained
};

/// Least squares of the alignment, where the right image shows something.
class Aligner {
 public:
  Aligner(const std::vector<Pixel>& pixels, const std::vector<double>& right) {
    for (size_t i = 0; i < pixels.size(); ++i)
      if (std::isfinite(right[i]))
        rows_.push_back({{right[i], 1, -pixels[i].about * pixels[i].slope}, pixels[i].grey});
  }

  std::optional<Alignment> solve() {
    if (rows_.size() < kFewest) return std::nullopt;
    for (int round = 0; round < kRounds; ++round)
      if (!iterate()) return std::nullopt;
    const double variance = kTogether * noise_ * noise_ * information_.inverse()(2, 2);
    return Alignment{solution_[0], solution_[1], solution_[2], variance, alike()};
  }

 private:
  struct Row {
    Eigen::Vector3d of;  // right image, 1, change with the growth
    double grey;         // of the left image
  };
  double residual(const Row& row) const { return row.grey - row.of.dot(solution_); }

  bool iterate() {
    information_.setZero();
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    for (const Row& row : rows_) {
      const double root = tukeyRoot(residual(row) / (TukeyEnd::kEfficient * noise_)), weight = root * root;
      information_ += weight * row.of * row.of.transpose();
      gradient += weight * row.grey * row.of;
    }
    solution_ = information_.ldlt().solve(gradient);
    magnitudes_.clear();
    for (const Row& row : rows_) magnitudes_.push_back(std::abs(residual(row)));
    noise_ = std::max(kLeastNoise, robustStddev(magnitudes_));
    return solution_.allFinite();
  }

  double alike() const {
    double sum = 0, squares = 0, left_over = 0;
    for (const Row& row : rows_) {
      sum += row.grey;
      squares += row.grey * row.grey;
      left_over += residual(row) * residual(row);
    }
    return 1 - left_over / (squares - sum * sum / static_cast<double>(rows_.size()));
  }

  std::vector<Row> rows_;
  std::vector<double> magnitudes_;
  Eigen::Vector3d solution_{1, 0, 0};
  Eigen::Matrix3d information_;
  double noise_ = kAnyNoise;
};

}  // namespace

std::optional<SurfaceDisparity> measureDisparity(const RectifiedImages& images, const RigModel& model,
                                                 const RightCamera& right, const Corners& corners,
                                                 const GroundPlane& about) {
  const std::vector<Pixel> pixels = pixelsOf(images.left, model, corners, about);
  if (pixels.size() < kFewest) return std::nullopt;
  const std::optional<Eigen::Vector2d> middle = middleOf(pixels);
  if (!middle) return std::nullopt;
  const double start = about.disparity(model.rig, middle->x(), middle->y());
  const RightImage image(images.right, model, right);
  std::vector<double> greys(pixels.size());  // of the right image
  double scale = 1;                          // of the disparities, against `about`
  for (int i = 0; i < kIterations; ++i) {
    std::transform(pixels.begin(), pixels.end(), greys.begin(),
                   [&](const Pixel& pixel) { return image.at(pixel, scale * pixel.about); });
    const std::optional<Alignment> found = Aligner(pixels, greys).solve();
    if (!found || found->gain < kLeastGain || found->gain > kMostGain) return std::nullopt;
    scale += found->growth;
    if (!(scale > 0) || std::abs(scale - 1) * start > kFarthest) return std::nullopt;
    if (std::abs(found->growth) * start > kSettled) continue;
    if (found->alike < kLeastAlike) return std::nullopt;
    return SurfaceDisparity{*middle, scale * start, found->growth_variance * start * start,
                            image.biasStddev(*middle, scale * start)};
  }
  return std::nullopt;
}

}  // namespace uav_landing
