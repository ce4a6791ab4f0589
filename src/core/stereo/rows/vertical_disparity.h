#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "stereo/matching/corner_matching.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// What the rows of corners show of the right camera. They do not depend on the ground: no plane or
/// height enters.
struct VerticalDisparities {
  /// See rig_rotation.h: rx and rz well, ry weakly. Fails when fewer than 20 corners have a row.
  Expected<RigRotation> rotation;
  /// The rotation is fitted with it once more. Its covariance has in it what lenses and focal lengths are
  /// wrong by after a calibration. Unknown with fewer corners as well.
  BaselineDirection baseline;
  /// Share of the matched corners whose row was found; NaN when there are none.
  double agreement = kUnknown;
};

/// corners: all that were looked for along the rows; matches: those of them that were found, in the same
/// order. The right row of a few of the corners is known to sub-pixel by the matches, or is measured (gain
/// and offset free, within 2 rows); then the rotation and the direction of the baseline are fitted with
/// redescending weights. Those that were not found count where the plane g (1/m) has them: found are the ones
/// that noise happens to keep in their rows, and by them alone rows seem to move by less than they do. g
/// tells as well how windows of this radius are sheared.
VerticalDisparities measureVerticalDisparities(const StereoLevel& level,
                                               const std::vector<cv::Point>& corners,
                                               const RowMatches& matches, const Eigen::Vector3d& g,
                                               int window_radius);

/// The rotation with nothing matched yet: looks for corners around the places that a rough plane predicts,
/// within 3 columns and 3 rows of whole pixels first.
Expected<RigRotation> searchVerticalDisparities(const StereoLevel& level,
                                                const std::vector<cv::Point>& corners,
                                                const Eigen::Vector3d& g, int window_radius);

/// Largest vertical disparity in the image of a rotation w, pixels.
double largestVerticalDisparity(const StereoRig& rig, const Eigen::Vector3d& w);

/// Takes the vertical disparities of w out of the right image: its rows then match the left image's. Columns
/// are not moved, so that disparities keep what w does to them. right: CV_32F, of the rig's size. rows: those
/// of out that are wanted, others hold anything.
void straightenRows(const StereoRig& rig, const Eigen::Vector3d& w, const cv::Mat& right, cv::Mat& out,
                    const cv::Range& rows = cv::Range::all());

/// Covariance, 1/m^2, that vertical disparities of the residual rotation add to a plane g fitted to corners,
/// by a rule of thumb. Where a row is off by dv, a slanted line seems moved along the row by dv times its
/// slope; the two sides of a runway lean to opposite sides, which looks like roll; and it shows ground that
/// is nearer or farther.
Eigen::Matrix3d rowLeak(const StereoRig& rig, const RigRotation& residual, const Eigen::Vector3d& g);

/// Keeps the right image's rows level with the left image's from pair to pair, so that a bent rig still
/// matches along rows, and measures what it bends by.
class RowAlignment {
 public:
  /// enabled: false leaves the images as they are and measures nothing. bias_stddev, row_bias_stddev: to what
  /// the calibration of the cameras and of their lenses is good, pixels, the latter in the middle of the
  /// image.
  RowAlignment(bool enabled, int window_radius, double bias_stddev, double row_bias_stddev)
      : enabled_(enabled),
        window_radius_(window_radius),
        bias_stddev_(bias_stddev),
        row_bias_stddev_(row_bias_stddev) {}

  /// The right image (CV_32F, at the rig's resolution) with its rows made level, in buffer, or itself when
  /// they are.
  cv::Mat level(const StereoRig& rig, const cv::Mat& right, cv::Mat& buffer) const;
  /// The same as level() gave of the pair measured last, although that may have taught it better.
  cv::Mat levelAgain(const StereoRig& rig, const cv::Mat& right, cv::Mat& buffer) const;
  bool isLevel() const { return taken_out_.isZero(); }
  /// Looks for the rows of corners with a rough plane. True when level() now gives another image.
  bool search(const StereoLevel& level, const std::vector<cv::Point>& corners, const Eigen::Vector3d& g);
  struct Measured {
    RigRotation rotation;
    BaselineDirection baseline;
    /// Share of the corners matched along the rows that are found when they may move across the rows as well.
    /// Wrong matches mostly are not. NaN when nothing was measured.
    double agreement = kUnknown;
  };
  /// By the rows of the corners (see measureVerticalDisparities); adapts level() for the next pair. The level
  /// is one whose right image is from level().
  Measured measure(const StereoLevel& level, const std::vector<cv::Point>& corners, const RowMatches& matches,
                   const Eigen::Vector3d& g);
  /// What vertical disparities the pair measured last has after level(): averaged over the last twenty pairs
  /// or so, with what the calibration leads to expect, as long as the two do not contradict each other.
  RigRotation residual(const StereoRig& rig) const;
  /// What level() has taken out of the pair measured last, rad.
  const Eigen::Vector3d& levelledBy() const { return levelled_by_; }
  void reset() { *this = RowAlignment(enabled_, window_radius_, bias_stddev_, row_bias_stddev_); }

 private:
  bool adapt(const StereoRig& rig, const RigRotation& residual);
  void average(const RigRotation& measured);

  bool enabled_;
  int window_radius_;
  double bias_stddev_, row_bias_stddev_;                 // pixels
  Eigen::Vector3d taken_out_ = Eigen::Vector3d::Zero();  // w of which the rows are freed, rad
  // Of the sum of what is taken out and what is left, old pairs forgotten.
  Eigen::Matrix3d information_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d levelled_by_ =
      Eigen::Vector3d::Zero();  // what was taken out of the pair measured last, rad
  bool measured_ = false;
};

}  // namespace uav_landing
