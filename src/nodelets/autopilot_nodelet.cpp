#include <pluginlib/class_list_macros.hpp>

#include "autopilot_messages.h"
#include "pairing.h"
#include "rate_limit.h"
#include "reconfigure_server.h"
#include "stage_nodelet.h"

namespace uav_landing {

/// Messages that an autopilot may fuse. It is silent while there is nothing valid.
/// Parameters: AutopilotParameters, which dynamic_reconfigure may change in flight, and the common ones of
/// NodeParameters.
/// Subscribes height (Range), pose (PoseWithCovarianceStamped) and twist (TwistWithCovarianceStamped) of
/// kalman_height.
/// Publishes autopilot/range (Range, along the aircraft's down axis), autopilot/pose
/// (PoseWithCovarianceStamped) and autopilot/velocity (TwistWithCovarianceStamped), both east-north-up. All
/// have the image's stamp.
class AutopilotNodelet : public StageNodelet {
 public:
  AutopilotNodelet() : StageNodelet("autopilot") {}
  ~AutopilotNodelet() override { stop(); }

 private:
  using Inputs = Pairing<sensor_msgs::Range, geometry_msgs::PoseWithCovarianceStamped>;
  // Paired separately, because pairs without a motion still have a height and a pose.
  using Movements =
      Pairing<geometry_msgs::TwistWithCovarianceStamped, geometry_msgs::PoseWithCovarianceStamped>;

  void setUp() override {
    parameters_ = loadParametersOrThrow<AutopilotParameters>();
    reconfigure_ = std::make_unique<ReconfigureServer<AutopilotParameters>>(
        getPrivateNodeHandle(), parameters_,
        [this](const AutopilotParameters& changed) { parameters_ = changed; });
    if (!headingKnown(parameters_))
      NODELET_WARN("%s: sends the range alone, no pose and no velocity: runway_heading_deg is not set",
                   getName().c_str());
    pairing_ =
        std::make_unique<Inputs>(exactPairing(), resolved({"height", "pose"}),
                                 [this](const auto& height, const auto& pose) { work(*height, *pose); });
    movements_ = std::make_unique<Movements>(
        exactPairing(), resolved({"twist", "pose"}),
        [this](const auto& twist, const auto& pose) { passVelocity(*twist, *pose); });
    // The names are in the namespace of this nodelet, so that all can be remapped together.
    range_publisher_ = getNodeHandle().advertise<sensor_msgs::Range>("autopilot/range", kStageQueue);
    pose_publisher_ =
        getNodeHandle().advertise<geometry_msgs::PoseWithCovarianceStamped>("autopilot/pose", kStageQueue);
    velocity_publisher_ = getNodeHandle().advertise<geometry_msgs::TwistWithCovarianceStamped>(
        "autopilot/velocity", kStageQueue);
  }

  bool wanted() const override { return true; }
  void subscribe() override {
    feed<0, sensor_msgs::Range>("height", *pairing_, subscribers_);
    feed<1, geometry_msgs::PoseWithCovarianceStamped>("pose", *pairing_, subscribers_);
    feed<1, geometry_msgs::PoseWithCovarianceStamped>("pose", *movements_, subscribers_);
    // This comes last, because it goes to one pairing only. Whoever sees it connected knows that all are.
    feed<0, geometry_msgs::TwistWithCovarianceStamped>("twist", *movements_, subscribers_);
  }
  void unsubscribe() override {
    subscribers_.clear();
    pairing_->reset();
    movements_->reset();
  }
  std::vector<InputWatch::Input> inputs() const override {
    std::vector<InputWatch::Input> all = pairing_->inputs();
    all.push_back(movements_->inputs()[0]);
    return all;
  }
  std::string complaint() override { return pairing_->complaint(); }
  void complainMore() override {
    complainOf("nothing sent for", anything_);
    complainOf("no velocity sent for", velocity_);
  }

  /// Messages of one kind that were sent since the last complaint.
  struct Sent {
    bool lately = false;
    std::string why_not;  // reason for the last one that was not sent
  };
  void complainOf(const char* what, Sent& sent) {
    if (!sent.lately && !sent.why_not.empty())
      NODELET_WARN("%s: %s %.3g s: %s", getName().c_str(), what, node_.complaint_period,
                   sent.why_not.c_str());
    sent = {};
  }

  void work(const sensor_msgs::Range& height, const geometry_msgs::PoseWithCovarianceStamped& pose) {
    const ros::Time& stamp = pose.header.stamp;
    if (!rate_.passes(stamp, parameters_.max_rate)) return;
    const auto range = autopilotRange(height, pose, parameters_);
    const auto enu_pose = autopilotPose(pose, parameters_);
    if (range) range_publisher_.publish(*range);
    if (enu_pose) pose_publisher_.publish(*enu_pose);
    std::string missing;
    if (!range) missing = "no range: " + whyNoRange(height, pose, parameters_);
    if (range && !enu_pose && headingKnown(parameters_))
      missing = "no pose: the place along or across the runway is not known";
    report_.served(stamp, 0, missing);
    if (range || enu_pose)
      anything_.lately = true;
    else
      anything_.why_not = missing;
  }

  void passVelocity(const geometry_msgs::TwistWithCovarianceStamped& twist,
                    const geometry_msgs::PoseWithCovarianceStamped& pose) {
    if (!velocity_rate_.passes(twist.header.stamp, parameters_.max_rate)) return;
    const auto velocity = autopilotVelocity(twist, pose, parameters_);
    if (velocity) {
      velocity_publisher_.publish(*velocity);
      velocity_.lately = true;
    } else if (headingKnown(parameters_)) {
      velocity_.why_not = whyNoVelocity(pose);
    }
  }

  AutopilotParameters parameters_;
  std::unique_ptr<ReconfigureServer<AutopilotParameters>> reconfigure_;
  std::unique_ptr<Inputs> pairing_;
  std::unique_ptr<Movements> movements_;
  std::vector<ros::Subscriber> subscribers_;
  ros::Publisher range_publisher_, pose_publisher_, velocity_publisher_;
  RateLimit rate_, velocity_rate_;
  Sent anything_, velocity_;
};

}  // namespace uav_landing

PLUGINLIB_EXPORT_CLASS(uav_landing::AutopilotNodelet, nodelet::Nodelet)
