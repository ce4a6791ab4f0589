#include "offline/offline_chain.h"

#include <utility>

#include "camera_info.h"
#include "datasets/decimal_time.h"
#include "time_difference.h"
#include "uav_landing/geometry/rig_check.h"

namespace uav_landing {
namespace {

constexpr std::size_t kRowsLookedAt = 5;  // one in so many pairs is looked at

}  // namespace

OfflineChain::OfflineChain(const Parameters& parameters, const std::string& camera, bool with_imu,
                           std::vector<std::unique_ptr<PairSink>>& sinks,
                           std::function<void(const std::string&)> complain)
    : parameters_(parameters),
      camera_(camera),
      sinks_(sinks),
      complain_(std::move(complain)),
      range_(parameters.rig.bits) {
  if (with_imu && parameters.approach_angle.use_imu)
    imu_.emplace(parameters.approach_angle, leftRowSpan(parameters.rig));
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
  if (parameters_.rig.upside_down)
    waiting_.push_back({right, left, right_info, left_info});
  else
    waiting_.push_back({left, right, left_info, right_info});
  release(false);
}

void OfflineChain::finish() { release(true); }

void OfflineChain::release(bool all) {
  constexpr double kPatience = 0.5;  // s of the images
  constexpr size_t kMost = 100;      // pairs, however close their stamps are
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
  const bool exchanged = parameters_.rig.upside_down;
  followCalibration(toCalibration(*(exchanged ? pair.right_info : pair.left_info)),
                    toCalibration(*(exchanged ? pair.left_info : pair.right_info)), stamp);
  ++pairs_;
  AttitudePrior imu;
  if (imu_) imu = imu_->at(stamp, pair.left_info->header.frame_id, working_.left.R);
  if (imu_ && imu.failure && !imu.hasRotation()) complainOfImu("imu: " + imu.failure.message());
  const Failure problem = run(pair.left, pair.right, skew, imu);
  if (!problem) {
    if (const std::string advice = adviceOnImu(output_->approach); !advice.empty())
      complainOfImu("imu: not used " + advice);
    // Logged as by the nodelets, because a rig that is mounted wrongly gives no result on any pair.
    const Failure& mounting = output_->stereo.failure;
    if (mounting.reason == Reason::kInputInvalid || mounting.reason == Reason::kNegativeDisparity)
      sayOnce(mounting, stamp);
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
  const Failure failure = startWith(left, right);
  calibration_failure_ = failure ? ofCameraInfo(failure) : Failure();
}

Failure OfflineChain::startWith(const CameraCalibration& left, const CameraCalibration& right) {
  const Expected<CameraPair> working = workingPair(left, right, parameters_.rig);
  if (!working) return working.error();
  working_ = *working;
  Expected<Pipeline> pipeline = Pipeline::create(working_.left, working_.right, parameters_);
  if (!pipeline) return pipeline.error();
  pipeline_.emplace(std::move(*pipeline));
  for (const std::string& warning : ofCameraInfo(rigWarnings(left, right, parameters_.rig)))
    complain_(warning);
  return {};
}

Failure OfflineChain::run(const sensor_msgs::ImageConstPtr& left, const sensor_msgs::ImageConstPtr& right,
                          double skew, const AttitudePrior& imu) {
  if (calibration_failure_) return calibration_failure_;
  const bool exchanged = parameters_.rig.upside_down;
  const auto topic = [&](bool of_left) {
    return "/" + camera_ + (of_left != exchanged ? "/left/image_raw" : "/right/image_raw");
  };
  const std::string warning = range_.follow(left, working_.left, right, working_.right);
  if (!warning.empty()) complain_(warning);
  const auto left_image = toMono8(left, working_.left, topic(true), range_.range());
  if (!left_image) return left_image.error();
  const auto right_image = toMono8(right, working_.right, topic(false), range_.range());
  if (!right_image) return right_image.error();
  if (pairs_ % kRowsLookedAt == 0) {
    pictures_.look((*left_image)->image, topic(true));
    for (const std::string& news : pictures_.news()) complain_(news);
  }
  output_ =
      &pipeline_->process(left->header.stamp.toSec(), (*left_image)->image, (*right_image)->image, skew, imu);
  return {};
}

void OfflineChain::report(const Failure& problem, const ros::Time& stamp) {
  if (!first_problem_) first_problem_ = problem;
  sayOnce(problem, stamp);
}

void OfflineChain::sayOnce(const Failure& problem, const ros::Time& stamp) {
  if (problem.detail == last_complaint_) return;
  last_complaint_ = problem.detail;
  complain_("from stamp " + toDecimal(stamp) + " on: " + problem.detail);
}

}  // namespace uav_landing
