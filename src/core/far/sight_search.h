#pragma once

#include <deque>
#include <opencv2/core.hpp>
#include <optional>

#include "far/image_patch.h"
#include "far/sight_fit.h"

namespace uav_landing {

/// Looks for the runway's outline over several pairs, as one fit is all the time that a pair has for it. The
/// first image gives the candidates. Every later one gets one fit, and the candidates move with the
/// image.
///
/// Another candidate that may be the runway as well, and shows as clearly, leaves it open.
class SightSearch {
 public:
  bool running() const { return !attempts_.empty(); }
  /// Finds the candidates in a left image. Fails where there are none.
  Failure begin(const SightFit& fit, const cv::Mat& left, const KnownGround& ground);
  /// Moves the candidates with the image. It has to see every image while the search is running.
  void follow(const cv::Mat& left);
  /// Makes one fit in the image that was followed last. Nothing while others are to come; then the outline,
  /// to some pixels, or why there is none.
  std::optional<Expected<SightedRunway>> step(const SightFit& fit, const cv::Mat& left,
                                              const KnownGround& ground);

 private:
  struct Attempt {
    Corners start;
    double strength;                    // of its candidate
    bool last;                          // of its candidate
    std::optional<SightedRunway> seen;  // by the fit before, which this one may better
  };
  void addAttempts(const Corners& candidate, double strength);
  void watch(const cv::Mat& left);
  /// Takes in what an attempt has found. False when the search has to stop: two outlines may be the runway's.
  bool judge(const Attempt& attempt, Expected<SightedRunway> seen, const SightFit& fit,
             const KnownGround& ground);

  std::deque<Attempt> attempts_;
  std::optional<SightedRunway> best_;   // of the candidate that is being fitted
  std::optional<SightedRunway> found_;  // of the candidates before
  Failure failure_;
  ImagePatch patch_;
  Eigen::Vector2d middle_ = Eigen::Vector2d::Zero();  // of the patch, px
};

}  // namespace uav_landing
