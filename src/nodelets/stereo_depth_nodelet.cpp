#include <sensor_msgs/TimeReference.h>

#include <atomic>
#include <pluginlib/class_list_macros.hpp>

#include "conversions.h"
#include "image_input.h"
#include "pairing.h"
#include "pairs_in_flight.h"
#include "rig_watch.h"
#include "stage_nodelet.h"
#include "time_difference.h"
#include "uav_landing/stages/stereo_depth_stage.h"

namespace uav_landing {

/// Sparse stereo depth and the ground plane.
/// Parameters: StereoDepthParameters and the common ones of NodeParameters.
/// Subscribes {left,right}/{image_rect, camera_info} and right/time_reference of rectify, while somebody
/// wants the output. Publishes stereo_depth (StereoDepth): one message per pair, also without a plane.
class StereoDepthNodelet : public StageNodelet {
 public:
  StereoDepthNodelet() : StageNodelet("stereo_depth") {}
  ~StereoDepthNodelet() override { stop(); }

 private:
  using Inputs = Pairing<sensor_msgs::Image, sensor_msgs::CameraInfo, sensor_msgs::Image,
                         sensor_msgs::CameraInfo, sensor_msgs::TimeReference>;

  void setUp() override {
    parameters_ = loadParametersOrThrow<StereoDepthParameters>();
    masks_ = loadMasksOrThrow();
    publisher_ =
        getNodeHandle().advertise<StereoDepth>("stereo_depth", kStageQueue, onConnection(), onConnection());
    pairing_ = std::make_unique<Inputs>(
        exactPairing(), resolved({kLeftImage, kLeftInfo, kRightImage, kRightInfo, kRightTime}),
        [this](const auto& left, const auto& left_info, const auto& right, const auto& right_info,
               const auto& time) {
          guard([&] { process(left, *left_info, right, *right_info, *time); });
          if (in_flight_) in_flight_->finished(left->header.stamp);
        });
  }

  bool wanted() const override { return publisher_.getNumSubscribers() > 0; }
  void subscribe() override {
    in_flight_ = PairsInFlight::join(getNodeHandle().resolveName(kLeftImage));
    feed<0, sensor_msgs::Image>(kLeftImage, *pairing_, subscribers_);
    feed<1, sensor_msgs::CameraInfo>(kLeftInfo, *pairing_, subscribers_);
    feed<2, sensor_msgs::Image>(kRightImage, *pairing_, subscribers_);
    feed<3, sensor_msgs::CameraInfo>(kRightInfo, *pairing_, subscribers_);
    feed<4, sensor_msgs::TimeReference>(kRightTime, *pairing_, subscribers_);
  }
  void unsubscribe() override {
    subscribers_.clear();
    pairing_->reset();
    in_flight_.reset();
  }
  void forget() override { stage_.reset(); }
  void describe(diagnostic_updater::DiagnosticStatusWrapper& status) override {
    status.addf("own frame, % of the left image", "%.1f", 100 * own_frame_);
  }
  std::vector<InputWatch::Input> inputs() const override { return pairing_->inputs(); }
  std::string complaint() override { return pairing_->complaint(); }

  void process(const sensor_msgs::ImageConstPtr& left, const sensor_msgs::CameraInfo& left_info,
               const sensor_msgs::ImageConstPtr& right, const sensor_msgs::CameraInfo& right_info,
               const sensor_msgs::TimeReference& time) {
    const double stamp = left->header.stamp.toSec();
    const double skew = secondsBetween(left->header.stamp, time.time_ref);
    double compute_ms = 0;
    StereoDepthResult result = attempt<StereoDepthResult>([&] {
      return stage_.run(
          left, kLeftImage, left_info, right, kRightImage, right_info, shared_.rig, masks_,
          [this](const RigModel& model) { return StereoDepthStage(model, parameters_); },
          [&](StereoDepthStage& stage, const cv::Mat& left_view, const cv::Mat& right_view) {
            auto processed = stage.process(stamp, left_view, right_view, skew);
            compute_ms = stage.timings().total();
            noteOwnFrame(stage.ownFrame());
            return processed;
          });
    });
    result.stamp = stamp;
    result.skew = skew;
    warnOf(result.failure);
    warnOfRig(stage_.warnings());
    report_.served(left->header.stamp, compute_ms, result.failure.message());
    publisher_.publish(boost::make_shared<StereoDepth>(toMessage(result, left->header, compute_ms)));
  }

  void noteOwnFrame(double share) {
    if (share > 0 && !own_frame_told_)
      NODELET_INFO(
          "%s: %.1f %% of the left image does not move with the ground (the aircraft's own frame) and is not "
          "used",
          getName().c_str(), 100 * share);
    own_frame_told_ = own_frame_told_ || share > 0;
    own_frame_ = share;
  }

  StereoDepthParameters parameters_;
  RigMasks masks_;
  ros::Publisher publisher_;
  std::vector<ros::Subscriber> subscribers_;
  std::unique_ptr<Inputs> pairing_;
  std::unique_ptr<PairsInFlight::Consumer> in_flight_;
  RigStage<StereoDepthStage> stage_;
  std::atomic<double> own_frame_{0};  // share of the left image; the diagnostics have their own thread
  bool own_frame_told_ = false;
};

}  // namespace uav_landing

PLUGINLIB_EXPORT_CLASS(uav_landing::StereoDepthNodelet, nodelet::Nodelet)
