#include <pluginlib/class_list_macros.hpp>

#include "conversions.h"
#include "image_input.h"
#include "pairing.h"
#include "pairs_in_flight.h"
#include "rig_watch.h"
#include "stage_nodelet.h"
#include "uav_landing/approach_angle_stage.h"

namespace uav_landing {

/// Vanishing points, ground normal, focus of expansion and approach angle.
///
/// Parameters: ApproachAngleParameters and the common ones of NodeParameters.
/// Subscribes {left,right}/{image_rect, camera_info} of rectify and, unless use_stereo is false,
/// stereo_depth, while somebody wants the output. Publishes approach_angle (ApproachAngle): one message per
/// pair, also without an angle.
class ApproachAngleNodelet : public StageNodelet {
 public:
  ApproachAngleNodelet() : StageNodelet("approach_angle") {}
  ~ApproachAngleNodelet() override { stop(); }

 private:
  using StereoInputs = Pairing<sensor_msgs::Image, sensor_msgs::CameraInfo, sensor_msgs::Image,
                               sensor_msgs::CameraInfo, StereoDepth>;

  void setUp() override {
    parameters_ = loadParametersOrThrow<ApproachAngleParameters>();
    publisher_ = getNodeHandle().advertise<ApproachAngle>("approach_angle", kStageQueue, onConnection(),
                                                          onConnection());
    if (parameters_.use_stereo) {
      with_stereo_ = std::make_unique<StereoInputs>(
          exactPairing(), resolved({kLeftImage, kLeftInfo, kRightImage, kRightInfo, kStereoDepth}),
          [this](const auto& left, const auto& left_info, const auto& right, const auto& right_info,
                 const auto& stereo) { work(left, *left_info, right, *right_info, toResult(*stereo)); });
    } else {
      without_stereo_ = std::make_unique<StereoPairing>(
          exactPairing(), resolved({kLeftImage, kLeftInfo, kRightImage, kRightInfo}),
          [this](const auto& left, const auto& left_info, const auto& right, const auto& right_info) {
            work(left, *left_info, right, *right_info, StereoDepthResult());
          });
    }
  }

  bool wanted() const override { return publisher_.getNumSubscribers() > 0; }
  void subscribe() override {
    in_flight_ = PairsInFlight::join(getNodeHandle().resolveName(kLeftImage));
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
    ApproachAngleResult result = attempt<ApproachAngleResult>([&] {
      return stage_.run(left, kLeftImage, left_info, right, kRightImage, right_info, parameters_,
                        [&](ApproachAngleStage& stage, const cv::Mat& left_view, const cv::Mat& right_view) {
                          auto processed = stage.process(stamp, left_view, right_view, stereo);
                          compute_ms = stage.timings().total();
                          return processed;
                        });
    });
    result.stamp = stamp;
    warnOf(result.failure);
    report_.served(left->header.stamp, compute_ms, result.failure.message());
    publisher_.publish(boost::make_shared<ApproachAngle>(toMessage(result, left->header, compute_ms)));
  }

  ApproachAngleParameters parameters_;
  ros::Publisher publisher_;
  std::vector<ros::Subscriber> subscribers_;
  std::unique_ptr<StereoInputs> with_stereo_;  // one of the two
  std::unique_ptr<StereoPairing> without_stereo_;
  std::unique_ptr<PairsInFlight::Consumer> in_flight_;
  RigStage<ApproachAngleStage, ApproachAngleParameters> stage_;
};

}  // namespace uav_landing

PLUGINLIB_EXPORT_CLASS(uav_landing::ApproachAngleNodelet, nodelet::Nodelet)
