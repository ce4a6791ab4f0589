#pragma once

#include <map>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "offline/processed_pair.h"

namespace uav_landing {

/// Distribution of times in limited memory. Mean, worst and total are exact, quantiles to 1 %.
class TimeStatistics {
 public:
  void add(double ms);
  std::size_t count() const { return count_; }
  double total() const { return total_; }
  double mean() const { return total_ / static_cast<double>(count_); }
  double worst() const { return worst_; }
  /// The smallest time that at least this share (0 to 1) of the times do not exceed, to 1 %.
  double quantile(double share) const;

 private:
  std::map<int, std::size_t> histogram_;  ///< logarithmic bins, 1 % wide
  std::size_t count_ = 0;
  double total_ = 0, worst_ = 0;
};

/// The paper's Table 1: time per part of the stages and in total.
class TimingTable : public PairSink {
 public:
  explicit TimingTable(std::ostream& out) : out_(out) {}
  void take(const ProcessedPair& pair) override;
  /// Prints the table, the longest time first.
  void finish() override;

 private:
  void add(const std::string& name, double ms);
  void print(const std::string& name, const TimeStatistics& times);

  std::ostream& out_;
  std::vector<std::pair<std::string, TimeStatistics>> parts_;  ///< in order of appearance, until finish()
  TimeStatistics all_;
};

}  // namespace uav_landing
