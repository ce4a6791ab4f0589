#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "geometry/plane_limits.h"
#include "geometry/plane_vector.h"
#include "image/windows/corners.h"
#include "stereo/matching/stereo_level.h"
#include "stereo/plane/slope_band.h"
#include "uav_landing/image/rectification.h"
#include "uav_landing/parameters/stereo_depth_parameters.h"

namespace uav_landing {

/// The ground plane when nothing is known. All disparities are scored, with windows sheared for several
/// ranges of heights. All peaks are kept as candidates and a consensus decides, so that repeated texture does
/// not. Small disparities are looked for at the coarse level, large ones at half of it.
/// A search takes as long as several pairs whose plane is known. So it is done in steps, on the images of the
/// pair that it began with. Each pair gives it as much time as its size allows.
class PlaneSearch {
 public:
  /// model: at full size. factor: full size over the coarse level's size.
  PlaneSearch(const RigModel& model, int factor, const StereoDepthParameters& parameters,
              const PlaneLimits& limits);

  enum class State {
    kGoesOn,    ///< the next pair continues
    kFound,     ///< plane() is that of the pair that the search began with
    kNotFound,  ///< no plane
    kSwapped,   ///< no plane, as left and right are exchanged; by this search or the last one that looked
    kOverhead,  ///< no plane but one above the horizon; by this search or the last one that looked
  };

  /// Continues the search, or begins one with this pair. The level's images must be complete. budget: places
  /// to score in this pair, about.
  State advance(const StereoLevel& coarse, double budget);
  /// Budget of a pair of this size. alone: lines and motion wait for the plane, so more time is left.
  static double budgetOf(const cv::Size& size, bool alone = false);

  /// The plane found last; valid until the next pair.
  const PlaneVector& plane() const { return found_->g; }
  /// Whether the search began with the latest pair.
  bool beganHere() const { return began_here_; }
  /// The next search that finds nothing looks for the cause, even if an earlier one did so recently. It may
  /// be the one in progress.
  void lookAgain() { failed_ = 0; }
  /// Begins anew with the next pair.
  void restart() { phase_ = Phase::kNone; }
  /// The plane is known again, so there is nothing to search for.
  void stop();
  /// Forgets everything, including what it knows of the rig.
  void reset();

 private:
  // What is looked for, band by band: the plane; with left and right exchanged, by some corners or by all;
  // with the cameras turned over.
  enum class Phase { kNone, kAhead, kSample, kBehind, kOverhead };
  // Both images at one size, with the corners to look for.
  struct Tier : RoomyLevel {
    std::vector<cv::Point> corners;
  };
  // The coarse level, and half of it. Where half is too small, both are the coarse level.
  struct Tiers {
    Tier coarse, wide;
  };
  // The best plane of a band, the share of corners that agree with it, and where it was found.
  struct Leader {
    PlaneVector g;
    double share;
    bool wide;
  };
  // share: of the plane with the most votes, which may be a rival of this one.
  struct Best {
    PlaneVector g;
    double share;
  };

  void begin(const StereoLevel& coarse);
  void beginOther(Phase phase);
  void prepare(Tier& tier, size_t corners);
  void beginBand(size_t band);
  bool isWide() const { return band_ >= SlopeBands::kFar; }
  // Takes a few corners of the band, or decides on its plane after the last corner. Returns the cost.
  double searchOn();
  double lookAtCorners(const SlopeBand& band, const Tier& tier);
  double endBand(const SlopeBand& band, const Tier& tier);
  State decide();
  std::optional<Best> chooseFrom(std::vector<Leader>& leaders, const Tiers& tiers);
  State decideAhead();
  State decideBySample();
  State decideBehind();
  State decideOverhead();
  State end(State state);

  StereoDepthParameters parameters_;
  PlaneLimits limits_;
  Tiers ahead_, other_;  // other: left and right exchanged, or turned over
  std::vector<Leader> leaders_;
  std::optional<Best> found_;
  Phase phase_ = Phase::kNone;
  size_t band_ = 0;                          // in progress
  size_t corner_ = 0;                        // next one of the band
  std::vector<DisparitySample> candidates_;  // from the corners before
  bool began_here_ = false;
  int failed_ = 0;                       // searches in a row
  State looks_like_ = State::kNotFound;  // by the last search that looked for swapped or overhead
  bool was_upright_ = false;             // a plane was found, so the rig is not upside down: it does not turn
                                         // over in flight
  CornerMemory memory_;
};

}  // namespace uav_landing
