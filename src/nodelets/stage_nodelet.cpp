#include "stage_nodelet.h"

#include <algorithm>
#include <stdexcept>

namespace uav_landing {
namespace {

constexpr double kRepeatAfter = 60;  // s, after which the same complaint is logged again

// A nodelet holds this mutex while it advertises or subscribes. While one thread subscribes a topic and waits
// for the master's answer, another one may advertise it. roscpp then links the two in both calls, because
// neither looks for an existing link (TopicManager). Every message would come twice.
//
// It is locked after a nodelet's own mutex. It must not be held while waiting for callbacks, so unsubscribe()
// does not lock it.
std::mutex topics_mutex;

}  // namespace

bool Reminder::due(const std::string& complaint) {
  const ros::WallTime now = ros::WallTime::now();
  const bool repeated = complaint == last_ && (now - said_).toSec() < kRepeatAfter;
  last_ = complaint;
  if (complaint.empty() || repeated) return false;
  said_ = now;
  return true;
}

void StageNodelet::onInit() {
  {
    // Subscribers may connect while the publishers are still being created.
    const std::lock_guard<std::mutex> lock(subscription_mutex_);
    const std::lock_guard<std::mutex> alone(topics_mutex);
    setUp();
  }
  updater_ =
      std::make_unique<diagnostic_updater::Updater>(getNodeHandle(), getPrivateNodeHandle(), getName());
  updater_->setHardwareID("none");
  updater_->add(section_, [this](diagnostic_updater::DiagnosticStatusWrapper& status) {
    report_.write(status, inputs(), subscribedFor());
    describe(status);
  });
  // Wall time is used, because a ROS clock that stands still is one of the problems to report.
  ros::NodeHandle& handle = getNodeHandle();
  complaint_timer_ = handle.createWallTimer(ros::WallDuration(node_.complaint_period),
                                            [this](const ros::WallTimerEvent&) { complain(); });
  diagnostic_timer_ = handle.createWallTimer(ros::WallDuration(node_.diagnostic_period),
                                             [this](const ros::WallTimerEvent&) { diagnose(); });
  reset_service_ = getPrivateNodeHandle().advertiseService<std_srvs::EmptyRequest, std_srvs::EmptyResponse>(
      "reset", [this](std_srvs::EmptyRequest&, std_srvs::EmptyResponse&) {
        guard([this] { forget(); });
        NODELET_INFO("%s: reset", getName().c_str());
        return true;
      });
  // This does not run in this thread, because a callback must not run while its subscriber is still being
  // stored.
  start_timer_ = handle.createWallTimer(
      ros::WallDuration(0.001), [this](const ros::WallTimerEvent&) { updateSubscription(); }, true);
}

RigMasks StageNodelet::loadMasksOrThrow() {
  const Failure relative = resolveFiles(node_, shared_.rig);
  if (relative) refuseToLoad(relative.detail);
  const Expected<RigMasks> masks = loadRigMasks(shared_.rig);
  if (!masks) refuseToLoad(masks.error().detail);
  return *masks;
}

void StageNodelet::refuseToLoad(const std::string& problem) {
  NODELET_FATAL("%s: %s", getName().c_str(), problem.c_str());
  throw std::invalid_argument(getName() + ": " + problem);
}

ros::SubscriberStatusCallback StageNodelet::onConnection() {
  return [this](const ros::SingleSubscriberPublisher&) { updateSubscription(); };
}

void StageNodelet::updateSubscription() {
  guard([this] { subscribeIfWanted(); });
}

void StageNodelet::subscribeIfWanted() {
  const std::lock_guard<std::mutex> lock(subscription_mutex_);
  if (stopped_) return;
  const bool want = wanted();
  if (want == subscribed_) return;
  if (want) {
    const std::lock_guard<std::mutex> alone(topics_mutex);
    subscribe();
  } else {
    unsubscribe();
  }
  subscribed_ = want;
  subscribed_since_ = ros::WallTime::now();
}

std::optional<double> StageNodelet::subscribedFor() const {
  const std::lock_guard<std::mutex> lock(subscription_mutex_);
  if (!subscribed_) return std::nullopt;
  return (ros::WallTime::now() - subscribed_since_).toSec();
}

void StageNodelet::refuse(const std::string& problem) {
  report_.refused(problem);
  const std::lock_guard<std::mutex> lock(refusal_mutex_);
  const ros::WallTime now = ros::WallTime::now();
  if (!last_refusal_.isZero() && (now - last_refusal_).toSec() < node_.complaint_period) return;
  last_refusal_ = now;
  NODELET_ERROR("%s: %s", getName().c_str(), problem.c_str());
}

void StageNodelet::warnOf(const Failure& failure) {
  if (failure.reason == Reason::kInputInvalid || failure.reason == Reason::kNegativeDisparity)
    refuse(failure.message());
}

void StageNodelet::warnOfRig(const std::vector<std::string>& warnings) {
  for (const std::string& warning : report_.warned(warnings))
    NODELET_WARN("%s: %s", getName().c_str(), warning.c_str());
}

void StageNodelet::stop() {
  reset_service_.shutdown();
  start_timer_.stop();
  complaint_timer_.stop();
  diagnostic_timer_.stop();
  const std::lock_guard<std::mutex> lock(subscription_mutex_);
  if (subscribed_) unsubscribe();
  subscribed_ = false;
  stopped_ = true;
}

void StageNodelet::complain() {
  const std::optional<double> subscribed = subscribedFor();
  if (!subscribed || *subscribed < node_.complaint_period) return;
  const std::string missing = complaint();
  if (complaint_reminder_.due(missing))
    NODELET_WARN("%s: nothing to work on for %.3g s: %s", getName().c_str(), node_.complaint_period,
                 missing.c_str());
  const std::vector<InputWatch::Input> counts = inputs();
  const std::string shortage = missing.empty() ? InputWatch::shortage(counts, inputs_before_) : "";
  inputs_before_ = counts;
  // The numbers change all the time, so a shortage is logged once for the same topics.
  if (shortage_reminder_.due(shortage.substr(std::min(shortage.find("stamps"), shortage.size()))))
    NODELET_WARN("%s: %s", getName().c_str(), shortage.c_str());
  complainMore();
}

void StageNodelet::diagnose() {
  guard([this] { updater_->force_update(); });
}

}  // namespace uav_landing
