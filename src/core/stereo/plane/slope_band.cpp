#include "stereo/plane/slope_band.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "image/input/image_check.h"
#include "stereo/matching/row_matching.h"
#include "uav_landing/parameters/window_radius.h"

namespace uav_landing {
namespace {

// Smallest disparity looked for, pixels. It is negative, so that infinity is not taken for ground.
constexpr double kNearestToHorizon = -2.0;
constexpr int kRoom = 4 * kLargestWindowRadius;  // columns

// Largest disparity on planes within the limits whose disparity changes by at most this much per row.
class LargestDisparity {
 public:
  LargestDisparity(const StereoRig& rig, const PlaneLimits& limits, double slope, double largest)
      : rig_(rig),
        slope_(slope),
        largest_(largest),
        roll_(std::tan(limits.max_roll)),
        pitch_(std::tan(limits.max_pitch) / std::cos(limits.max_roll)) {}

  // At the corner's column the horizon is at most this far above its place without roll and pitch.
  double at(const cv::Point& corner) const {
    const Eigen::Vector3d ray = rig_.ray(corner.x, corner.y);
    const double horizon = roll_ * std::abs(ray.x()) + pitch_;
    return std::min(slope_ * rig_.fy * (ray.y() + horizon), largest_);
  }

 private:
  const StereoRig& rig_;
  double slope_, largest_, roll_, pitch_;
};

// Columns of the right image in which a corner is looked for.
class Columns {
 public:
  Columns(const cv::Point& corner, double offset, double largest, int width) {
    const int left = cvFloor(corner.x - offset - largest);
    const int right = cvCeil(corner.x - offset - kNearestToHorizon);
    first_ = std::max(0, left);
    steps_ = (std::min(width - 1, right) - first_ + 1) / 2;
    // A peak at an end of the range may be none. At the image's border this does not matter, as nothing
    // follows.
    least_ = left > 0 ? first_ + 0.5 : -INFINITY;
    most_ = right < width - 1 ? right - 0.5 : INFINITY;
  }
  int steps() const { return steps_; }  // to each side of the middle
  int middle() const { return first_ + steps_; }
  bool isPeak(double column) const { return column > least_ && column < most_; }

 private:
  int first_, steps_;
  double least_, most_;
};

}  // namespace

SlopeBand SlopeBands::at(size_t index) {
  constexpr std::array<double, kAll> kShears = {0.0, 0.04, 0.09, 0.16, 0.25, 0.37, 0.52, 0.72, 1.0, 1.4};
  const double before = index == 0 ? 0.0 : kShears[index - 1];
  const double after = index + 1 == kAll ? 2.0 * kShears[index] : kShears[index + 1];
  return {kShears[index], {before, after}};
}

void addRoomBeside(const cv::Mat& image, cv::Mat& wide) {
  cv::copyMakeBorder(image, wide, 0, 0, kRoom, kRoom, cv::BORDER_CONSTANT,
                     cv::Scalar(std::numeric_limits<float>::quiet_NaN()));
}

BandCandidates candidatesOf(const SlopeBand& band, const RoomyLevel& images,
                            const std::vector<cv::Point>& corners, const StereoDepthParameters& parameters,
                            const PlaneLimits& limits) {
  constexpr double kMinScore = 0.6, kShareOfBest = 0.85, kStddev = 0.5;
  constexpr int kMostPeaks = 5;
  const StereoLevel& level = images.level;
  const double offset = level.rig.principalOffset();
  const LargestDisparity largest(level.rig, limits, band.range.y(),
                                 parameters.max_disparity * level.rig.size.width);
  const RowWarp warp{1.0, parameters.warp_window ? -band.shear : 0.0};
  RowSearch search(level.left, images.right, parameters.window_radius, parameters.matching_cost);
  BandCandidates found;
  std::vector<double> disparities;
  for (const cv::Point& corner : corners) {
    const Columns columns(corner, offset, largest.at(corner), level.right.cols);
    if (columns.steps() < 1) continue;
    found.scored += 2 * columns.steps() + 1;
    if (!search.run(corner.x, corner.y, kRoom + columns.middle(), columns.steps(), warp)) continue;
    disparities.clear();
    const std::vector<RowCandidate> peaks = search.peaks(kMinScore, kMostPeaks);
    for (const RowCandidate& peak : peaks) {
      if (peak.score < kShareOfBest * peaks.front().score) break;
      const double column = peak.position - kRoom;
      if (columns.isPeak(column) && isSet(level.right_mask, column, corner.y))
        disparities.push_back(corner.x - column - offset);
    }
    if (disparities.empty()) continue;
    found.samples.push_back({double(corner.x),
                             double(corner.y),
                             kStddev,
                             disparities.front(),
                             {disparities.begin() + 1, disparities.end()}});
  }
  return found;
}

}  // namespace uav_landing
