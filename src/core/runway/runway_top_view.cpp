#include "runway/runway_top_view.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "kernels/lanes/lanes.h"
#include "kernels/lanes/multiversion.h"

namespace uav_landing {

namespace {

constexpr double kFarthest = 60;     // heights
constexpr double kNearest = 0.5;     // heights
constexpr double kFootprint = 0.02;  // of the width: largest length on the ground of a pixel that tells
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kColumns = TopView::kColumns;

/// Where a picture shows points of a line in space, origin + y direction; columns of -infinity behind the
/// camera.
struct LineView {
  Eigen::Vector3d origin, direction;
  double fx, fy, cx, cy;
};
using Places = std::array<double, kColumns>;
UAV_LANDING_MULTIVERSION void project(const LineView& line, const Places& y, Places& u, Places& v) {
  const double x0 = line.origin.x(), y0 = line.origin.y(), z0 = line.origin.z();
  const double dx = line.direction.x(), dy = line.direction.y(), dz = line.direction.z();
  const double fx = line.fx, fy = line.fy, cx = line.cx, cy = line.cy;
  for (int c = 0; c < kColumns; ++c) {
    const double z = z0 + y[c] * dz, inverse = 1 / z;
    const double left_out = z > 0 ? 0 : -kInfinity;
    v[c] = fy * (y0 + y[c] * dy) * inverse + cy;
    u[c] = fx * (x0 + y[c] * dx) * inverse + cx + left_out;
  }
}

/// What greys at some places are interpolated from.
struct Pixels {
  std::array<int, kColumns> in_image, in_mask;       // where the one to the upper left is; any outside
  std::array<float, kColumns> right, below;          // how far the place is from there, px
  std::array<int, kColumns> inside;                  // 1 where they are all in the picture
  std::array<std::uint16_t, kColumns> upper, lower;  // the left one in the lower byte
};

/// Beside the camera places are farther out than an int can say.
UAV_LANDING_MULTIVERSION void findPixels(const Places& u, const Places& v, const cv::Mat& image,
                                         const cv::Mat& mask, Pixels& pixels) {
  const double right_end = image.cols - 1, lower_end = image.rows - 1;
  const int image_step = static_cast<int>(image.step), mask_step = static_cast<int>(mask.step);
  const double last_column = std::nextafter(right_end, 0), last_row = std::nextafter(lower_end, 0);
  for (int c = 0; c < kColumns; ++c) {
    const double x = u[c] > 0 ? u[c] : 0, y = v[c] > 0 ? v[c] : 0;
    const double in_x = x < right_end ? x : last_column, in_y = y < lower_end ? y : last_row;
    const int column = static_cast<int>(in_x), row = static_cast<int>(in_y);
    pixels.in_image[c] = row * image_step + column;
    pixels.in_mask[c] = row * mask_step + column;
    pixels.right[c] = static_cast<float>(in_x - column);
    pixels.below[c] = static_cast<float>(in_y - row);
    pixels.inside[c] = (in_x == u[c] ? 1 : 0) & (in_y == v[c] ? 1 : 0);
  }
}

void loadPixels(const cv::Mat& image, const cv::Mat& mask, Pixels& pixels) {
  const uchar *above = image.data, *below = above + image.step, *kept = mask.data;
  for (int c = 0; c < kColumns; ++c) {
    const int place = pixels.in_image[c];
    std::memcpy(&pixels.upper[c], above + place, sizeof(std::uint16_t));
    std::memcpy(&pixels.lower[c], below + place, sizeof(std::uint16_t));
    pixels.inside[c] &= kept[pixels.in_mask[c]];
  }
}

/// Returns how many there are.
UAV_LANDING_MULTIVERSION int interpolate(const Pixels& pixels, TopView::Across& greys) {
  int count = 0;
  for (int c = 0; c < kColumns; ++c) {
    const int upper_left = pixels.upper[c] & 255, upper_right = pixels.upper[c] >> 8;
    const int lower_left = pixels.lower[c] & 255, lower_right = pixels.lower[c] >> 8;
    const float s = pixels.right[c], t = pixels.below[c];
    const float upper = static_cast<float>(upper_left) + s * static_cast<float>(upper_right - upper_left);
    const float lower = static_cast<float>(lower_left) + s * static_cast<float>(lower_right - lower_left);
    const float grey = upper + t * (lower - upper);
    const float left_out = pixels.inside[c] != 0 ? 0 : std::numeric_limits<float>::quiet_NaN();
    greys[c] = grey + left_out;
    count += pixels.inside[c];
  }
  return count;
}

/// Of the stations of a block.
UAV_LANDING_MULTIVERSION void average(const TopView::Across* rows, TopView::Across& mean) {
  constexpr int kRows = 2 * TopView::kBlock + 1;
  for (int c = 0; c < kColumns; c += kLanes) {
    Lanes sum, more;
    load(&rows[0][c], sum);
    for (int i = 1; i < kRows; ++i) {
      load(&rows[i][c], more);
      sum += more;
    }
    store(sum / static_cast<float>(kRows), &mean[c]);
  }
}

}  // namespace

TopView::TopView(const cv::Mat& image, const cv::Mat& mask, const StereoRig& rig, const GroundAxes& axes,
                 const RunwayCrossSection& runway, std::vector<Across>& rows)
    : image_(image), mask_(mask), rig_(rig), axes_(axes), step_(1 / rig.fy), rows_(rows) {
  for (int c = 0; c < kColumns; ++c)
    across_[c] = runway.centre + ((c + 0.5) / kColumns - 0.5) * kAcross * runway.width;
  // Stations lie evenly in the inverse of the distance, as pixels do.
  const double farthest = std::min(kFarthest, std::sqrt(kFootprint * runway.width / step_));
  rows_.clear();
  bool begun = false;
  for (int k = 0;; ++k) {
    const double inverse = 1 / kNearest - k * step_;
    if (inverse <= 1 / farthest) break;
    if (!begun && !mayBeSeen(1 / inverse)) continue;
    rows_.emplace_back();
    if (sample(1 / inverse, rows_.back())) {
      begun = true;
      inverse_.push_back(inverse);
    } else {
      rows_.pop_back();
      if (begun) break;
    }
  }
}

/// Quick: a row of which neither this nor that quarter's end is in the picture has not enough of it there, as
/// what is there hangs together.
bool TopView::mayBeSeen(double x) const {
  const auto isSeen = [&](int c) {
    const Eigen::Vector3d point = x * axes_.forward + axes_.down + across_[c] * axes_.left;
    const double u = rig_.fx * point.x() + rig_.cx * point.z(), v = rig_.fy * point.y() + rig_.cy * point.z();
    return point.z() > 0 && u >= 0 && v >= 0 && u < image_.cols * point.z() && v < image_.rows * point.z();
  };
  return isSeen(kColumns / 4) || isSeen(kColumns - 1 - kColumns / 4);
}

bool TopView::sample(double x, Across& row) const {
  Places columns, lines;
  project({x * axes_.forward + axes_.down, axes_.left, rig_.fx, rig_.fy, rig_.cx, rig_.cy}, across_, columns,
          lines);
  if (image_.cols < 2 || image_.rows < 2) return false;
  Pixels pixels;
  findPixels(columns, lines, image_, mask_, pixels);
  loadPixels(image_, mask_, pixels);
  const int inside = interpolate(pixels, row);
  return inside >= kLeastPicture * kColumns;
}

TopView::Across TopView::blockAround(int k) const {
  Across block;
  average(&row(k - kBlock), block);
  return block;
}

double meanOf(const TopView::Across& row) {
  double sum = 0;
  int count = 0;
  for (const float value : row) {
    if (!std::isfinite(value)) continue;
    sum += value;
    ++count;
  }
  return count > 0 ? sum / count : 0;
}

}  // namespace uav_landing
