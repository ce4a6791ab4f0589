#include "stage_report.h"

#include <algorithm>

#include "time_difference.h"

namespace uav_landing {
namespace {

using diagnostic_msgs::DiagnosticStatus;

}  // namespace

void StageReport::served(const ros::Time& stamp, double compute_ms, const std::string& reason) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++now_.served;
  ++served_;
  now_.compute_ms += compute_ms;
  now_.latency += secondsBetween(stamp, ros::Time::now());
  if (reason.empty()) return;
  ++now_.failed;
  now_.reason = reason;
}

void StageReport::dropped(uint64_t count) {
  const std::lock_guard<std::mutex> lock(mutex_);
  now_.dropped += count;
  dropped_ += count;
}

std::vector<std::string> StageReport::warned(const std::vector<std::string>& warnings) {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<std::string> news;
  for (const std::string& warning : warnings)
    if (std::find(warnings_.begin(), warnings_.end(), warning) == warnings_.end()) news.push_back(warning);
  warnings_ = warnings;
  return news;
}

void StageReport::refused(const std::string& problem) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++now_.refused;
  ++refused_;
  now_.problem = problem;
}

void StageReport::write(diagnostic_updater::DiagnosticStatusWrapper& status,
                        const std::vector<InputWatch::Input>& inputs, std::optional<double> subscribed) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const ros::WallTime now = ros::WallTime::now();
  const double seconds = std::max(1e-3, (now - since_).toSec());
  inputs_before_.resize(inputs.size());

  std::string silent;
  for (size_t i = 0; i < inputs.size(); ++i) {
    const uint64_t received = inputs[i].received - std::min(inputs[i].received, inputs_before_[i].received);
    if (received == 0) silent += (silent.empty() ? "" : ", ") + inputs[i].topic;
    status.addf(inputs[i].topic, "%.1f Hz; %lu received, %lu paired, %lu dropped, %lu of them late",
                static_cast<double>(received) / seconds, static_cast<unsigned long>(inputs[i].received),
                static_cast<unsigned long>(inputs[i].paired), static_cast<unsigned long>(inputs[i].dropped),
                static_cast<unsigned long>(inputs[i].late));
  }
  const std::string shortage = InputWatch::shortage(inputs, inputs_before_);
  inputs_before_ = inputs;

  if (!subscribed) {
    status.summary(DiagnosticStatus::OK, "idle: nobody subscribes");
  } else if (now_.refused > 0) {
    status.summary(DiagnosticStatus::ERROR, now_.problem);
  } else if (now_.served == 0 && *subscribed < seconds) {
    status.summary(DiagnosticStatus::OK, "has just subscribed");
  } else if (now_.served == 0) {
    status.summary(DiagnosticStatus::ERROR, silent.empty() ? "nothing pairs up" : "no message on " + silent);
  } else if (now_.failed > 0) {
    status.summary(DiagnosticStatus::WARN, now_.reason);
  } else if (!shortage.empty()) {
    status.summary(DiagnosticStatus::WARN, shortage);
  } else if (now_.dropped > 0) {
    status.summary(DiagnosticStatus::WARN, "too slow: pairs are dropped");
  } else {
    status.summary(DiagnosticStatus::OK, "running");
  }

  if (subscribed)
    for (const std::string& warning : warnings_) status.mergeSummary(DiagnosticStatus::WARN, warning);

  const auto count = static_cast<double>(std::max<uint64_t>(1, now_.served));
  status.addf("rate", "%.1f Hz", static_cast<double>(now_.served) / seconds);
  status.addf("compute time", "%.2f ms", now_.compute_ms / count);
  if (const double latency = 1e3 * now_.latency / count; latency >= 0)
    status.addf("latency behind the image stamp", "%.1f ms", latency);
  else
    status.addf("latency behind the image stamp", "unknown: the stamps are %.1f ms ahead of this clock",
                -latency);
  status.add("pairs served", served_);
  status.add("pairs without a result, of late", now_.failed);
  status.add("pairs dropped", dropped_);
  status.add("inputs refused", refused_);
  now_ = Counts();
  since_ = now;
}

}  // namespace uav_landing
