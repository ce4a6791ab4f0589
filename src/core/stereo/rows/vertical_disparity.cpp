#include "stereo/rows/vertical_disparity.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>

#include "base/thinned.h"
#include "image/input/image_check.h"
#include "image/windows/patch_matching.h"
#include "image/windows/patch_refiner.h"
#include "kernels/image/slanted_row.h"
#include "rig/rig_rotation.h"
#include "stereo/matching/shift_model.h"
#include "stereo/rows/row_fit.h"

namespace uav_landing {
namespace {

using row_fit::RowFit;
using row_fit::RowShift;

constexpr size_t kSearched = 80;  // corners
// Error of a row that residuals do not show, pixels.
constexpr double kStddevFloor = 0.04;
constexpr double kMinScore = 0.8;

// A corner with its disparity: as matched along the row, or as the plane predicts it.
struct PlacedCorner {
  cv::Point corner;
  double disparity;
  bool matched;
  std::optional<RowRefinement::Across> across;
};

std::vector<PlacedCorner> placed(const StereoRig& rig, const std::vector<cv::Point>& corners,
                                 const RowMatches& matches, const PlaneVector& g) {
  std::vector<PlacedCorner> all;
  all.reserve(corners.size());
  size_t next = 0;
  for (const cv::Point& corner : corners) {
    const bool matched = next < matches.samples.size() && matches.samples[next].u == corner.x &&
                         matches.samples[next].v == corner.y;
    if (matched) {
      all.push_back({corner, matches.samples[next].disparity, true, matches.across[next]});
      ++next;
    } else {
      all.push_back({corner, g.disparity(rig, corner.x, corner.y), false, std::nullopt});
    }
  }
  return all;
}

// Place in the right image of the window around a corner, looked for from start on.
RowRefinement::Across lookAcross(const StereoLevel& level, const cv::Point& corner,
                                 const Eigen::Vector2d& start, const Eigen::Matrix2d& warp, int radius) {
  return RowRefinement::Across(
      refinePatch(level.left, level.right, {corner.x, corner.y, radius}, {start, warp}));
}

// Only ground has the disparity of the plane. An object on it is found beside that place or not at all.
bool isBeside(const RowRefinement::Across& found, double column) {
  constexpr double kSigmas = 3, kPlane = 0.1;  // kPlane: error of the plane's disparity, pixels
  const double off = found.place.x() - column;
  return off * off > kSigmas * kSigmas * (found.column_variance + kPlane * kPlane);
}

// disparity: of the corner, as known so far. False when the corner has no usable row.
bool addRow(const StereoRig& rig, const cv::Point& corner, double disparity,
            const RowRefinement::Across& across, std::vector<RowShift>& rows) {
  if (!across.found || across.score < kMinScore) return false;
  RowShift row;
  row.by << verticalDisparityByRotation(rig, across.place.x(), across.place.y()),
      verticalDisparityByBaseline(rig, disparity, corner.y);
  row.shift = across.place.y() - corner.y;
  row.stddev = std::sqrt(across.row_variance + kStddevFloor * kStddevFloor);
  row.below_centre = corner.y - rig.cy;
  row.cell = imageCell(rig, corner.x, corner.y);
  rows.push_back(row);
  return true;
}

Expected<RigRotation> fitRotation(const std::vector<RowShift>& rows) {
  const Expected<RowFit<3>> fit = row_fit::fitRows<3>(rows);
  if (!fit) return tl::make_unexpected(fit.error());
  return RigRotation{fit->value, fit->covariance + row_fit::sharedVariance<3>(rows, *fit), fit->count};
}

BaselineDirection fitBaseline(const std::vector<RowShift>& rows) {
  // Error of lens or texture that all corners in a cell of the image share, pixels.
  constexpr double kCommon = 0.1;
  // 1 sigma of the ratio of the right focal length to the left one after a calibration.
  constexpr double kFocal = 0.0015;
  const Expected<RowFit<5>> fit = row_fit::fitRows<5>(rows);
  if (!fit) return {};
  const Eigen::Matrix<double, 5, 5> covariance = fit->covariance + row_fit::sharedVariance<5>(rows, *fit) +
                                                 row_fit::commonVariance<5>(rows, *fit, kCommon) +
                                                 row_fit::focalVariance<5>(rows, *fit, kFocal);
  return {fit->value.tail<2>(), covariance.bottomRightCorner<2, 2>()};
}

cv::Mat levelled(const StereoRig& rig, const Eigen::Vector3d& w, const cv::Mat& right, cv::Mat& buffer) {
  if (w.isZero()) return right;
  straightenRows(rig, w, right, buffer);
  return buffer;
}

}  // namespace

VerticalDisparities measureVerticalDisparities(const StereoLevel& level,
                                               const std::vector<cv::Point>& corners,
                                               const RowMatches& matches, const PlaneVector& g,
                                               int window_radius) {
  const Eigen::Matrix2d warp = ShiftModel(level.rig, g).forward().matrix();
  const std::vector<PlacedCorner> some = thinned(placed(level.rig, corners, matches, g), kCornersAcross);
  std::vector<RowShift> rows;
  rows.reserve(some.size());
  int matched = 0, again = 0;
  for (const PlacedCorner& at : some) {
    const Eigen::Vector2d start(at.corner.x - at.disparity - level.rig.principalOffset(), at.corner.y);
    if (!at.matched && !isSet(level.right_mask, start.x(), at.corner.y)) continue;
    const RowRefinement::Across across =
        at.across ? *at.across : lookAcross(level, at.corner, start, warp, window_radius);
    if (!at.matched && across.found && isBeside(across, start.x())) continue;
    const bool found = addRow(level.rig, at.corner, at.disparity, across, rows);
    matched += at.matched ? 1 : 0;
    again += at.matched && found ? 1 : 0;
  }
  VerticalDisparities measured;
  if (matched > 0) measured.agreement = static_cast<double>(again) / matched;
  measured.rotation = fitRotation(rows);
  measured.baseline = fitBaseline(rows);
  return measured;
}

Expected<RigRotation> searchVerticalDisparities(const StereoLevel& level,
                                                const std::vector<cv::Point>& corners, const PlaneVector& g,
                                                int window_radius) {
  constexpr int kSteps = 4;  // a peak at the end of the range does not count
  const Eigen::Matrix2d warp = ShiftModel(level.rig, g).forward().matrix();
  const std::vector<cv::Point> some = thinned(corners, kSearched);
  PatchSearch search(level.left, level.right, window_radius);
  std::vector<RowShift> rows;
  rows.reserve(some.size());
  for (const cv::Point& corner : some) {
    const double disparity = g.disparity(level.rig, corner.x, corner.y);
    const Eigen::Vector2d predicted(corner.x - disparity - level.rig.principalOffset(), corner.y);
    const PatchSearch::Best best = search.run(corner.x, corner.y, predicted, warp, kSteps);
    if (best.found)
      addRow(level.rig, corner, disparity, lookAcross(level, corner, best.position, warp, window_radius),
             rows);
  }
  return fitRotation(rows);
}

double largestVerticalDisparity(const StereoRig& rig, const Eigen::Vector3d& w) {
  double largest = 0;
  for (const double column : {0.0, rig.cx_right, rig.size.width - 1.0})
    for (const double v : {0.0, rig.cy, rig.size.height - 1.0})
      largest = std::max(largest, std::abs(verticalDisparityByRotation(rig, column, v).dot(w)));
  return largest;
}

void straightenRows(const StereoRig& rig, const Eigen::Vector3d& w, const cv::Mat& right, cv::Mat& out,
                    const cv::Range& rows) {
  out.create(right.size(), CV_32F);
  const cv::Range wanted = rows == cv::Range::all() ? cv::Range(0, out.rows) : rows;
  for (int v = wanted.start; v < wanted.end; ++v) {
    // The vertical disparity is linear in the column.
    const double first = v + verticalDisparityByRotation(rig, 0, v).dot(w);
    const double last = v + verticalDisparityByRotation(rig, out.cols - 1, v).dot(w);
    sampleSlantedRow(right, {first, (last - first) / (out.cols - 1)}, out.ptr<float>(v));
  }
}

Eigen::Matrix3d rowLeak(const StereoRig& rig, const RigRotation& residual, const PlaneVector& g) {
  constexpr double kLean = 2.5;  // rms of the lean of lines, over simulated runways
  const double slope = g.vector().y();
  const Eigen::Vector3d squares = residual.w.array().square() + residual.covariance.diagonal().array();
  Eigen::Matrix3d leak = Eigen::Matrix3d::Zero();
  leak(0, 0) = squares.x() * std::pow(kLean / rig.baseline, 2) + squares.z() * slope * slope;
  leak(2, 2) = squares.x() * slope * slope;
  return leak;
}

cv::Mat RowAlignment::level(const StereoRig& rig, const cv::Mat& right, cv::Mat& buffer) const {
  return levelled(rig, taken_out_, right, buffer);
}

cv::Mat RowAlignment::levelAgain(const StereoRig& rig, const cv::Mat& right, cv::Mat& buffer) const {
  return levelled(rig, levelled_by_, right, buffer);
}

bool RowAlignment::search(const StereoLevel& level, const std::vector<cv::Point>& corners,
                          const PlaneVector& g) {
  if (!enabled_) return false;
  const Expected<RigRotation> found = searchVerticalDisparities(level, corners, g, window_radius_);
  return found && adapt(level.rig, *found);
}

RowAlignment::Measured RowAlignment::measure(const StereoLevel& level, const std::vector<cv::Point>& corners,
                                             const RowMatches& matches, const PlaneVector& g) {
  if (!enabled_) return {};
  levelled_by_ = taken_out_;
  const VerticalDisparities found = measureVerticalDisparities(level, corners, matches, g, window_radius_);
  Measured measured{{}, found.baseline, found.agreement};
  if (!found.rotation) return measured;
  measured.rotation = *found.rotation;
  measured.rotation.w += taken_out_;
  average(measured.rotation);
  adapt(level.rig, *found.rotation);
  return measured;
}

void RowAlignment::average(const RigRotation& measured) {
  constexpr double kKept = 0.95;  // a pair's weight falls by this factor with each later pair
  const Eigen::Matrix3d weight = measured.covariance.inverse();
  information_ = kKept * information_ + weight;
  right_ = kKept * right_ + weight * measured.w;
  measured_ = true;
}

RigRotation RowAlignment::residual(const StereoRig& rig) const {
  // Largest chi-square (3 degrees of freedom) with which the calibration can be as good as claimed.
  constexpr double kBelievable = 16;
  constexpr double kExact = 1e-6;  // pixels
  const Eigen::Vector3d variances =
      lensVariances(rig, row_bias_stddev_).array() + std::pow(std::max(bias_stddev_, kExact) / rig.fy, 2);
  const Eigen::Matrix3d calibrated = variances.asDiagonal();
  RigRotation residual{Eigen::Vector3d::Zero(), calibrated};
  if (measured_) {
    Eigen::Matrix3d prior = calibrated.inverse();
    const Eigen::Matrix3d alone = information_.inverse();
    const Eigen::Vector3d w = alone * right_;
    const Eigen::Matrix3d both = alone + calibrated;
    if (w.dot(both.inverse() * w) > kBelievable) prior.setZero();
    residual.covariance = (information_ + prior).inverse();
    residual.w = residual.covariance * right_;
  }
  if (measured_) residual.w -= levelled_by_;
  return residual;
}

bool RowAlignment::adapt(const StereoRig& rig, const RigRotation& residual) {
  // Vertical disparities up to this (pixels) do not disturb the matching along rows, and straightening takes
  // time.
  constexpr double kStraightEnough = 0.5;
  // From this chi-square on (3 degrees of freedom) a residual is not noise.
  constexpr double kSignificant = 30;
  // What looks like ry mostly is the residual of a lens, and extrapolating it would do harm.
  const Eigen::Vector3d w(residual.w.x(), 0, residual.w.z());
  if (largestVerticalDisparity(rig, w) < kStraightEnough) return false;
  if (residual.w.dot(residual.covariance.inverse() * residual.w) < kSignificant) return false;
  taken_out_ += w;
  if (largestVerticalDisparity(rig, taken_out_) < kStraightEnough) taken_out_.setZero();
  return true;
}

}  // namespace uav_landing
