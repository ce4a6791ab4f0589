#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <nodelet/nodelet.h>
#include <ros/ros.h>
#include <std_srvs/Empty.h>

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "input_watch.h"
#include "node_parameters.h"
#include "stage_report.h"
#include "uav_landing/image/rig_masks.h"
#include "uav_landing/parameters/rectify_parameters.h"

namespace uav_landing {

// Topics between the nodelets, relative to their namespace.
constexpr char kLeftImage[] = "left/image_rect", kLeftInfo[] = "left/camera_info";
constexpr char kRightImage[] = "right/image_rect", kRightInfo[] = "right/camera_info";
constexpr char kRightTime[] = "right/time_reference";
constexpr char kStereoDepth[] = "stereo_depth", kApproachAngle[] = "approach_angle";
constexpr char kLandingEstimate[] = "landing_estimate";

/// Messages that a stage may be behind. It is much more than the pairs in flight, so that nothing is lost
/// between stages.
constexpr uint32_t kStageQueue = 20;

/// Tells when a lasting complaint has to be logged again.
class Reminder {
 public:
  /// True for a complaint that differs from that of the last call, or that was logged more than a minute ago.
  /// "": there is no complaint.
  bool due(const std::string& complaint);

 private:
  std::string last_;
  ros::WallTime said_;
};

/// Common part of all nodelets of the chain.
/// - Parameters, also those of rig and runway, are checked before anything is subscribed.
/// - Inputs are subscribed while somebody wants the output. The log names a missing input.
/// - It publishes diagnostics.
/// - No exception leaves a callback.
/// - Topics between nodelets of one process are linked once.
class StageNodelet : public nodelet::Nodelet {
 protected:
  /// section: name of the parameters' section, and in the diagnostics.
  explicit StageNodelet(const char* section) : section_(section) {}

  /// Loads the parameters, makes what needs them, and advertises with onConnection(). Only one nodelet of a
  /// process at a time runs this function or subscribe(). So neither may wait for callbacks or for other
  /// nodelets.
  virtual void setUp() = 0;
  /// Whether somebody wants the output.
  virtual bool wanted() const = 0;
  /// Both run in the callbacks' thread. unsubscribe() also runs in the thread that destroys the nodelet.
  virtual void subscribe() = 0;
  virtual void unsubscribe() = 0;
  /// Counts for each input, and the reason why nothing was paired since the last call ("" when something
  /// was).
  virtual std::vector<InputWatch::Input> inputs() const = 0;
  virtual std::string complaint() = 0;
  /// Further lines for the log, once per complaint_period.
  virtual void complainMore() {}
  /// Service ~reset. Forgets everything from earlier pairs, but keeps messages that wait to be paired. Runs
  /// like a callback.
  virtual void forget() {}
  /// Adds further values to the diagnostics. Called by a timer.
  virtual void describe(diagnostic_updater::DiagnosticStatusWrapper&) {}

  /// Reads the shared parameters into shared_, those of ROS into node_, and returns those of the section.
  /// Throws with the parameter's name, so that the nodelet is not loaded.
  template <class Section>
  Section loadParametersOrThrow() {
    const Failure shared_failure = loadSharedParameters(getNodeHandle(), shared_);
    if (shared_failure) refuseToLoad(shared_failure.detail);
    if (shared_.runway.width > 0) node_.drawn_runway_width = shared_.runway.width;
    if (shared_.runway.length > 0) node_.drawn_runway_length = shared_.runway.length;
    Section parameters;
    const Failure failure = loadParameters(getPrivateNodeHandle(), section_, parameters, node_);
    if (failure) refuseToLoad(failure.detail);
    return parameters;
  }

  /// The masks of rig/left_mask and rig/right_mask. Call it after loadParametersOrThrow(). It throws in the
  /// same way.
  RigMasks loadMasksOrThrow();

  /// Logs the problem, and throws the exception of setUp().
  [[noreturn]] void refuseToLoad(const std::string& problem);

  /// For publishers: subscribes and unsubscribes the inputs as subscribers come and go.
  ros::SubscriberStatusCallback onConnection();
  void updateSubscription();

  /// Runs the work of a callback; an exception is logged and counted.
  template <class Work>
  void guard(Work&& work) {
    try {
      work();
    } catch (const std::exception& error) {
      refuse(error.what());
    }
  }
  /// Computes the result of a stage. When this throws, the result is a failure, because every pair has a
  /// message.
  template <class Result, class Work>
  static Result attempt(Work&& work) {
    Result result;
    try {
      Expected<Result> processed = work();
      if (processed) return *std::move(processed);
      result.failure = processed.error();
    } catch (const std::exception& error) {
      result.failure = {Reason::kInputInvalid, error.what()};
    }
    return result;
  }
  /// Counts an input that cannot be used, and logs the reason, at most once per complaint_period.
  void refuse(const std::string& problem);

  /// Logs a failure that a person has to correct (wrong input, cameras swapped), as refuse() does.
  void warnOf(const Failure& failure);

  /// Sets the warnings about the calibrations from now on. The diagnostics show them as long as they hold,
  /// the log shows them once.
  void warnOfRig(const std::vector<std::string>& warnings);

  /// Parameters of pairing for the nodelets behind rectify, which has already dropped late messages.
  static RectifyParameters exactPairing() {
    RectifyParameters parameters;
    parameters.queue_size = kStageQueue;
    parameters.max_late = 0;
    return parameters;
  }
  std::vector<std::string> resolved(const std::vector<std::string>& topics) const {
    std::vector<std::string> names;
    for (const std::string& topic : topics) names.push_back(getNodeHandle().resolveName(topic));
    return names;
  }
  /// Subscribes one input of a pairing.
  template <size_t kInput, class Message, class Inputs>
  void feed(const std::string& topic, Inputs& inputs, std::vector<ros::Subscriber>& subscribers) {
    subscribers.push_back(getNodeHandle().subscribe<Message>(
        topic, kStageQueue,
        [this, &inputs](const boost::shared_ptr<const Message>& message) {
          guard([&] { inputs.template add<kInput>(message); });
        },
        ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay()));
  }

  /// Every destructor must call it first. No callback runs afterwards.
  void stop();

  NodeParameters node_;
  SharedParameters shared_;
  StageReport report_;

 private:
  void onInit() final;
  void subscribeIfWanted();
  /// Time since the inputs were subscribed, s; none while nobody wants the output.
  std::optional<double> subscribedFor() const;
  void complain();
  void diagnose();

  const std::string section_;
  mutable std::mutex subscription_mutex_;
  bool subscribed_ = false, stopped_ = false;
  ros::WallTime subscribed_since_;
  std::unique_ptr<diagnostic_updater::Updater> updater_;
  ros::WallTimer complaint_timer_, diagnostic_timer_, start_timer_;
  ros::ServiceServer reset_service_;
  Reminder complaint_reminder_, shortage_reminder_;
  std::vector<InputWatch::Input> inputs_before_;  // at the last complaint
  std::mutex refusal_mutex_;
  ros::WallTime last_refusal_;  // time of the last one that was logged
};

}  // namespace uav_landing
