#include "offline/offline_chain.h"

#include <utility>

#include "camera_info.h"
#include "datasets/decimal_time.h"
#include "image_input.h"
#include "time_difference.h"

namespace uav_landing {
namespace {

constexpr std::size_t kRowsLookedAt = 5;  // of so many pairs, one

}  // namespace

OfflineChain::OfflineChain(const Parameters& parameters, const std::string& camera, bool with_imu,
                           std::vector<std::unique_ptr<PairSink>>& sinks,
                           std::function<void(const std::string&)> complain)
    : parameters_(parameters), camera_(camera), sinks_(sinks), complain_(std::move(complain)) {
  if (with_imu && parameters.approach_angle.use_imu) imu_.emplace(parameters.approach_angle);
}

void OfflineChain::addTransforms(const tf2_msgs::TFMessage& static_transforms) {
  if (imu_) imu_->addTransforms(static_transforms);
}

void OfflineChain::addImu(const sensor_msgs::Imu& message, const std::string& imu_topic) {
  if (!imu_) return;
  const Failure failure = imu_->add(message);
  if (failure) complainOfImu(imu_topic + ": " + failure.detail);
  release(false);
}

void OfflineChain::complainOfImu(const std::string& problem) {
  if (problem == last_imu_complaint_) return;
  last_imu_complaint_ = problem;
  complain_(problem);
}

void OfflineChain::process(const sensor_msgs::ImageConstPtr& left,
                           const sensor_msgs::CameraInfoConstPtr& left_info,
                           const sensor_msgs::ImageConstPtr& right,
                           const sensor_msgs::CameraInfoConstPtr& right_info) {
  const bool repetition = pictures_.isRepetition(left, right);
  for (const std::string& news : pictures_.news()) complain_(news);
  if (repetition) return;
  waiting_.push_back({left, right, left_info, right_info});
  release(false);
}

void OfflineChain::finish() { release(true); }

void OfflineChain::release(bool all) {
  constexpr double kPatience = 0.5;  // s of the images
  constexpr size_t kMost = 100;      // pairs, however close their stamps
  while (!waiting_.empty()) {
    const ros::Time stamp = waiting_.front().left->header.stamp;
    const double waited = secondsBetween(stamp, waiting_.back().left->header.stamp);
    const bool goes =
        all || !imu_ || imu_->covers(stamp) || waited < 0 || waited > kPatience || waiting_.size() > kMost;
    if (!goes) return;
    const Waiting pair = waiting_.front();
    waiting_.pop_front();
    process(pair);
  }
}

void OfflineChain::process(const Waiting& pair) {
  const ros::Time& stamp = pair.left->header.stamp;
  const double skew = secondsBetween(stamp, pair.right->header.stamp);
  followCalibration(toCalibration(*pair.left_info), toCalibration(*pair.right_info), stamp);
  ++pairs_;
  AttitudePrior imu;
  if (imu_) imu = imu_->at(stamp, pair.left_info->header.frame_id, left_calibration_.R);
  if (imu_ && imu.failure && !imu.hasRotation()) complainOfImu("imu: " + imu.failure.message());
  const Failure problem = run(pair.left, pair.right, skew, imu);
  if (!problem) {
    const ProcessedPair processed{stamp, pair.left->header.frame_id, skew,
                                  {},    pipeline_->rig().rig,       *output_};
    for (const auto& sink : sinks_) sink->take(processed);
    return;
  }
  ++unusable_;
  report(problem, stamp);
  Pipeline::Output nothing;
  nothing.landing.stamp = stamp.toSec();
  nothing.landing.status = Status::kLost;
  nothing.landing.failure = problem;
  const StereoRig no_rig;
  const ProcessedPair processed{stamp, pair.left->header.frame_id, skew, problem, no_rig, nothing};
  for (const auto& sink : sinks_) sink->take(processed);
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
  calibration_failure_ = pipeline ? Failure() : ofCameraInfo(pipeline.error());
  if (!pipeline) return;
  pipeline_.emplace(std::move(*pipeline));
  for (const std::string& warning : ofCameraInfo(pipeline_->warnings())) complain_(warning);
}

Failure OfflineChain::run(const sensor_msgs::ImageConstPtr& left, const sensor_msgs::ImageConstPtr& right,
                          double skew, const AttitudePrior& imu) {
  if (calibration_failure_) return calibration_failure_;
  const auto left_image = toMono8(left, left_calibration_, "/" + camera_ + "/left/image_raw");
  if (!left_image) return left_image.error();
  const auto right_image = toMono8(right, right_calibration_, "/" + camera_ + "/right/image_raw");
  if (!right_image) return right_image.error();
  if (pairs_ % kRowsLookedAt == 0) {
    pictures_.look((*left_image)->image, "/" + camera_ + "/left/image_raw");
    for (const std::string& news : pictures_.news()) complain_(news);
  }
  output_ =
      &pipeline_->process(left->header.stamp.toSec(), (*left_image)->image, (*right_image)->image, skew, imu);
  return {};
}

void OfflineChain::report(const Failure& problem, const ros::Time& stamp) {
  if (!first_problem_) first_problem_ = problem;
  if (problem.detail == last_complaint_) return;
  last_complaint_ = problem.detail;
  complain_("from stamp " + toDecimal(stamp) + " on: " + problem.detail);
}

}  // namespace uav_landing
