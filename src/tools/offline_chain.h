#pragma once

#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "processed_pair.h"

namespace uav_landing {

/// Runs the chain on image pairs as they come, for the sinks. Builds it from the first camera_infos, and anew
/// when they change.
class OfflineChain {
 public:
  /// camera: namespace, for messages. complain: takes what the user should know, once per problem.
  OfflineChain(const Parameters& parameters, const std::string& camera,
               std::vector<std::unique_ptr<PairSink>>& sinks,
               std::function<void(const std::string&)> complain);

  void process(const sensor_msgs::ImageConstPtr& left, const sensor_msgs::CameraInfoConstPtr& left_info,
               const sensor_msgs::ImageConstPtr& right, const sensor_msgs::CameraInfoConstPtr& right_info);

  std::size_t pairs() const { return pairs_; }
  std::size_t unusable() const { return unusable_; }
  const Failure& firstProblem() const { return first_problem_; }

 private:
  void followCalibration(const CameraCalibration& left, const CameraCalibration& right,
                         const ros::Time& stamp);
  Failure run(const sensor_msgs::ImageConstPtr& left, const sensor_msgs::ImageConstPtr& right, double skew);
  void report(const Failure& problem, const ros::Time& stamp);

  Parameters parameters_;
  std::string camera_;
  std::vector<std::unique_ptr<PairSink>>& sinks_;
  std::function<void(const std::string&)> complain_;
  CameraCalibration left_calibration_, right_calibration_;
  std::optional<Pipeline> pipeline_;
  Failure calibration_failure_;
  const Pipeline::Output* output_ = nullptr;
  std::size_t pairs_ = 0, unusable_ = 0;
  Failure first_problem_;
  std::string last_complaint_;
};

}  // namespace uav_landing
