#pragma once

#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "image_input.h"
#include "imu_input.h"
#include "offline/processed_pair.h"
#include "picture_watch.h"
#include "uav_landing/geometry/camera_pair.h"
#include "uav_landing/parameters/parameters.h"

namespace uav_landing {

/// Runs the chain on image pairs as they come, for the sinks. It is built from the first camera_infos, and
/// again when they change.
class OfflineChain {
 public:
  /// camera: namespace, for messages.
  /// with_imu: messages of an inertial sensor will come, and pairs wait for them.
  /// complain: gets what the user should know, once per problem.
  OfflineChain(const Parameters& parameters, const std::string& camera, bool with_imu,
               std::vector<std::unique_ptr<PairSink>>& sinks,
               std::function<void(const std::string&)> complain);

  /// Takes a pair. It waits for the imu message after it, as in the nodelets. Left and right are exchanged
  /// here when the rig is mounted upside down.
  void process(const sensor_msgs::ImageConstPtr& left, const sensor_msgs::CameraInfoConstPtr& left_info,
               const sensor_msgs::ImageConstPtr& right, const sensor_msgs::CameraInfoConstPtr& right_info);
  void addTransforms(const tf2_msgs::TFMessage& static_transforms);
  /// imu_topic: for messages.
  void addImu(const sensor_msgs::Imu& message, const std::string& imu_topic);
  /// Processes the pairs that still wait.
  void finish();

  std::size_t pairs() const { return pairs_; }
  std::size_t unusable() const { return unusable_; }
  /// Pairs that were skipped because they repeat the images of the previous one.
  uint64_t repetitions() const { return pictures_.repetitions(); }
  const Failure& firstProblem() const { return first_problem_; }

 private:
  struct Waiting {
    sensor_msgs::ImageConstPtr left, right;
    sensor_msgs::CameraInfoConstPtr left_info, right_info;
  };
  void complainOfImu(const std::string& problem);
  void release(bool all);
  void process(const Waiting& pair);
  void followCalibration(const CameraCalibration& left, const CameraCalibration& right,
                         const ros::Time& stamp);
  Failure startWith(const CameraCalibration& left, const CameraCalibration& right);
  Failure run(const sensor_msgs::ImageConstPtr& left, const sensor_msgs::ImageConstPtr& right, double skew,
              const AttitudePrior& imu);
  void report(const Failure& problem, const ros::Time& stamp);
  void sayOnce(const Failure& problem, const ros::Time& stamp);

  Parameters parameters_;
  std::string camera_;
  std::vector<std::unique_ptr<PairSink>>& sinks_;
  std::function<void(const std::string&)> complain_;
  CameraCalibration left_calibration_, right_calibration_;  // as given
  CameraPair working_;
  PairGreyRange range_;
  std::optional<Pipeline> pipeline_;
  std::optional<ImuInput> imu_;  // none: not used
  std::deque<Waiting> waiting_;
  PictureWatch pictures_;
  std::string last_imu_complaint_;
  Failure calibration_failure_;
  const Pipeline::Output* output_ = nullptr;
  std::size_t pairs_ = 0, unusable_ = 0;
  Failure first_problem_;
  std::string last_complaint_;
};

}  // namespace uav_landing
