#pragma once

#include <fstream>
#include <string>

#include "offline/processed_pair.h"
#include "pending_file.h"

namespace uav_landing {

/// Writes the estimates as a CSV file, one row per pair, blank when unknown. Stamps have 9 decimals, other
/// numbers 12 significant digits; angles are in degrees.
class EstimateCsv : public PairSink {
 public:
  explicit EstimateCsv(const std::string& path);
  void take(const ProcessedPair& pair) override;
  void finish() override;

 private:
  PendingFile pending_;
  std::ofstream file_;
};

}  // namespace uav_landing
