#pragma once

#include <Eigen/Core>
#include <vector>

namespace uav_landing {

/// Errors that vibration makes in single images of a rolling shutter. The angle of a movement from one image
/// to another has the error of the last image minus that of the first, over its duration. So the error of an
/// image is an angle times a time, rad s.
class ImageErrors {
 public:
  /// Adds a measurement: the angle of a movement between the images of these stamps, s.
  void add(double from, double to);
  /// Covariances of the measurements for errors of 1 rad s, 1/s^2.
  struct Covariances {
    Eigen::MatrixXd single;  ///< each image has an error of its own
    /// Images that follow each other have similar errors. Vibration near a multiple of the frame rate does
    /// that, as all images see it in nearly the same phase.
    Eigen::MatrixXd similar;
  };
  Covariances covariances() const;

 private:
  struct Movement {
    size_t from, to;  // images
    double duration;  // s
  };
  size_t imageAt(double stamp);
  Eigen::MatrixXd derivatives() const;  // of the measurements by the errors, 1/s

  std::vector<double> stamps_;  // of the images
  std::vector<Movement> movements_;
};

}  // namespace uav_landing
