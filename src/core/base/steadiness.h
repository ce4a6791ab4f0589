#pragma once

namespace uav_landing {

/// Whether what is followed from pair to pair moves on as the pairs before lead to expect, so that it is good
/// enough a start as it is and needs no search. What a search would show, something that agrees better, is to
/// be seen soon: every tenth time there is one nevertheless.
class Steadiness {
 public:
  /// steady_off: up to so many pixels between what was expected and what was found the next time needs no
  /// search. most_off: up to so many what is found without one counts.
  Steadiness(double steady_off, double most_off) : steady_off_(steady_off), most_off_(most_off) {}

  /// By up to this factor longer than the last time from pair to pair, what moves can be expected as well.
  static constexpr double kLongestRegular = 1.5;

  /// Whether to go without a search this time. It is one without until searched().
  bool goesWithout() {
    if (!steady_ || without_ >= kMostWithout) return false;
    ++without_;
    return true;
  }
  void searched() { without_ = 0; }
  /// share: of the corners, that agree with what was found without a search; off: pixels.
  bool bearsOut(double share, double off) const { return share >= kLeastKept * share_ && off <= most_off_; }
  /// What was found in the end, with a search or without.
  void note(double share, double off) {
    if (without_ == 0) share_ = share;
    steady_ = share >= kLeastShare && off <= steady_off_;
  }
  void lose() { steady_ = false; }

 private:
  // With the majority nothing else has as many. And share of those that agreed after the last search, that
  // must agree again: lines look alike wherever along them they are looked for, and what else there is would
  // be lost.
  static constexpr double kLeastShare = 0.5, kLeastKept = 0.9;
  static constexpr int kMostWithout = 9;

  double steady_off_, most_off_;
  bool steady_ = false;
  double share_ = 0;  // of the corners, that agreed after the last search
  int without_ = 0;   // times in a row
};

}  // namespace uav_landing
