#pragma once

#include <ostream>
#include <string>

#include "offline/verdict.h"

namespace uav_landing {

/// Counts how many pairs were valid, and why the others were not. It writes "161 pairs, 158 valid: not_yet
/// 3", with the most frequent reason first. A line before it lists the tests that failed.
class PairCount : public PairSink {
 public:
  explicit PairCount(std::ostream& out) : out_(out) {}
  void take(const ProcessedPair& pair) override;
  /// Prints the lines, the verdict, and what to do about a rolling shutter, if there is one.
  void finish() override;

 private:
  std::ostream& out_;
  PairTally tally_;
  ReadoutEstimate readout_;  // the last one
};

}  // namespace uav_landing
