#pragma once

namespace uav_landing {

/// Whether a quantity that is followed from pair to pair moves as predicted. Then the prediction is a good
/// enough start and no search is needed. A search could find something that agrees better, and that must be
/// noticed soon: so every tenth time a search is made nevertheless.
class Steadiness {
 public:
  /// steady_off: when prediction and result differ by at most so many pixels, the next pair needs no search.
  /// most_off: a result found without a search counts when it differs by at most so many pixels.
  Steadiness(double steady_off, double most_off) : steady_off_(steady_off), most_off_(most_off) {}

  /// The prediction also holds when the time between pairs grows by at most this factor.
  static constexpr double kLongestRegular = 1.5;

  /// Whether to go without a search this time. If a search is made after all, call searched().
  bool goesWithout() {
    if (!steady_ || without_ >= kMostWithout) return false;
    ++without_;
    return true;
  }
  void searched() { without_ = 0; }
  /// share: of the corners that agree with the result found without a search. off: largest difference from
  /// the prediction, pixels.
  bool bearsOut(double share, double off) const { return share >= kLeastKept * share_ && off <= most_off_; }
  /// The final result, with a search or without.
  void note(double share, double off) {
    if (without_ == 0) share_ = share;
    steady_ = share >= kLeastShare && off <= steady_off_;
  }
  void lose() { steady_ = false; }

 private:
  // kLeastShare: with a majority of the corners, nothing else has as many. kLeastKept: as a share of the
  // corners that agreed after the last search. Lines look alike all along them, so with a wrong result their
  // corners still agree, and only the other corners are lost.
  static constexpr double kLeastShare = 0.5, kLeastKept = 0.9;
  static constexpr int kMostWithout = 9;

  double steady_off_, most_off_;
  bool steady_ = false;
  double share_ = 0;  // of the corners that agreed after the last search
  int without_ = 0;   // times in a row
};

}  // namespace uav_landing
