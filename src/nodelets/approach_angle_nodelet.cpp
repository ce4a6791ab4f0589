#include <cmath>
#include <deque>
#include <functional>
#include <pluginlib/class_list_macros.hpp>

#include "conversions.h"
#include "image_input.h"
#include "imu_input.h"
#include "pairing.h"
#include "pairs_in_flight.h"
#include "rig_watch.h"
#include "stage_nodelet.h"
#include "uav_landing/stages/approach_angle_stage.h"

namespace uav_landing {

/// Vanishing points, ground normal, focus of expansion and approach angle.
/// Parameters: ApproachAngleParameters and the common ones of NodeParameters.
/// Subscribes {left,right}/{image_rect, camera_info} of rectify and, unless use_stereo is false,
/// stereo_depth. It does so while somebody wants the output.
/// Unless use_imu is false, it subscribes the topic of parameter imu (sensor_msgs/Imu). It also subscribes
/// /tf_static for the sensor's mounting, and /tf only to say what is missing there. While somebody publishes
/// on the topic of the imu, a pair waits up to imu_wait for the message after it.
/// Publishes approach_angle (ApproachAngle): one message per pair, also without an angle.
class ApproachAngleNodelet : public StageNodelet {
 public:
  ApproachAngleNodelet() : StageNodelet("approach_angle") {}
  ~ApproachAngleNodelet() override {
    stop();
    tf_subscriber_.shutdown();
    tf_static_subscriber_.shutdown();
  }

 private:
  using StereoInputs = Pairing<sensor_msgs::Image, sensor_msgs::CameraInfo, sensor_msgs::Image,
                               sensor_msgs::CameraInfo, StereoDepth>;

  static constexpr uint32_t kImuQueue = 1000;
  static constexpr double kPatience = 0.5;  // s, with recorded data

  /// A pair that waits for the imu. since: when it began to wait.
  struct Waiting {
    ros::Time stamp;
    ros::WallTime since;
    std::function<void()> work;
  };

  void setUp() override {
    parameters_ = loadParametersOrThrow<ApproachAngleParameters>();
    masks_ = loadMasksOrThrow();
    publisher_ = getNodeHandle().advertise<ApproachAngle>("approach_angle", kStageQueue, onConnection(),
                                                          onConnection());
    if (parameters_.use_stereo) {
      with_stereo_ = std::make_unique<StereoInputs>(
          exactPairing(), resolved({kLeftImage, kLeftInfo, kRightImage, kRightInfo, kStereoDepth}),
          [this](const auto& left, const auto& left_info, const auto& right, const auto& right_info,
                 const auto& stereo) {
            take(left->header.stamp, [=] { work(left, *left_info, right, *right_info, toResult(*stereo)); });
          });
    } else {
      without_stereo_ = std::make_unique<StereoPairing>(
          exactPairing(), resolved({kLeftImage, kLeftInfo, kRightImage, kRightInfo}),
          [this](const auto& left, const auto& left_info, const auto& right, const auto& right_info) {
            take(left->header.stamp,
                 [=] { work(left, *left_info, right, *right_info, StereoDepthResult()); });
          });
    }
    if (!parameters_.use_imu || node_.imu.empty()) return;
    imu_ = std::make_unique<ImuInput>(parameters_, leftRowSpan(shared_.rig));
    tf_static_subscriber_ = getNodeHandle().subscribe<tf2_msgs::TFMessage>(
        "/tf_static", 100,
        [this](const tf2_msgs::TFMessageConstPtr& m) { guard([&] { imu_->addTransforms(*m); }); });
    tf_subscriber_ = getNodeHandle().subscribe<tf2_msgs::TFMessage>(
        "/tf", 100,
        [this](const tf2_msgs::TFMessageConstPtr& m) { guard([&] { imu_->addMovingTransforms(*m); }); });
    // Recorded data is to be used completely, so pairs wait longer.
    wait_ = ros::WallDuration(node_.drop_frames ? parameters_.imu_wait : kPatience);
    wait_timer_ = getNodeHandle().createWallTimer(
        wait_, [this](const ros::WallTimerEvent&) { release(); }, true, false);
  }

  bool wanted() const override { return publisher_.getNumSubscribers() > 0; }
  void subscribe() override {
    in_flight_ = PairsInFlight::join(getNodeHandle().resolveName(kLeftImage));
    if (imu_) {
      imu_subscriber_ = getNodeHandle().subscribe<sensor_msgs::Imu>(
          node_.imu, kImuQueue,
          [this](const sensor_msgs::ImuConstPtr& message) { guard([&] { takeImu(*message); }); },
          ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay());
    }
    if (with_stereo_) {
      feedViews(*with_stereo_);
      feed<4, StereoDepth>(kStereoDepth, *with_stereo_, subscribers_);
    } else {
      feedViews(*without_stereo_);
    }
  }
  template <class Inputs>
  void feedViews(Inputs& inputs) {
    feed<0, sensor_msgs::Image>(kLeftImage, inputs, subscribers_);
    feed<1, sensor_msgs::CameraInfo>(kLeftInfo, inputs, subscribers_);
    feed<2, sensor_msgs::Image>(kRightImage, inputs, subscribers_);
    feed<3, sensor_msgs::CameraInfo>(kRightInfo, inputs, subscribers_);
  }
  void unsubscribe() override {
    subscribers_.clear();
    imu_subscriber_.shutdown();
    wait_timer_.stop();
    waiting_.clear();
    if (with_stereo_) with_stereo_->reset();
    if (without_stereo_) without_stereo_->reset();
    in_flight_.reset();
  }
  void forget() override { stage_.reset(); }
  std::vector<InputWatch::Input> inputs() const override {
    return with_stereo_ ? with_stereo_->inputs() : without_stereo_->inputs();
  }
  std::string complaint() override {
    return with_stereo_ ? with_stereo_->complaint() : without_stereo_->complaint();
  }

  void complainMore() override {
    if (imu_heard_ && imu_unused_)
      NODELET_WARN("%s: %s is not used for %.3g s: %s", getName().c_str(), imu_subscriber_.getTopic().c_str(),
                   node_.complaint_period, imu_reason_.c_str());
    imu_heard_ = imu_unused_ = false;
  }
  void describe(diagnostic_updater::DiagnosticStatusWrapper& status) override {
    if (imu_) status.add("imu", imu_use_);
    if (!imu_rows_.empty()) status.add("imu within images", imu_rows_);
    if (readout_.known())
      status.addf("estimated readout time [ms]", "%.0f +- %.0f", 1e3 * readout_.time,
                  1e3 * std::sqrt(readout_.variance));
  }

  void takeImu(const sensor_msgs::Imu& message) {
    const Failure failure = imu_->add(message);
    imu_heard_ = true;
    imu_silent_ = false;
    if (failure) refuse(imu_subscriber_.getTopic() + ": " + failure.detail);
    release();
  }

  // Pairs go on in their order. Each one waits for the imu message after it.
  void take(const ros::Time& stamp, std::function<void()> pair) {
    waiting_.push_back({stamp, ros::WallTime::now(), std::move(pair)});
    release();
  }
  void release() {
    while (!waiting_.empty() && !mustWait(waiting_.front())) {
      const std::function<void()> pair = std::move(waiting_.front().work);
      waiting_.pop_front();
      pair();
    }
    if (waiting_.empty()) return;
    wait_timer_.stop();
    wait_timer_.setPeriod(
        std::max(ros::WallDuration(0.001), waiting_.front().since + wait_ - ros::WallTime::now()));
    wait_timer_.start();
  }
  bool mustWait(const Waiting& pair) {
    if (!imu_ || imu_silent_ || imu_subscriber_.getNumPublishers() == 0 || imu_->covers(pair.stamp))
      return false;
    if (waiting_.size() > kStageQueue) return false;
    if (ros::WallTime::now() - pair.since < wait_) return true;
    imu_silent_ = true;
    return false;
  }

  void work(const sensor_msgs::ImageConstPtr& left, const sensor_msgs::CameraInfo& left_info,
            const sensor_msgs::ImageConstPtr& right, const sensor_msgs::CameraInfo& right_info,
            const StereoDepthResult& stereo) {
    guard([&] { process(left, left_info, right, right_info, stereo); });
    if (in_flight_) in_flight_->finished(left->header.stamp);
  }

  void process(const sensor_msgs::ImageConstPtr& left, const sensor_msgs::CameraInfo& left_info,
               const sensor_msgs::ImageConstPtr& right, const sensor_msgs::CameraInfo& right_info,
               const StereoDepthResult& stereo) {
    const double stamp = left->header.stamp.toSec();
    double compute_ms = 0;
    AttitudePrior imu;
    if (imu_) imu = imu_->at(left->header.stamp, left_info.header.frame_id, toCalibration(left_info).R);
    ApproachAngleResult result = attempt<ApproachAngleResult>([&] {
      return stage_.run(
          left, kLeftImage, left_info, right, kRightImage, right_info, shared_.rig, masks_,
          [this](const RigModel& model) { return ApproachAngleStage(model, parameters_, shared_.runway); },
          [&](ApproachAngleStage& stage, const cv::Mat& left_view, const cv::Mat& right_view) {
            auto processed = stage.process(stamp, left_view, right_view, stereo, imu);
            compute_ms = stage.timings().total();
            return processed;
          });
    });
    result.stamp = stamp;
    noteImu(result);
    noteReadout(result.readout);
    warnOf(result.failure);
    warnOfRig(stage_.warnings());
    report_.served(left->header.stamp, compute_ms, result.failure.message());
    publisher_.publish(boost::make_shared<ApproachAngle>(toMessage(result, left->header, compute_ms)));
  }

  // The log gives this advice once.
  void noteReadout(const ReadoutEstimate& readout) {
    readout_ = readout;
    const std::string advice = advised_ ? "" : adviceOn(readout);
    if (advice.empty()) return;
    advised_ = true;
    NODELET_WARN("%s: %s", getName().c_str(), advice.c_str());
  }

  void noteImu(const ApproachAngleResult& result) {
    const AttitudePrior& imu = result.imu;
    imu_unused_ = imu.failure && !imu.hasRotation();
    imu_reason_ = imu.failure.message();
    imu_use_ = !imu.failure ? "used" : imu.hasRotation() ? "rotation only: " + imu_reason_ : imu_reason_;
    imu_rows_ = imu.rows ? "used" : imu.rows_failure.message();
    const std::string advice = adviceOnImu(result);
    if (advice.empty()) return;
    imu_unused_ = true;
    imu_reason_ = advice;
  }

  ReadoutEstimate readout_;  // of the last pair, for the diagnostics
  bool advised_ = false;
  ApproachAngleParameters parameters_;
  RigMasks masks_;
  ros::Publisher publisher_;
  std::vector<ros::Subscriber> subscribers_;
  std::unique_ptr<StereoInputs> with_stereo_;  // one of the two is set
  std::unique_ptr<StereoPairing> without_stereo_;
  std::unique_ptr<PairsInFlight::Consumer> in_flight_;
  RigStage<ApproachAngleStage> stage_;

  std::unique_ptr<ImuInput> imu_;  // null: not used
  ros::Subscriber imu_subscriber_, tf_subscriber_, tf_static_subscriber_;
  std::deque<Waiting> waiting_;
  ros::WallDuration wait_;
  ros::WallTimer wait_timer_;
  bool imu_silent_ = false;                      // no message came while the last pair waited
  bool imu_heard_ = false, imu_unused_ = false;  // heard since the last complaint; unused by the last pair
  std::string imu_reason_;                       // of the last pair
  std::string imu_use_ = "no pair yet";          // by the last pair, for the diagnostics
  std::string imu_rows_;                         // the same between the rows; empty: rows have no times
};

}  // namespace uav_landing

PLUGINLIB_EXPORT_CLASS(uav_landing::ApproachAngleNodelet, nodelet::Nodelet)
