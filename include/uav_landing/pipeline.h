#pragma once

#include <optional>
#include <string>
#include <vector>

#include "uav_landing/parameters/parameters.h"
#include "uav_landing/stages/approach_angle_stage.h"
#include "uav_landing/stages/kalman_height_stage.h"
#include "uav_landing/stages/stereo_depth_stage.h"

namespace uav_landing {

/// The whole chain, for one pair after another, as the nodelets run it.
class Pipeline {
 public:
  /// left, right: the cameras that workingPair() returns (geometry/camera_pair.h). With upside_down it
  /// exchanges them, and process() has to get the images exchanged as well. Fails when parameters.rig does
  /// not accept the cameras, or when a mask that it names cannot be used.
  static Expected<Pipeline> create(const CameraCalibration& left, const CameraCalibration& right,
                                   const Parameters& parameters);

  struct Output {
    cv::Mat left, right;  ///< rectified; views of buffers that the next call reuses
    StereoDepthResult stereo;
    ApproachAngleResult approach;
    LandingResult landing;
    Timings parts;   ///< of the parts of all stages
    Timings stages;  ///< of the stages: rectify, stereo_depth, approach_angle, kalman_height
  };
  /// left, right: raw mono8 of the size that the calibrations announce. With another size all results are
  /// failures. stamp: of the left image, s. skew: stamp of the right image minus that of the left one, s.
  /// imu: of this pair.
  const Output& process(double stamp, const cv::Mat& left, const cv::Mat& right, double skew = 0,
                        const AttitudePrior& imu = {});

  const RigModel& rig() const { return rig_; }
  /// Warnings about the calibrations (see rigWarnings()).
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  Pipeline(RigModel rig, Rectifier left, Rectifier right, const Parameters& parameters);
  Failure rectify(const cv::Mat& left, const cv::Mat& right);
  void addTimings(const char* stage, const Timings& parts);

  RigModel rig_;
  std::vector<std::string> warnings_;
  Rectifier left_rectifier_, right_rectifier_;
  StereoDepthStage stereo_;
  ApproachAngleStage approach_;
  KalmanHeightStage kalman_;
  Output output_;
};

}  // namespace uav_landing
