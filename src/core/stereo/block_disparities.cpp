#include "stereo/block_disparities.h"

#include <algorithm>
#include <cmath>

#include "uav_landing/image/match_image.h"

namespace uav_landing {
namespace {

// Blocks compared: about 100 thousand pixels, which hold nearly all that a noisy image says.
constexpr int kBlocks = 800;
// The comparison is first order in the shift: farther than this (pixels) it means nothing.
constexpr double kLargestShift = 1.5;
// 1 sigma from which on a faint block says nothing, pixels.
constexpr double kLeastKnown = 0.5;

// Weighted mean over the matches that look alike and are not beyond doubt, and its variance: infinite if
// there are none.
struct MeanShift {
  double shift, variance;
};

MeanShift uncertainShift(const std::vector<ShiftMatch>& matches) {
  double sum = 0, weights = 0;
  for (const ShiftMatch& match : matches) {
    if (match.certain || !match.alike) continue;
    const double weight = 1 / (match.stddev * match.stddev);
    sum += weight * match.shift;
    weights += weight;
  }
  return {weights > 0 ? sum / weights : 0, 1 / weights};
}

}  // namespace

BlockDisparities::BlockDisparities(const StereoLevel& level, int factor)
    : factor_(factor), rig_(level.rig), blocks_(level.left_mask, level.right_mask) {}

void BlockDisparities::choose(const cv::Mat& left, const Eigen::Vector3d& g) {
  response_ = 1;
  blocks_.choose(left, rig_, ShiftModel(rig_, g), kBlocks);
}

DisparitySample BlockDisparities::inWholeImages(double u, double v, double stddev, double disparity) const {
  return {fromCoarse(u, factor_), fromCoarse(v, factor_), factor_ * stddev, factor_ * disparity};
}

void BlockDisparities::measure(const cv::Mat& right, const Eigen::Vector3d& g, const RigRotation& rows) {
  const ShiftModel shift(rig_, g);
  blocks_.compare(right, shift, matches_);
  convert(shift, rows);
}

void BlockDisparities::measureResponse(const cv::Mat& right, const Eigen::Vector3d& g,
                                       const RigRotation& rows) {
  response_ = responseAround(right, g);
  convert(ShiftModel(rig_, g), rows);
}

void BlockDisparities::convert(const ShiftModel& shift, const RigRotation& rows) {
  const double density = 1 - shift.a;  // of right pixels over left ones
  disparities_.clear();
  for (const PhotometricBlocks::Match& match : matches_) {
    const double response = match.certain ? 1 : response_;
    // Of noise, an error would be cut off together with what is cut for being too far.
    if (response < 1 && !(match.stddev < kLeastKnown * response)) continue;
    // The right pixel that the warp puts on u belongs to the left pixel u + shift. Said of u itself, as a
    // place that has the error of the shift in it would pull the plane.
    const double by_shift = density / response, by_row = -by_shift * match.lean;
    const double disparity = shift.at(match.u, match.v) + match.shift * by_shift - rig_.principalOffset();
    const double column = match.u - shift.at(match.u, match.v);
    const Eigen::RowVector3d leak = by_row * verticalDisparityByRotation(rig_, column, match.v);
    disparities_.push_back(
        {inWholeImages(match.u, match.v, by_shift * match.stddev, disparity - leak.dot(rows.w)),
         factor_ * leak, factor_ * factor_ * match.blocks,
         match.alike && std::abs(match.shift) < kLargestShift});
  }
}

// By what they show of half a pixel, from a quarter before the plane to a quarter behind.
double BlockDisparities::responseAround(const cv::Mat& right, const Eigen::Vector3d& g) {
  constexpr double kQuarter = 0.25;  // pixels
  constexpr double kSigmas = 4;
  const Eigen::Vector3d quarter(0, 0, kQuarter / rig_.fb());
  std::vector<PhotometricBlocks::Match> moved;
  blocks_.compare(right, ShiftModel(rig_, g - quarter), moved);
  const MeanShift before = uncertainShift(moved);
  blocks_.compare(right, ShiftModel(rig_, g + quarter), moved);
  const MeanShift behind = uncertainShift(moved);
  const double density = 1 - ShiftModel(rig_, g).a;
  const double response = density * (before.shift - behind.shift) / (2 * kQuarter);
  const double variance = density * density * (before.variance + behind.variance) / (4 * kQuarter * kQuarter);
  return response > kSigmas * std::sqrt(variance) ? std::min(response, 1.0) : 0;
}

double BlockDisparities::certainShare() const {
  int certain = 0, all = 0;
  for (const PhotometricBlocks::Match& match : matches_) {
    all += match.blocks;
    if (match.certain) certain += match.blocks;
  }
  return all > 0 ? static_cast<double>(certain) / all : 0;
}

}  // namespace uav_landing
