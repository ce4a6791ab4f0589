#include <image_transport/image_transport.h>
#include <sensor_msgs/TimeReference.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <deque>
#include <optional>
#include <pluginlib/class_list_macros.hpp>
#include <thread>

#include "camera_info.h"
#include "image_input.h"
#include "image_pool.h"
#include "pairing.h"
#include "pairs_in_flight.h"
#include "picture_watch.h"
#include "rig_watch.h"
#include "stage_nodelet.h"
#include "uav_landing/base/timings.h"
#include "uav_landing/geometry/camera_pair.h"
#include "uav_landing/image/rectification.h"

namespace uav_landing {

/// Pairs and rectifies the images of two cameras.
/// Parameters: RectifyParameters; camera, left_image, left_info, right_image, right_info, image_transport,
/// drop_frames, backlog and the common ones of NodeParameters.
/// Subscribes CAMERA/{left,right}/{image_raw, camera_info}, or the topics that are named, while somebody
/// wants the output. A pair that repeats the images of the previous one is skipped, if all pairs come
/// repeatedly.
/// Publishes {left,right}/{image_rect (mono8), camera_info} and right/time_reference. All have the stamp of
/// the left image and the frames of the cameras. The time reference contains the stamp of the right image
/// (the skew). A pair with an unusable image or calibration is dropped, and the log says what is wrong with
/// it.
///
/// camera_info is passed on as it came, with two exceptions (see workingPair()). For a rig that is mounted
/// upside down, left and right are exchanged, and camera_info is that of the rectified pair turned upright.
/// For a slanted baseline, it is that of the levelled pair.
class RectifyNodelet : public StageNodelet {
 public:
  RectifyNodelet() : StageNodelet("rectify") {}
  ~RectifyNodelet() override {
    stop();
    stopping_ = true;
    job_came_.notify_all();
    if (worker_.joinable()) worker_.join();
  }

 private:
  /// Each stage works on one pair, and one pair waits.
  static constexpr size_t kPairsInFlight = 3;
  static constexpr uint32_t kOutputQueue = 20;
  static constexpr size_t kRowsLookedAt = 20;  // one in so many pairs is looked at

  struct Job {
    sensor_msgs::ImageConstPtr left, right;
    sensor_msgs::CameraInfoConstPtr left_info, right_info;
  };
  struct View {
    std::string camera;  // left or right, as in its topics
    std::string topic;   // of the raw image
    image_transport::Subscriber image_subscriber;
    ros::Subscriber info_subscriber;
    image_transport::Publisher image_publisher;
    ros::Publisher info_publisher;
    std::optional<CameraCalibration> calibration;  // of the rectifier
    Expected<Rectifier> rectifier = tl::make_unexpected(Failure{Reason::kNotYet, ""});
  };

  void setUp() override {
    parameters_ = loadParametersOrThrow<RectifyParameters>();
    range_ = PairGreyRange(shared_.rig.bits);
    RectifyParameters pairing = parameters_;
    // Recorded pairs are processed in order and completely. The four inputs come from four connections, and
    // one may be far ahead of the others.
    if (!node_.drop_frames) pairing.queue_size = std::max(pairing.queue_size, node_.backlog);
    input_queue_ = static_cast<uint32_t>(pairing.queue_size);

    transport_ = std::make_unique<image_transport::ImageTransport>(getNodeHandle());
    checkTransport();
    advertise("left", left_);
    advertise("right", right_);
    skew_publisher_ = getNodeHandle().advertise<sensor_msgs::TimeReference>(
        "right/time_reference", kOutputQueue, onConnection(), onConnection());
    in_flight_ = PairsInFlight::of(getNodeHandle().resolveName("left/image_rect"));
    pairing_ = std::make_unique<StereoPairing>(
        pairing, std::vector<std::string>{left_.topic, infoTopic(left_), right_.topic, infoTopic(right_)},
        [this](const auto& left, const auto& left_info, const auto& right, const auto& right_info) {
          enqueue({left, right, left_info, right_info});
        });
    worker_ = std::thread([this] { work(); });
  }

  // A transport that is not installed is refused here. Otherwise subscribing would throw, in any thread in
  // which a subscriber connects.
  void checkTransport() {
    const std::vector<std::string> there = transport_->getLoadableTransports();
    if (std::find(there.begin(), there.end(), "image_transport/" + node_.image_transport) == there.end())
      refuseToLoad("rectify/image_transport: no transport '" + node_.image_transport +
                   "' is installed, see rosrun image_transport list_transports");
  }

  std::string infoTopic(const View& view) const {
    const std::string& named = view.camera == "left" ? node_.left_info : node_.right_info;
    return getNodeHandle().resolveName(named.empty() ? node_.camera + "/" + view.camera + "/camera_info"
                                                     : named);
  }

  void advertise(const std::string& side, View& view) {
    view.camera = !shared_.rig.upside_down ? side : side == "left" ? "right" : "left";
    const std::string& named = view.camera == "left" ? node_.left_image : node_.right_image;
    view.topic =
        getNodeHandle().resolveName(named.empty() ? node_.camera + "/" + view.camera + "/image_raw" : named);
    const image_transport::SubscriberStatusCallback changed =
        [this](const image_transport::SingleSubscriberPublisher&) { updateSubscription(); };
    view.image_publisher = transport_->advertise(side + "/image_rect", kOutputQueue, changed, changed);
    view.info_publisher = getNodeHandle().advertise<sensor_msgs::CameraInfo>(
        side + "/camera_info", kOutputQueue, onConnection(), onConnection());
  }

  bool wanted() const override {
    return left_.image_publisher.getNumSubscribers() + right_.image_publisher.getNumSubscribers() +
               left_.info_publisher.getNumSubscribers() + right_.info_publisher.getNumSubscribers() +
               skew_publisher_.getNumSubscribers() >
           0;
  }

  void subscribe() override {
    subscribeView<0>(left_);
    subscribeView<2>(right_);
  }

  template <size_t kInput>
  void subscribeView(View& view) {
    const auto no_delay = ros::TransportHints().tcpNoDelay();
    view.image_subscriber = transport_->subscribe(
        view.topic, input_queue_,
        boost::function<void(const sensor_msgs::ImageConstPtr&)>(
            [this](const sensor_msgs::ImageConstPtr& image) {
              guard([&] { pairing_->add<kInput>(image); });
            }),
        ros::VoidPtr(),
        image_transport::TransportHints(node_.image_transport, no_delay, getPrivateNodeHandle()));
    view.info_subscriber = getNodeHandle().subscribe<sensor_msgs::CameraInfo>(
        infoTopic(view), input_queue_,
        [this](const sensor_msgs::CameraInfoConstPtr& info) {
          guard([&] { pairing_->add<kInput + 1>(info); });
        },
        ros::VoidConstPtr(), no_delay);
  }

  void unsubscribe() override {
    for (View* view : {&left_, &right_}) {
      view->image_subscriber.shutdown();
      view->info_subscriber.shutdown();
    }
    pairing_->reset();
  }

  std::vector<InputWatch::Input> inputs() const override { return pairing_->inputs(); }
  std::string complaint() override { return pairing_->complaint(); }
  void forget() override { renew_range_ = true; }

  void enqueue(Job job) {
    const std::lock_guard<std::mutex> lock(jobs_mutex_);
    jobs_.push_back(std::move(job));
    const size_t most = node_.drop_frames ? 1 : static_cast<size_t>(node_.backlog);
    while (jobs_.size() > most) {
      jobs_.pop_front();
      report_.dropped();
    }
    job_came_.notify_all();
  }

  void work() {
    using std::chrono::milliseconds;
    while (!stopping_) {
      {
        std::unique_lock<std::mutex> lock(jobs_mutex_);
        if (!job_came_.wait_for(lock, milliseconds(100), [this] { return stopping_ || !jobs_.empty(); }))
          continue;
      }
      // Wait before taking the job, so that it is the newest one.
      if (!in_flight_->waitUntilBelow(kPairsInFlight, milliseconds(100))) continue;
      Job job;
      {
        const std::lock_guard<std::mutex> lock(jobs_mutex_);
        if (jobs_.empty()) continue;
        job = std::move(jobs_.front());
        jobs_.pop_front();
      }
      guard([&] { process(job); });
    }
  }

  void process(const Job& job) {
    const bool repetition = pictures_.isRepetition(job.left, job.right);
    for (const std::string& news : pictures_.news()) NODELET_WARN("%s: %s", getName().c_str(), news.c_str());
    if (repetition) return;
    followCameras(*job.left_info, *job.right_info);
    if (wrong_rig_) return refuse(wrong_rig_.detail);
    followGreyRange(job);
    Timings timings;
    sensor_msgs::ImagePtr left, right;
    {
      const ScopedTimer timer(timings, "rectify");
      // Both are tried, so that the log names both when both are wrong.
      left = rectify(left_, job.left, working_.left);
      right = rectify(right_, job.right, working_.right);
    }
    if (!left || !right) return;
    const ros::Time stamp = job.left->header.stamp;
    report_.served(stamp, timings.total(), "");
    in_flight_->handedOn(stamp);
    publish(job, left, right);
  }

  using StageNodelet::refuse;
  /// Logs what is wrong with a camera's calibration.
  void refuse(const View& view, const Failure& failure) {
    refuse(ofCameraInfo({failure.reason, view.camera + " " + failure.detail}).detail + " (" +
           infoTopic(view) + ")");
  }

  /// Makes the working pair of new cameras. Calibrations that do not make a pair are passed on as they are,
  /// and the stages behind say what is wrong. But an upside-down pair stops here, because those stages would
  /// take it for another one.
  void followCameras(const sensor_msgs::CameraInfo& left, const sensor_msgs::CameraInfo& right) {
    if (!cameras_.changed(left, right)) return;
    const bool exchanged = shared_.rig.upside_down;
    const CameraCalibration& given_left = exchanged ? cameras_.right() : cameras_.left();
    const CameraCalibration& given_right = exchanged ? cameras_.left() : cameras_.right();
    warnOfRig(ofCameraInfo(rigWarnings(given_left, given_right, shared_.rig)));
    const Expected<CameraPair> working = workingPair(given_left, given_right, shared_.rig);
    working_ = working ? *working : CameraPair{cameras_.left(), cameras_.right()};
    wrong_rig_ = exchanged && !working ? ofCameraInfo(working.error()) : Failure();
  }

  void followGreyRange(const Job& job) {
    if (renew_range_.exchange(false)) range_.reset();
    const GreyRange before = range_.range();
    const std::string news = range_.follow(job.left, working_.left, job.right, working_.right);
    if (!news.empty()) NODELET_WARN("%s: %s", getName().c_str(), news.c_str());
    if (range_.range() != before) NODELET_INFO("%s: %s", getName().c_str(), toText(range_.range()).c_str());
  }

  /// The rectified image, or null when the input cannot be used.
  sensor_msgs::ImagePtr rectify(View& view, const sensor_msgs::ImageConstPtr& raw,
                                const CameraCalibration& calibration) {
    if (const Failure failure = checkCalibration(calibration)) {
      refuse(view, failure);
      return nullptr;
    }
    // The image is checked before the rectifier is made. Maps of a size that no image has would fill the
    // memory.
    const auto mono = toMono8(raw, calibration, view.topic, range_.range());
    if (!mono) {
      refuse(mono.error().detail);
      return nullptr;
    }
    if (const Failure failure = checkPrincipalPoint(calibration, shared_.rig)) {
      refuse(view, failure);
      return nullptr;
    }
    if (calibration != view.calibration) {
      if (view.calibration) NODELET_WARN("%s: the camera_info changed: starting anew", view.topic.c_str());
      view.rectifier = Rectifier::create(calibration);
      view.calibration = calibration;
    }
    if (!view.rectifier) {
      refuse(view, view.rectifier.error());
      return nullptr;
    }
    const cv::Size size = view.calibration->imageSize();
    const sensor_msgs::ImagePtr message = pool_.take();
    message->header = raw->header;
    message->width = static_cast<uint32_t>(size.width);
    message->height = static_cast<uint32_t>(size.height);
    message->encoding = sensor_msgs::image_encodings::MONO8;
    message->is_bigendian = 0;
    message->step = message->width;
    message->data.resize(static_cast<size_t>(message->step) * message->height);
    if (&view == &left_ && looked_++ % kRowsLookedAt == 0) pictures_.look((*mono)->image, view.topic);
    cv::Mat rectified(size, CV_8UC1, message->data.data());
    const Failure failure = view.rectifier->rectify((*mono)->image, rectified);
    if (failure) {
      refuse(view.topic + ": " + failure.detail);
      return nullptr;
    }
    return message;
  }

  void publish(const Job& job, const sensor_msgs::ImagePtr& left, const sensor_msgs::ImagePtr& right) {
    const ros::Time stamp = job.left->header.stamp;
    right->header.stamp = stamp;
    const auto skew = boost::make_shared<sensor_msgs::TimeReference>();
    skew->header = right->header;
    skew->time_ref = job.right->header.stamp;
    skew->source = job.right->header.frame_id;
    skew_publisher_.publish(skew);

    left_.info_publisher.publish(stampedInfo(job.left_info, cameras_.left(), working_.left, stamp));
    right_.info_publisher.publish(stampedInfo(job.right_info, cameras_.right(), working_.right, stamp));
    left_.image_publisher.publish(sensor_msgs::ImageConstPtr(left));
    right_.image_publisher.publish(sensor_msgs::ImageConstPtr(right));
  }

  static sensor_msgs::CameraInfoConstPtr stampedInfo(const sensor_msgs::CameraInfoConstPtr& info,
                                                     const CameraCalibration& given,
                                                     const CameraCalibration& working,
                                                     const ros::Time& stamp) {
    const bool same = working == given;
    if (same && info->header.stamp == stamp) return info;
    const auto stamped =
        boost::make_shared<sensor_msgs::CameraInfo>(same ? *info : toCameraInfo(working, info->header));
    stamped->header.stamp = stamp;
    return stamped;
  }

  RectifyParameters parameters_;
  uint32_t input_queue_ = 1;
  std::unique_ptr<image_transport::ImageTransport> transport_;
  View left_, right_;
  RigWatch cameras_;
  PictureWatch pictures_;
  size_t looked_ = 0;
  CameraPair working_;
  Failure wrong_rig_;  // why a rig that is upside down has no working pair
  PairGreyRange range_{0};
  std::atomic<bool> renew_range_{false};  // with the next pair
  ros::Publisher skew_publisher_;
  std::unique_ptr<StereoPairing> pairing_;
  std::shared_ptr<PairsInFlight> in_flight_;
  ImagePool pool_{4 * kPairsInFlight};

  std::mutex jobs_mutex_;
  std::condition_variable job_came_;
  std::deque<Job> jobs_;
  std::atomic<bool> stopping_{false};
  std::thread worker_;
};

}  // namespace uav_landing

PLUGINLIB_EXPORT_CLASS(uav_landing::RectifyNodelet, nodelet::Nodelet)
