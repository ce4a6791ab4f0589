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
  const double density = 1 - shift.a;  // of right pixels over left ones
  disparities_.clear();
  for (const PhotometricBlocks::Match& match : matches_) {
    const double response = match.certain ? 1 : response_, found = match.shift / response;
    // The right pixel that the warp puts on u belongs to the left pixel u + shift. Said of u itself, as a
    // place that has the error of the shift in it would pull the plane.
    const double disparity = shift.at(match.u, match.v) + found * density - rig_.principalOffset();
    const double column = match.u - shift.at(match.u, match.v);
    const Eigen::RowVector3d leak =
        -density * match.lean * verticalDisparityByRotation(rig_, column, match.v);
    disparities_.push_back(
        {inWholeImages(match.u, match.v, density * match.stddev / response, disparity - leak.dot(rows.w)),
         factor_ * leak, factor_ * factor_ * match.blocks, match.alike && std::abs(found) < kLargestShift});
  }
}

double BlockDisparities::meanUncertainShift() const {
  double sum = 0, weights = 0;
  for (const PhotometricBlocks::Match& match : matches_) {
    if (match.certain || !match.alike) continue;
    const double weight = 1 / (match.stddev * match.stddev);
    sum += weight * match.shift;
    weights += weight;
  }
  return weights > 0 ? sum / weights : 0;
}

void BlockDisparities::measureResponse(const cv::Mat& right, const Eigen::Vector3d& g,
                                       const RigRotation& rows) {
  constexpr double kShift = 0.5;  // pixels
  constexpr double kLeast = 0.1;
  const double here = meanUncertainShift();
  measure(right, g + Eigen::Vector3d(0, 0, kShift / rig_.fb()), rows);
  response_ = std::clamp((here - meanUncertainShift()) / kShift, kLeast, 1.0);
  measure(right, g, rows);
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
