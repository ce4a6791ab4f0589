#include "runway_top_view.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "multiversion.h"

namespace uav_landing {

namespace {

constexpr double kFarthest = 60;     // heights
constexpr double kNearest = 0.5;     // heights
constexpr double kFootprint = 0.02;  // of the width: largest length on the ground of a pixel that tells
constexpr int kColumns = TopView::kColumns;

/// Where a picture shows points of a line in space, origin + y direction; columns below 0 behind the camera.
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
    const double column = fx * (x0 + y[c] * dx) * inverse + cx;
    v[c] = fy * (y0 + y[c] * dy) * inverse + cy;
    u[c] = z > 0 ? column : -1;
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

inline float TopView::greyAt(double u, double v) const {
  // Beside the camera pixels are farther out than an int can say.
  if (!(u >= 0 && v >= 0 && u < image_.cols - 1 && v < image_.rows - 1))
    return std::numeric_limits<float>::quiet_NaN();
  const int i = static_cast<int>(v), j = static_cast<int>(u);
  if (mask_.at<uchar>(i, j) == 0) return std::numeric_limits<float>::quiet_NaN();
  const float s = static_cast<float>(u - j), t = static_cast<float>(v - i);
  const uchar *above = image_.ptr<uchar>(i) + j, *below = above + image_.step;
  const float upper = static_cast<float>(above[0]) + s * static_cast<float>(above[1] - above[0]);
  const float lower = static_cast<float>(below[0]) + s * static_cast<float>(below[1] - below[0]);
  return upper + t * (lower - upper);
}

bool TopView::sample(double x, Across& row) const {
  Places columns, lines;
  project({x * axes_.forward + axes_.down, axes_.left, rig_.fx, rig_.fy, rig_.cx, rig_.cy}, across_, columns,
          lines);
  int inside = 0;
  for (int c = 0; c < kColumns; ++c) {
    row[c] = greyAt(columns[c], lines[c]);
    inside += std::isnan(row[c]) ? 0 : 1;
  }
  return inside >= kLeastPicture * kColumns;
}

TopView::Across TopView::blockAround(int k) const {
  Across block = row(k - kBlock);
  for (int i = k - kBlock + 1; i <= k + kBlock; ++i)
    for (int c = 0; c < kColumns; ++c) block[c] += row(i)[c];
  for (float& value : block) value /= 2 * kBlock + 1;
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
