#include <tf2_eigen/tf2_eigen.h>
#include <tf2_msgs/TFMessage.h>
#include <tf2_ros/transform_broadcaster.h>

#include <algorithm>
#include <limits>
#include <mutex>
#include <optional>
#include <pluginlib/class_list_macros.hpp>

#include "aircraft_tilt.h"
#include "body_pose.h"
#include "conversions.h"
#include "landing_markers.h"
#include "landing_messages.h"
#include "pairing.h"
#include "pose_covariance.h"
#include "rig_frames.h"
#include "rig_watch.h"
#include "runway_path.h"
#include "stage_nodelet.h"
#include "uav_landing/results/consistency_test.h"
#include "uav_landing/stages/kalman_height_stage.h"

namespace uav_landing {

/// Height by reconstruction and Kalman filter, the landing estimate, and the messages that are made from it.
/// Parameters: KalmanHeightParameters; base_frame, runway_frame, publish_tf, drawn_runway_width,
/// drawn_runway_length, ellipsoid_scale, drop_frames and the common ones of NodeParameters.
/// Subscribes stereo_depth, approach_angle and {left,right}/camera_info; without publish_tf only while
/// somebody wants the output. Subscribes /tf_static (lever arm) and /tf (parents of frames).
/// Publishes:
/// - landing_estimate (LandingEstimate): one message per pair. When no pair came for max_age, one message
/// with status LOST. This is not so when drop_frames is false, because recorded pairs do not grow old.
/// - height (Range): NaN while it is not valid.
/// - pose (PoseWithCovarianceStamped) and tf runway_frame -> child: while the height is valid.
/// - twist (TwistWithCovarianceStamped) of the child in its own axes: while the height is valid and the
/// motion is known.
/// - markers (MarkerArray) and tf runway_frame -> landing_view: while somebody subscribes markers.
class KalmanHeightNodelet : public StageNodelet {
 public:
  KalmanHeightNodelet() : StageNodelet("kalman_height") {}
  ~KalmanHeightNodelet() override {
    stop();
    age_timer_.stop();
    tf_subscriber_.shutdown();
    tf_static_subscriber_.shutdown();
  }

 private:
  using Inputs = Pairing<StereoDepth, ApproachAngle, sensor_msgs::CameraInfo, sensor_msgs::CameraInfo>;

  void setUp() override {
    parameters_ = loadParametersOrThrow<KalmanHeightParameters>();
    frames_ = std::make_unique<RigFrames>(node_.base_frame, node_.runway_frame);
    pairing_ = std::make_unique<Inputs>(
        exactPairing(), resolved({kStereoDepth, kApproachAngle, kLeftInfo, kRightInfo}),
        [this](const auto& stereo, const auto& approach, const auto& left_info, const auto& right_info) {
          guard([&] { process(*stereo, *approach, *left_info, *right_info); });
        });

    ros::NodeHandle& handle = getNodeHandle();
    estimate_publisher_ = advertise<LandingEstimate>(kLandingEstimate, kStageQueue);
    range_publisher_ = advertise<sensor_msgs::Range>("height", kStageQueue);
    pose_publisher_ = advertise<geometry_msgs::PoseWithCovarianceStamped>("pose", kStageQueue);
    twist_publisher_ = advertise<geometry_msgs::TwistWithCovarianceStamped>("twist", kStageQueue);
    marker_publisher_ = advertise<visualization_msgs::MarkerArray>("markers", 1);
    broadcaster_ = std::make_unique<tf2_ros::TransformBroadcaster>();

    tf_static_subscriber_ = handle.subscribe<tf2_msgs::TFMessage>(
        "/tf_static", 100,
        [this](const tf2_msgs::TFMessageConstPtr& m) { guard([&] { frames_->add(*m, true); }); });
    tf_subscriber_ = handle.subscribe<tf2_msgs::TFMessage>(
        "/tf", 100,
        [this](const tf2_msgs::TFMessageConstPtr& m) { guard([&] { frames_->add(*m, false); }); });
    if (node_.drop_frames)
      age_timer_ = handle.createWallTimer(ros::WallDuration(parameters_.max_age / 4),
                                          [this](const ros::WallTimerEvent&) { guard([&] { checkAge(); }); });
  }

  template <class Message>
  ros::Publisher advertise(const std::string& topic, uint32_t queue) {
    return getNodeHandle().advertise<Message>(topic, queue, onConnection(), onConnection());
  }

  // Nobody can tell who listens to a transform, so with publish_tf the chain always runs.
  bool wanted() const override {
    return node_.publish_tf ||
           estimate_publisher_.getNumSubscribers() + range_publisher_.getNumSubscribers() +
                   pose_publisher_.getNumSubscribers() + twist_publisher_.getNumSubscribers() +
                   marker_publisher_.getNumSubscribers() >
               0;
  }
  void subscribe() override {
    feed<0, StereoDepth>(kStereoDepth, *pairing_, subscribers_);
    feed<1, ApproachAngle>(kApproachAngle, *pairing_, subscribers_);
    feed<2, sensor_msgs::CameraInfo>(kLeftInfo, *pairing_, subscribers_);
    feed<3, sensor_msgs::CameraInfo>(kRightInfo, *pairing_, subscribers_);
  }
  void unsubscribe() override {
    subscribers_.clear();
    pairing_->reset();
    const std::lock_guard<std::mutex> lock(rig_mutex_);
    frame_complaint_.clear();
  }
  void forget() override {
    cameras_ = RigWatch();
    stage_.reset();
    path_.reset();
  }
  std::vector<InputWatch::Input> inputs() const override { return pairing_->inputs(); }
  std::string complaint() override { return pairing_->complaint(); }
  void complainMore() override {
    if (!valid_lately_ && !last_reason_.empty())
      NODELET_WARN("%s: no valid estimate for %.3g s: %s", getName().c_str(), node_.complaint_period,
                   last_reason_.c_str());
    valid_lately_ = false;
    last_reason_.clear();
    complainOfFrames();
    if (clockIsMissing())
      NODELET_WARN("%s: /use_sim_time is set and nobody publishes /clock", getName().c_str());
  }

  /// The estimate may be valid nevertheless, so this is not logged every time.
  void complainOfFrames() {
    const std::lock_guard<std::mutex> lock(rig_mutex_);
    if (frame_reminder_.due(frame_complaint_))
      NODELET_WARN("%s: %s", getName().c_str(), frame_complaint_.c_str());
  }

  void describe(diagnostic_updater::DiagnosticStatusWrapper& status) override {
    constexpr const char* kNames[] = {"rig pitch (deg)", "rig yaw (deg)", "rig roll (deg)"};
    constexpr double kDegrees = 180 / M_PI;
    const std::lock_guard<std::mutex> lock(rig_mutex_);
    if (!frame_complaint_.empty())
      status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN, frame_complaint_);
    if (std::isfinite(protection_level_))
      status.addf("height protection level (m)", "%.3f of %.3f, by %s", protection_level_, alert_limit_,
                  protection_source_.c_str());
    else
      status.add("height protection level (m)", "unknown: there is no height");
    status.add("filter resets", resets_);
    for (const TestResult& test : test_results_) {
      if (test.possible())
        status.addf("test " + test.name, "%.3g of %.3g, %d failures in a row", test.ratio, test.limit,
                    test.consecutive_failures);
    }
    if (!rig_rotation_.known()) return;
    for (int i = 0; i < 3; ++i)
      status.addf(kNames[i], "%.4f +- %.4f", rig_rotation_.w[i] * kDegrees,
                  std::sqrt(rig_rotation_.covariance(i, i)) * kDegrees);
  }

  void process(const StereoDepth& stereo, const ApproachAngle& approach,
               const sensor_msgs::CameraInfo& left_info, const sensor_msgs::CameraInfo& right_info) {
    last_pair_ = now();
    last_stamp_ = stereo.header.stamp;
    double compute_ms = stereo.compute_ms + approach.compute_ms;
    const ApproachAngleResult approach_result = toResult(approach);
    GroundPlane plane;
    LandingResult camera = attempt<LandingResult>([&]() -> Expected<LandingResult> {
      const Failure wrong_cameras = prepare(left_info, right_info);
      if (wrong_cameras) return tl::make_unexpected(wrong_cameras);
      const StereoDepthResult stereo_result = toResult(stereo);
      plane = stereo_result.plane;
      LandingResult result = stage_->process(stereo_result, approach_result);
      compute_ms += stage_->timings().total();
      return result;
    });
    camera.stamp = stereo.header.stamp.toSec();
    const LandingResult estimate =
        publish(stereo, compute_ms, camera, plane, approach_result.step, left_info);
    report_.served(stereo.header.stamp, compute_ms, estimate.failure.message());
    const std::lock_guard<std::mutex> lock(rig_mutex_);
    rig_rotation_ = estimate.rig_rotation;
    test_results_ = estimate.tests;
    protection_level_ = estimate.height_protection_level;
    alert_limit_ = estimate.height_alert_limit;
    protection_source_ = estimate.protection_source;
    resets_ = estimate.resets;
  }

  Failure prepare(const sensor_msgs::CameraInfo& left_info, const sensor_msgs::CameraInfo& right_info) {
    if (cameras_.changed(left_info, right_info)) {
      stage_.reset();
      const auto rig = makeStereoRig(cameras_.left(), cameras_.right(), shared_.rig);
      warnOfRig(ofCameraInfo(rigWarnings(cameras_.left(), cameras_.right(), shared_.rig)));
      rig_failure_ = rig ? Failure() : ofCameraInfo(rig.error());
      if (rig) stage_.emplace(*rig, parameters_, shared_.runway, shared_.rig);
    }
    return rig_failure_;
  }

  /// Publishes the estimate and returns it. It is that of the child frame, and not valid when its transform
  /// is missing.
  LandingResult publish(const StereoDepth& stereo, double compute_ms, const LandingResult& camera,
                        const GroundPlane& plane, const ApproachAngleResult::Motion& step,
                        const sensor_msgs::CameraInfo& left_info) {
    left_frame_ = left_info.header.frame_id;
    const RigFrames::Child child = frames_->find(left_frame_);
    // R of camera_info turns the camera as it is mounted into the rectified one.
    const Eigen::Isometry3d rectified_from_left(Eigen::Quaterniond(cameras_.left().R));
    const Eigen::Isometry3d rectified_from_child =
        child.left_from_child ? rectified_from_left * *child.left_from_child : Eigen::Isometry3d::Identity();
    const Eigen::Vector3d lever_arm = rectified_from_child.translation();
    LandingResult estimate =
        child.left_from_child ? referTo(lever_arm, camera, plane, step, parameters_) : camera;
    if (const Failure failure = failureOfFrames(child, rectified_from_child.linear(), camera)) {
      estimate.failure = failure;
      estimate.height_valid = estimate.angle_valid = false;
      estimate.forgetPosition();
      estimate.forgetVelocity();
    }
    note(estimate);
    noteFrames(child, stereo.header.frame_id);

    std_msgs::Header header = stereo.header;
    header.frame_id = node_.runway_frame;
    estimate_publisher_.publish(boost::make_shared<LandingEstimate>(
        toMessage(estimate, header, child.frame, stereo.skew, compute_ms)));
    range_publisher_.publish(heightMessage(estimate, stereo.header.stamp, child.frame));
    const std::optional<BodyTwist> twist =
        bodyTwist(camera, step.duration, parameters_.acceleration_stddev, rectified_from_child);
    if (estimate.height_valid && twist)
      twist_publisher_.publish(twistMessage(stereo.header.stamp, child.frame, *twist));

    const std::optional<RunwayPath::Position> place = path_.update(camera);
    const bool placed = place && estimate.height_valid;
    const Eigen::Matrix3d runway_from_camera = runwayFromCamera(camera);
    if (placed) {
      Eigen::Isometry3d runway_from_child = Eigen::Isometry3d::Identity();
      runway_from_child.linear() = runway_from_camera * rectified_from_child.linear();
      runway_from_child.translation() = place->position + runway_from_camera * lever_arm;
      pose_publisher_.publish(
          poseMessage(header, runway_from_child, poseCovariance(camera, plane, lever_arm, place->variance)));
      if (child.may_broadcast) broadcast(header, child.frame, runway_from_child);
    }
    if (marker_publisher_.getNumSubscribers() > 0) {
      std::optional<DrawnAircraft> aircraft;
      if (placed)
        aircraft = {place->position,
                    {std::sqrt(place->variance.x()), std::sqrt(place->variance.y()),
                     std::sqrt(camera.height_variance)},
                    runway_from_camera};
      show(drawLanding(header, node_, estimate, aircraft, (runway_from_camera * camera.velocity).head<2>(),
                       path_.track(), path_.runwayWidth()));
    }
    return estimate;
  }

  void broadcast(const std_msgs::Header& header, const std::string& child_frame,
                 const Eigen::Isometry3d& runway_from_child) {
    // There is one transform per stamp, because the pairing drops repeated stamps.
    if (!node_.publish_tf || !runway_from_child.matrix().allFinite()) return;
    geometry_msgs::TransformStamped transform = tf2::eigenToTransform(runway_from_child);
    transform.header = header;
    transform.child_frame_id = child_frame;
    broadcaster_->sendTransform(transform);
  }

  static bool clockIsMissing() { return ros::Time::isSimTime() && ros::Time::now().isZero(); }
  /// Returns ROS time, or the machine's time while /use_sim_time is set and nobody publishes /clock.
  static ros::Time now() {
    if (!clockIsMissing()) return ros::Time::now();
    const ros::WallTime wall = ros::WallTime::now();
    return {wall.sec, wall.nsec};
  }

  /// When no pair came for max_age, publishes that there is no estimate. It does so once per max_age of the
  /// clock.
  void checkAge() {
    if (clockIsMissing() && last_stamp_.isZero()) return;  // a bag may be about to begin
    const ros::Time now = KalmanHeightNodelet::now();
    const ros::Duration max_age(parameters_.max_age);
    if (last_pair_.isZero() || now < last_pair_) last_pair_ = now;  // just started, or the clock was set back
    if (now < last_timeout_) last_timeout_ = now;
    if (now - std::max(last_pair_, last_timeout_) < max_age) return;
    last_timeout_ = now;
    // The stamp is in the clock of the images, which may differ from this machine's clock. For a stamp at the
    // end of the range the sum would throw.
    const ros::Duration age = now - last_pair_;
    const bool own_clock = !last_stamp_.isZero() && last_stamp_ < ros::TIME_MAX - age;
    const ros::Time stamp = own_clock ? last_stamp_ + age : now;
    LandingResult lost;
    if (stage_) {
      lost = stage_->timeout(stamp.toSec());
    } else {
      lost.stamp = stamp.toSec();
      lost.status = Status::kLost;
      lost.failure = {Reason::kTimeout, last_stamp_.isZero() ? "no image pair yet, see the log of rectify"
                                                             : "no image pair any more"};
      lost.yaw_failure = lost.failure;
    }
    note(lost);
    std_msgs::Header header;
    header.stamp = stamp;
    header.frame_id = node_.runway_frame;
    const std::string child = stage_ ? frames_->find(left_frame_).frame : "";
    estimate_publisher_.publish(
        boost::make_shared<LandingEstimate>(toMessage(lost, header, child, kUnknown, 0)));
    range_publisher_.publish(heightMessage(lost, stamp, child));
    if (marker_publisher_.getNumSubscribers() > 0) {
      LandingScene scene = drawLanding(header, node_, lost, std::nullopt, Eigen::Vector2d::Zero(),
                                       path_.track(), path_.runwayWidth());
      // The images may have another clock. tf would then ignore their older transforms.
      if (!own_clock) scene.view.header.stamp = ros::Time(0, 1);
      show(scene);
    }
  }

  void show(const LandingScene& scene) {
    marker_publisher_.publish(scene.markers);
    broadcaster_->sendTransform(scene.view);
  }

  void note(const LandingResult& estimate) {
    valid_lately_ = valid_lately_ || estimate.valid();
    if (!estimate.valid()) last_reason_ = estimate.failure.message();
  }

  Failure failureOfFrames(const RigFrames::Child& child, const Eigen::Matrix3d& rectified_from_child,
                          const LandingResult& camera) const {
    if (child.failure) return child.failure;
    if (rig_failure_) return {};  // R of such a camera_info may be no rotation
    return wrongTilt(child, rectified_from_child, camera, left_frame_);
  }

  /// image_frame: frame_id of the left image.
  void noteFrames(const RigFrames::Child& child, const std::string& image_frame) {
    const std::lock_guard<std::mutex> lock(rig_mutex_);
    frame_complaint_ = child.complaint;
    if (frame_complaint_.empty() && image_frame.empty())
      frame_complaint_ = "the frame_id of the left image is empty, that of its camera_info is used";
  }

  KalmanHeightParameters parameters_;
  std::unique_ptr<RigFrames> frames_;
  std::unique_ptr<Inputs> pairing_;
  std::vector<ros::Subscriber> subscribers_;
  ros::Subscriber tf_subscriber_, tf_static_subscriber_;
  ros::Publisher estimate_publisher_, range_publisher_, pose_publisher_, twist_publisher_, marker_publisher_;
  std::unique_ptr<tf2_ros::TransformBroadcaster> broadcaster_;
  ros::WallTimer age_timer_;

  RigWatch cameras_;
  Failure rig_failure_;
  std::optional<KalmanHeightStage> stage_;
  RunwayPath path_;
  std::string left_frame_;
  ros::Time last_pair_, last_timeout_;  // by now()
  ros::Time last_stamp_;                // of the last pair
  std::mutex rig_mutex_;
  // Values of the last pair, for the diagnostics.
  RigRotation rig_rotation_;
  std::vector<TestResult> test_results_;
  double protection_level_ = kUnknown, alert_limit_ = kUnknown;
  std::string protection_source_, frame_complaint_;
  int resets_ = 0;
  Reminder frame_reminder_;
  bool valid_lately_ = false;
  std::string last_reason_;
};

}  // namespace uav_landing

PLUGINLIB_EXPORT_CLASS(uav_landing::KalmanHeightNodelet, nodelet::Nodelet)
