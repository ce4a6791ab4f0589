#include "offline_chain.h"

#include <utility>

#include "camera_info.h"
#include "decimal_time.h"
#include "image_input.h"

namespace uav_landing {

OfflineChain::OfflineChain(const Parameters& parameters, const std::string& camera,
                           std::vector<std::unique_ptr<PairSink>>& sinks,
                           std::function<void(const std::string&)> complain)
    : parameters_(parameters), camera_(camera), sinks_(sinks), complain_(std::move(complain)) {}

void OfflineChain::process(const sensor_msgs::ImageConstPtr& left,
                           const sensor_msgs::CameraInfoConstPtr& left_info,
                           const sensor_msgs::ImageConstPtr& right,
                           const sensor_msgs::CameraInfoConstPtr& right_info) {
  const ros::Time& stamp = left->header.stamp;
  const double skew = (right->header.stamp - stamp).toSec();
  followCalibration(toCalibration(*left_info), toCalibration(*right_info), stamp);
  ++pairs_;
  const Failure problem = run(left, right, skew);
  if (!problem) {
    const ProcessedPair pair{stamp, left->header.frame_id, skew, {}, pipeline_->rig().rig, *output_};
    for (const auto& sink : sinks_) sink->take(pair);
    return;
  }
  ++unusable_;
  report(problem, stamp);
  Pipeline::Output nothing;
  nothing.landing.stamp = stamp.toSec();
  nothing.landing.status = Status::kLost;
  nothing.landing.failure = problem;
  const StereoRig no_rig;
  const ProcessedPair pair{stamp, left->header.frame_id, skew, problem, no_rig, nothing};
  for (const auto& sink : sinks_) sink->take(pair);
}

void OfflineChain::followCalibration(const CameraCalibration& left, const CameraCalibration& right,
                                     const ros::Time& stamp) {
  if (pairs_ > 0 && left == left_calibration_ && right == right_calibration_) return;
  if (pairs_ > 0) {
    complain_("camera_info of the " + std::string(left == left_calibration_ ? "right" : "left") +
              " camera changed at stamp " + toDecimal(stamp) + ": the chain starts anew with it");
  }
  left_calibration_ = left;
  right_calibration_ = right;
  pipeline_.reset();
  Expected<Pipeline> pipeline = Pipeline::create(left, right, parameters_);
  calibration_failure_ = pipeline ? Failure() : pipeline.error();
  if (pipeline) pipeline_.emplace(std::move(*pipeline));
}

Failure OfflineChain::run(const sensor_msgs::ImageConstPtr& left, const sensor_msgs::ImageConstPtr& right,
                          double skew) {
  if (calibration_failure_) {
    return {calibration_failure_.reason, "camera_info: " + calibration_failure_.detail};
  }
  const auto left_image = toMono8(left, left_calibration_, "/" + camera_ + "/left/image_raw");
  if (!left_image) return left_image.error();
  const auto right_image = toMono8(right, right_calibration_, "/" + camera_ + "/right/image_raw");
  if (!right_image) return right_image.error();
  output_ =
      &pipeline_->process(left->header.stamp.toSec(), (*left_image)->image, (*right_image)->image, skew);
  return {};
}

void OfflineChain::report(const Failure& problem, const ros::Time& stamp) {
  if (!first_problem_) first_problem_ = problem;
  if (problem.detail == last_complaint_) return;
  last_complaint_ = problem.detail;
  complain_("from stamp " + toDecimal(stamp) + " on: " + problem.detail);
}

}  // namespace uav_landing
