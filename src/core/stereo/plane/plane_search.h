#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "geometry/plane_limits.h"
#include "image/corners.h"
#include "stereo/matching/stereo_level.h"
#include "stereo/plane/slope_band.h"
#include "uav_landing/image/rectification.h"
#include "uav_landing/parameters/stereo_depth_parameters.h"

namespace uav_landing {

/// The ground's plane with nothing known: all disparities, windows sheared as for a range of heights, all
/// peaks kept as candidates and resolved by consensus, so that repeated texture does not decide. Small
/// disparities are looked for at the coarse level, large ones at half of it.
///
/// It takes as long as several pairs whose plane is known. So it is done in steps, over the images of the
/// pair that it began with, and each pair gives it as much time as its size allows.
class PlaneSearch {
 public:
  /// model: at full size; factor: of the coarse level.
  PlaneSearch(const RigModel& model, int factor, const StereoDepthParameters& parameters,
              const PlaneLimits& limits);

  enum class State {
    kGoesOn,    ///< in the next pair
    kFound,     ///< plane() is that of the pair that it began with
    kNotFound,  ///< no plane
    kSwapped,   ///< none, as left and right are exchanged, in this search or the last one that looked
    kOverhead,  ///< none, but one above the horizon, in this search or the last one that looked
  };

  /// Begins with this pair, when none is under way. The level's images must be whole. budget: places to
  /// score, about; a pair goes on until it has done so many.
  State advance(const StereoLevel& coarse, double budget);
  /// So many places have time in a pair of this size. alone: as long as lines and motion wait for the plane.
  static double budgetOf(const cv::Size& size, bool alone = false);

  /// What was found last, until the next pair.
  const Eigen::Vector3d& plane() const { return found_->g; }
  /// Whether it began with the last pair that it was given.
  bool beganHere() const { return began_here_; }
  /// A search that finds nothing, from this one on, looks for why, even if one has done so lately.
  void lookAgain() { failed_ = 0; }
  /// Begins anew with the next pair.
  void restart() { phase_ = Phase::kNone; }
  /// A plane is known again: there is nothing to search for.
  void stop();
  /// Forgets what it knows of the rig, too.
  void reset();

 private:
  // What is looked for, band by band: the plane; with left and right exchanged by some corners, or by all;
  // with the cameras turned over.
  enum class Phase { kNone, kAhead, kSample, kBehind, kOverhead };
  // Both images at one size, with the corners that are looked for.
  struct Tier {
    StereoLevel level;
    cv::Mat right;  // of the level, with room beside it
    std::vector<cv::Point> corners;
  };
  // At the coarse level, and at half of it or, where that is too small, at the coarse level again.
  struct Tiers {
    Tier coarse, wide;
  };
  // The best plane of a band, with the share of the corners that speaks for it, and where it was found.
  struct Leader {
    Eigen::Vector3d g;
    double share;
    bool wide;
  };
  // share: of the plane with the most votes, of which this may be a rival.
  struct Best {
    Eigen::Vector3d g;
    double share;
  };

  void begin(const StereoLevel& coarse);
  void beginOther(Phase phase);
  void prepare(Tier& tier, size_t corners);
  void beginBand(size_t band);
  bool isWide() const { return band_ >= SlopeBands::kFar; }
  // Takes a few corners of the band, or decides on its plane when all were taken. Returns its cost.
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
  size_t band_ = 0;                          // under way
  size_t corner_ = 0;                        // of it, the next one
  std::vector<DisparitySample> candidates_;  // of the corners before
  bool began_here_ = false;
  int failed_ = 0;                       // searches in a row
  State looks_like_ = State::kNotFound;  // by the last search that looked: swapped, overhead
  bool was_upright_ = false;             // there was a plane: a rig does not turn over in flight
  CornerMemory memory_;
};

}  // namespace uav_landing
