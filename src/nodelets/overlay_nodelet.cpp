#include <cv_bridge/cv_bridge.h>
#include <image_transport/image_transport.h>
#include <sensor_msgs/image_encodings.h>

#include <pluginlib/class_list_macros.hpp>

#include "conversions.h"
#include "image_input.h"
#include "pairing.h"
#include "reconfigure_server.h"
#include "rig_watch.h"
#include "stage_nodelet.h"
#include "uav_landing/base/timings.h"
#include "uav_landing/overlay/overlay.h"

namespace uav_landing {

/// Draws what the other nodelets found over the left image.
/// Parameters: OverlayParameters, which dynamic_reconfigure may change in flight, and the common ones of
/// NodeParameters.
/// Subscribes left/image_rect, {left,right}/camera_info, stereo_depth, approach_angle and landing_estimate,
/// while somebody wants the output. Publishes overlay/image (bgr8) with the stamp of the left image.
class OverlayNodelet : public StageNodelet {
 public:
  OverlayNodelet() : StageNodelet("overlay") {}
  ~OverlayNodelet() override { stop(); }

 private:
  using Inputs = Pairing<sensor_msgs::Image, sensor_msgs::CameraInfo, sensor_msgs::CameraInfo, StereoDepth,
                         ApproachAngle, LandingEstimate>;

  void setUp() override {
    parameters_ = loadParametersOrThrow<OverlayParameters>();
    reconfigure_ = std::make_unique<ReconfigureServer<OverlayParameters>>(
        getPrivateNodeHandle(), parameters_,
        [this](const OverlayParameters& changed) { parameters_ = changed; });
    transport_ = std::make_unique<image_transport::ImageTransport>(getNodeHandle());
    const image_transport::SubscriberStatusCallback changed =
        [this](const image_transport::SingleSubscriberPublisher&) { updateSubscription(); };
    publisher_ = transport_->advertise("overlay/image", 1, changed, changed);
    pairing_ = std::make_unique<Inputs>(
        exactPairing(),
        resolved({kLeftImage, kLeftInfo, kRightInfo, kStereoDepth, kApproachAngle, kLandingEstimate}),
        [this](const auto& left, const auto& left_info, const auto& right_info, const auto& stereo,
               const auto& approach, const auto& landing) {
          guard([&] { process(left, *left_info, *right_info, *stereo, *approach, *landing); });
        });
  }

  bool wanted() const override { return publisher_.getNumSubscribers() > 0; }
  void subscribe() override {
    feed<0, sensor_msgs::Image>(kLeftImage, *pairing_, subscribers_);
    feed<1, sensor_msgs::CameraInfo>(kLeftInfo, *pairing_, subscribers_);
    feed<2, sensor_msgs::CameraInfo>(kRightInfo, *pairing_, subscribers_);
    feed<3, StereoDepth>(kStereoDepth, *pairing_, subscribers_);
    feed<4, ApproachAngle>(kApproachAngle, *pairing_, subscribers_);
    feed<5, LandingEstimate>(kLandingEstimate, *pairing_, subscribers_);
  }
  void unsubscribe() override {
    subscribers_.clear();
    pairing_->reset();
  }
  std::vector<InputWatch::Input> inputs() const override { return pairing_->inputs(); }
  std::string complaint() override { return pairing_->complaint(); }

  void process(const sensor_msgs::ImageConstPtr& left, const sensor_msgs::CameraInfo& left_info,
               const sensor_msgs::CameraInfo& right_info, const StereoDepth& stereo,
               const ApproachAngle& approach, const LandingEstimate& landing) {
    if (cameras_.changed(left_info, right_info)) {
      stereo_rig_ = makeStereoRig(cameras_.left(), cameras_.right(), shared_.rig);
      warnOfRig(ofCameraInfo(rigWarnings(cameras_.left(), cameras_.right(), shared_.rig)));
    }
    if (!stereo_rig_) return refuse(ofCameraInfo(stereo_rig_.error()).detail);
    const auto view = toMono8(left, cameras_.left(), kLeftImage);
    if (!view) return refuse(view.error().detail);
    Timings timings;
    cv::Mat picture;
    {
      const ScopedTimer timer(timings, "overlay");
      picture = drawOverlay(*stereo_rig_, (*view)->image,
                            {toResult(stereo), toResult(approach), toResult(landing)}, parameters_);
    }
    report_.served(left->header.stamp, timings.total(), "");
    publisher_.publish(
        cv_bridge::CvImage(left->header, sensor_msgs::image_encodings::BGR8, picture).toImageMsg());
  }

  OverlayParameters parameters_;
  std::unique_ptr<ReconfigureServer<OverlayParameters>> reconfigure_;
  std::unique_ptr<image_transport::ImageTransport> transport_;
  image_transport::Publisher publisher_;
  std::vector<ros::Subscriber> subscribers_;
  std::unique_ptr<Inputs> pairing_;
  RigWatch cameras_;
  Expected<StereoRig> stereo_rig_;
};

}  // namespace uav_landing

PLUGINLIB_EXPORT_CLASS(uav_landing::OverlayNodelet, nodelet::Nodelet)
