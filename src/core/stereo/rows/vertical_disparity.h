#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "geometry/plane_vector.h"
#include "stereo/matching/corner_matching.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// What the rows of corners tell about the right camera. The ground does not matter: no plane or height
/// enters.
struct VerticalDisparities {
  /// See rig_rotation.h: rx and rz are known well, ry weakly. Fails when fewer than 20 corners have a row.
  Expected<RigRotation> rotation;
  /// Direction of the baseline, from a second fit together with the rotation. Its covariance contains usual
  /// errors of lenses and focal lengths after a calibration. Unknown when too few corners have a row.
  BaselineDirection baseline;
  /// Share of the matched corners whose row was found; NaN without matched corners.
  double agreement = kUnknown;
};

/// Fits the rotation and the baseline's direction to the rows of corners, with redescending weights. corners:
/// all that were looked for along the rows. matches: those that were found, in the same order. Some matches
/// already have a sub-pixel row in the right image; others are measured (blind to gain and offset, within 2
/// rows). g: the plane, 1/m, which tells how windows of this radius are sheared.
/// Corners without a match take part at the places where the plane has them. Found corners are those that
/// noise happens to keep in their rows, so by them alone the rows would seem to move too little.
VerticalDisparities measureVerticalDisparities(const StereoLevel& level,
                                               const std::vector<cv::Point>& corners,
                                               const RowMatches& matches, const PlaneVector& g,
                                               int window_radius);

/// The rotation when nothing is matched yet. It looks for corners around the places predicted by a rough
/// plane g (1/m), first within 3 columns and 3 rows of whole pixels.
Expected<RigRotation> searchVerticalDisparities(const StereoLevel& level,
                                                const std::vector<cv::Point>& corners, const PlaneVector& g,
                                                int window_radius);

/// Largest vertical disparity in the image that a rotation w (rad) makes, pixels.
double largestVerticalDisparity(const StereoRig& rig, const Eigen::Vector3d& w);

/// Removes the vertical disparities of the rotation w (rad) from the right image, so that its rows match
/// those of the left image. Columns do not move, so disparities keep the effect of w. right: CV_32F, of the
/// rig's size. rows: those of out that are wanted; the others hold anything.
void straightenRows(const StereoRig& rig, const Eigen::Vector3d& w, const cv::Mat& right, cv::Mat& out,
                    const cv::Range& rows = cv::Range::all());

/// Covariance, 1/m^2, that vertical disparities by the residual rotation add to a plane g fitted to corners.
/// It is a rule of thumb with two effects. When a row is off by dv, a slanted line seems to move along the
/// row by dv times its slope; the two sides of a runway lean to opposite sides, which looks like roll. The
/// row also shows ground that is nearer or farther.
Eigen::Matrix3d rowLeak(const StereoRig& rig, const RigRotation& residual, const PlaneVector& g);

/// Keeps the rows of the right image level with those of the left image from pair to pair. So a bent rig
/// still matches along rows, and its bend is measured.
class RowAlignment {
 public:
  /// enabled: when false, images stay as they are and nothing is measured. bias_stddev, row_bias_stddev: 1
  /// sigma of the calibration of the cameras and of their lenses, pixels, the latter in the middle of the
  /// image.
  RowAlignment(bool enabled, int window_radius, double bias_stddev, double row_bias_stddev)
      : enabled_(enabled),
        window_radius_(window_radius),
        bias_stddev_(bias_stddev),
        row_bias_stddev_(row_bias_stddev) {}

  /// The right image (CV_32F, at the rig's resolution) with level rows, in buffer. It is the image itself
  /// when its rows already are level.
  cv::Mat level(const StereoRig& rig, const cv::Mat& right, cv::Mat& buffer) const;
  /// The same as level() for the pair measured last, even if measure() has changed level() since.
  cv::Mat levelAgain(const StereoRig& rig, const cv::Mat& right, cv::Mat& buffer) const;
  bool isLevel() const { return taken_out_.isZero(); }
  /// Looks for the rows of corners with a rough plane g (1/m). True when level() now gives another image.
  bool search(const StereoLevel& level, const std::vector<cv::Point>& corners, const PlaneVector& g);
  struct Measured {
    RigRotation rotation;
    BaselineDirection baseline;
    /// Share of the corners matched along the rows that are found again when they may leave the row. Wrong
    /// matches mostly are not found. NaN when nothing was measured.
    double agreement = kUnknown;
  };
  /// Measures the rows of the corners (see measureVerticalDisparities()) and adapts level() for the next
  /// pair. The right image of the given level must come from level().
  Measured measure(const StereoLevel& level, const std::vector<cv::Point>& corners, const RowMatches& matches,
                   const PlaneVector& g);
  /// The vertical disparities that remain after level() in the pair measured last, averaged over about twenty
  /// pairs. The claimed calibration is the prior, unless it contradicts this average.
  RigRotation residual(const StereoRig& rig) const;
  /// The rotation that level() has removed from the pair measured last, rad.
  const Eigen::Vector3d& levelledBy() const { return levelled_by_; }
  void reset() { *this = RowAlignment(enabled_, window_radius_, bias_stddev_, row_bias_stddev_); }

 private:
  bool adapt(const StereoRig& rig, const RigRotation& residual);
  void average(const RigRotation& measured);

  bool enabled_;
  int window_radius_;
  double bias_stddev_, row_bias_stddev_;                 // pixels
  Eigen::Vector3d taken_out_ = Eigen::Vector3d::Zero();  // w that level() removes, rad
  // Sums for the rotation, removed and remaining together; old pairs fade.
  Eigen::Matrix3d information_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d levelled_by_ = Eigen::Vector3d::Zero();  // removed from the pair measured last, rad
  bool measured_ = false;
};

}  // namespace uav_landing
