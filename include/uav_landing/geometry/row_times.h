#pragma once

#include <Eigen/Core>
#include <deque>
#include <vector>

#include "uav_landing/base/failure.h"
#include "uav_landing/geometry/calibration.h"
#include "uav_landing/parameters/rig_parameters.h"

namespace uav_landing {

/// Describes how a camera reads its raw images, as the driver delivers them. A raw row v of `rows` is exposed
/// at
///   t(v) = stamp + ((v + 1/2) / rows - stamp_row) time.
struct Readout {
  double time = 0;         ///< s, from the first line to the last; negative: the last one comes first
  double stamp_row = 0.5;  ///< exposed at the stamp: 0 the first line, 1 the last
  RowDirection direction = RowDirection::kRows;
};

/// Readout by the parameters, for the left and the right camera that the stages work with (see
/// workingPair()). In a rig that is mounted upside down, the left one is the camera that is named right. A
/// time that is not given counts as 0.
Readout leftReadout(const RigParameters& parameters);
Readout rightReadout(const RigParameters& parameters);
/// A readout of 1 s when no time is given. It shows the effect of the unknown time, and the order of the
/// rows. Otherwise a global shutter.
Readout unknownReadout(const RigParameters& parameters);

/// Times between which the rows of the left camera are exposed, s since the stamp; both 0: all at once.
struct RowSpan {
  double first = 0, last = 0;

  bool atOnce() const { return first == last; }
};
/// By the parameters. A readout time that is not given counts as 0.
RowSpan leftRowSpan(const RigParameters& parameters);

/// Tells when the pixels of a rectified image are exposed. Lens, rectification, ROI and binning lead from a
/// pixel to its raw row. In a rig that is mounted upside down the first row is at the bottom. The default is
/// a global shutter.
class RowTimes {
 public:
  RowTimes() = default;
  /// calibration: must have been checked.
  RowTimes(const CameraCalibration& calibration, const Readout& readout);

  /// True for a global shutter: nothing has to be carried to the stamp.
  bool atOnce() const { return time_ == 0; }
  /// Time from the stamp to the exposure of a rectified pixel, s.
  double at(double u, double v) const { return atOnce() ? 0 : time_ * shareAt(u, v); }
  /// (t0, tu, tv) of the plane t0 + tu u + tv v that fits these times best; s, s/px, s/px.
  const Eigen::Vector3d& plane() const { return plane_; }
  /// Time from the first line to the last, s; negative when the last one comes first.
  double readoutTime() const { return time_; }

 private:
  double shareAt(double u, double v) const;

  double time_ = 0;
  int columns_ = 0, rows_ = 0;  // of the grid
  std::vector<float> shares_;   // of the readout time, at the nodes of a grid over the rectified image
  Eigen::Vector3d plane_ = Eigen::Vector3d::Zero();
};

/// Delay of the right camera's rows after the left one's, s. size: of the rectified images. When only lenses
/// and rectification make a difference, as in any rig, the delay is that in the middle. Otherwise it is the
/// largest one.
double laterRows(const RowTimes& left, const RowTimes& right, const cv::Size& size);

/// Refuses a readout time that is longer than the time between the images. Such a time is in other units, or
/// belongs to another mode of the sensor.
class ReadoutCheck {
 public:
  explicit ReadoutCheck(const RowTimes& times, const RowTimes& right);
  /// Call it with the stamps of the pairs, in their order, s.
  Failure follow(double stamp);
  void reset() { stamps_.clear(); }

 private:
  double longest_;             // readout time of either camera, s
  std::deque<double> stamps_;  // the last stamps
};

}  // namespace uav_landing
