#pragma once

#include <cstddef>
#include <map>
#include <ostream>
#include <string>

#include "offline/processed_pair.h"

namespace uav_landing {

/// How many pairs were valid, and why the others were not: "161 pairs, 158 valid: not_yet 3", the most
/// frequent reason first.
class PairCount : public PairSink {
 public:
  explicit PairCount(std::ostream& out) : out_(out) {}
  void take(const ProcessedPair& pair) override;
  /// Prints the line.
  void finish() override;

 private:
  std::ostream& out_;
  std::size_t pairs_ = 0, valid_ = 0;
  std::map<std::string, std::size_t> reasons_;
};

}  // namespace uav_landing
