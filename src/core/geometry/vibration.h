#pragma once

namespace uav_landing {

/// Vibration of the camera while the rows of an image are exposed: a random rotation about each axis, similar
/// at times that are close. No sensor measured it. Its size comes from the difference of two images.
struct Vibration {
  double stddev = 0;  ///< rad, the mean of three axes; 0: none. One axis may have all of it.
  double cycles = 0;  ///< in one readout, known to a third

  bool found() const { return stddev > 0; }
  /// Covariance of the rotations of one axis at two times, over their variance. apart: the time between them,
  /// as a share of the readout.
  double alike(double apart) const;
};

}  // namespace uav_landing
