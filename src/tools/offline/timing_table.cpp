#include "offline/timing_table.h"

#include <algorithm>
#include <cmath>
#include <iomanip>

namespace uav_landing {
namespace {

constexpr double kBinWidth = 1.01;
constexpr double kSmallest = 1e-4;  // ms; shorter times count as this

}  // namespace

void TimeStatistics::add(double ms) {
  ++histogram_[static_cast<int>(std::ceil(std::log(std::max(ms, kSmallest)) / std::log(kBinWidth)))];
  ++count_;
  total_ += ms;
  worst_ = std::max(worst_, ms);
}

double TimeStatistics::quantile(double share) const {
  std::size_t below = 0;
  for (const auto& [bin, times] : histogram_) {
    below += times;
    if (static_cast<double>(below) >= share * static_cast<double>(count_))
      return std::min(worst_, std::pow(kBinWidth, bin));
  }
  return worst_;
}

void TimingTable::add(const std::string& name, double ms) {
  const auto known =
      std::find_if(parts_.begin(), parts_.end(), [&](const auto& part) { return part.first == name; });
  if (known != parts_.end()) return known->second.add(ms);
  parts_.emplace_back(name, TimeStatistics());
  parts_.back().second.add(ms);
}

void TimingTable::take(const ProcessedPair& pair) {
  if (pair.unusable) return;
  for (const auto& [part, ms] : pair.output.parts.parts()) add(part, ms);
  all_.add(pair.output.stages.total());
}

void TimingTable::finish() {
  if (all_.count() == 0) return;
  std::stable_sort(parts_.begin(), parts_.end(),
                   [](const auto& a, const auto& b) { return a.second.total() > b.second.total(); });
  out_ << std::left << std::setw(28) << "time per pair, ms" << std::right;
  for (const char* name : {"mean", "median", "99 %", "worst", "total, s"}) out_ << std::setw(10) << name;
  out_ << '\n';
  for (const auto& [name, times] : parts_) print(name, times);
  print("all stages", all_);
}

void TimingTable::print(const std::string& name, const TimeStatistics& times) {
  out_ << std::left << std::setw(28) << name << std::right << std::fixed << std::setprecision(2);
  for (const double ms : {times.mean(), times.quantile(0.5), times.quantile(0.99), times.worst()})
    out_ << std::setw(10) << ms;
  out_ << std::setw(10) << times.total() / 1000 << '\n' << std::defaultfloat;
}

}  // namespace uav_landing
