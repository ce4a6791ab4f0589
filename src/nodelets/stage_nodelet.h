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

/// Messages that a stage may be behind. Much more than the pairs in flight, so that nothing is lost between
/// stages.
constexpr uint32_t kStageQueue = 20;

/// For a complaint that lasts: when to say it again.
class Reminder {
 public:
  /// True when this is another complaint than at the last call, or was said a minute ago. "": there is none.
  bool due(const std::string& complaint);

 private:
  std::string last_;
  ros::WallTime said_;
};

/// What all nodelets of the chain share: parameters, those of rig and runway as well, are checked before
/// anything is subscribed; inputs are
/// subscribed while somebody wants the output; a missing input is named in the log; diagnostics; no exception
/// leaves a callback; topics between nodelets of one process are linked once.
class StageNodelet : public nodelet::Nodelet {
 protected:
  /// section: of the parameters, and the name in diagnostics.
  explicit StageNodelet(const char* section) : section_(section) {}

  /// Loads the parameters, creates what needs them, advertises with onConnection(). In a process only one
  /// nodelet at a time is in here or in subscribe(), so neither may wait for callbacks or other nodelets.
  virtual void setUp() = 0;
  /// Somebody wants the output.
  virtual bool wanted() const = 0;
  /// In the callbacks' thread, like unsubscribe(); that one also in the thread that destroys the nodelet.
  virtual void subscribe() = 0;
  virtual void unsubscribe() = 0;
  /// Counts per input, and why nothing was paired since the last call ("" when something was).
  virtual std::vector<InputWatch::Input> inputs() const = 0;
  virtual std::string complaint() = 0;
  /// More for the log, once per complaint_period.
  virtual void complainMore() {}
  /// Service ~reset: what earlier pairs left behind is forgotten; messages that wait to be paired stay. Runs
  /// like a callback.
  virtual void forget() {}
  /// Values of its own for the diagnostics; called by a timer.
  virtual void describe(diagnostic_updater::DiagnosticStatusWrapper&) {}

  /// Reads those that the nodelets share into shared_, and the private parameters, also into node_. Throws
  /// with the parameter's name, so that the nodelet is not loaded.
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

  /// The masks that rig/left_mask and rig/right_mask name, after loadParametersOrThrow(). Throws likewise.
  RigMasks loadMasksOrThrow();

  /// Throws what setUp() is to throw, after it is in the log.
  [[noreturn]] void refuseToLoad(const std::string& problem);

  /// For publishers: (un)subscribes as subscribers come and go.
  ros::SubscriberStatusCallback onConnection();
  void updateSubscription();

  /// Runs a callback's work; an exception is logged and counted.
  template <class Work>
  void guard(Work&& work) {
    try {
      work();
    } catch (const std::exception& error) {
      refuse(error.what());
    }
  }
  /// The result of a stage, which is a failure also when it could not be computed at all: there is a message
  /// for every pair.
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
  /// Counts an input that cannot be used and says why, in the log at most once per complaint_period.
  void refuse(const std::string& problem);

  /// Puts a failure that a person has to mend (wrong input, cameras swapped) in the log, as refuse() does.
  void warnOf(const Failure& failure);

  /// What is unlikely about the calibrations, from now on: in the diagnostics as long as it holds, in the log
  /// once.
  void warnOfRig(const std::vector<std::string>& warnings);

  /// How everything behind rectify is paired: that has left out what was late.
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

  /// To be called first by every destructor: no callback runs afterwards.
  void stop();

  NodeParameters node_;
  SharedParameters shared_;
  StageReport report_;

 private:
  void onInit() final;
  void subscribeIfWanted();
  /// Since when the inputs are subscribed, s; none while nobody wants the output.
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
  ros::WallTime last_refusal_;  // logged
};

}  // namespace uav_landing
