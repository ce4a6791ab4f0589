#pragma once

#include <fstream>
#include <string>

#include "pending_file.h"
#include "uav_landing/pipeline.h"
#include "uav_landing/results/truth.h"
#include "uav_landing/simulator/parameters.h"

namespace uav_landing {

/// Writes one row per scored frame of a campaign: what was drawn, the truth, the estimates and their claimed
/// standard deviations. The file gets its name when it is complete.
class CampaignCsv {
 public:
  explicit CampaignCsv(const std::string& path);

  /// The flight and the place in it that a frame belongs to.
  struct Sample {
    uint64_t seed = 0;
    double cell_height = kUnknown;  ///< m; unknown for a frame of an approach
    double noise = 0;               ///< grey levels
    bool chart = false;             ///< the chain is told the runway's width and length
    int frame = 0;
    double time = 0;                        ///< s
    double height_above_runway = kUnknown;  ///< the true one, m; unknown where the runway is not level
  };
  void write(const Sample& sample, const SimulatorParameters& drawn, const Truth& truth,
             const Pipeline::Output& output);
  void finish();

 private:
  PendingFile pending_;
  std::ofstream file_;
};

}  // namespace uav_landing
