#pragma once

#include <opencv2/core.hpp>
#include <optional>

#include "far/image_patch.h"
#include "far/sight_fit.h"
#include "far/sight_search.h"
#include "far/stereo_scale.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// The runway from afar, from pair to pair: its outline is searched for, fitted, and followed.
///
/// An outline counts after some pairs in a row. Each of them fits size and place anew. Without the width or
/// the length of a chart nothing is looked for.
class Sighting {
 public:
  /// Pairs in a row that must agree.
  static constexpr int kConfirmations = 4;

  Sighting(const RigModel& rig, const ApproachAngleParameters& parameters, const RunwayParameters& runway);

  /// images: rectified. busy: other searches take the time of this pair, so a search waits.
  ApproachAngleResult::Sight process(double stamp, const RectifiedImages& images, const KnownGround& ground,
                                     bool busy = false);
  void reset();

 private:
  std::optional<Expected<SightedRunway>> search(double stamp, const cv::Mat& left, const KnownGround& ground,
                                                bool busy);
  Expected<SightedRunway> follow(const cv::Mat& left, const KnownGround& ground) const;
  bool agrees(const OutlinePose& pose) const;
  void keep(const cv::Mat& left, const SightedRunway& seen);
  std::optional<SurfaceDisparity> followScale(double seconds, const RectifiedImages& images,
                                              const SightedRunway& seen, const KnownGround& ground);
  void miss(double stamp, double seconds);
  void drop();
  ApproachAngleResult::Sight report(const SightedRunway& seen, const KnownGround& ground,
                                    const std::optional<SurfaceDisparity>& disparity) const;

  SightFit fit_;
  bool at_once_;  // a whole search in one pair
  SightSearch search_;
  std::optional<double> last_stamp_;
  std::optional<SightedRunway> last_;
  StereoScale scale_;
  ImagePatch patch_;
  int confirmations_ = 0;
  double missed_ = 0;      // s
  double wait_until_ = 0;  // stamp until which no search begins
};

}  // namespace uav_landing
