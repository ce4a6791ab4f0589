#pragma once

namespace uav_landing {

/// Decides when a height that contradictions have taken away is believed again. During a lasting fault, pairs
/// pass by chance, now and then many in a row. After the reset timeout the filter takes the fault's state for
/// the new one, which then agrees with itself. So the fault is assumed to last until nothing has contradicted
/// for a while.
class Recovery {
 public:
  /// kSilent: the pair measures nothing that could contradict.
  enum class Pair { kAgrees, kSilent, kContradicts };

  /// quiet: time without a contradiction that is needed, s; 0: none.
  explicit Recovery(double quiet) : needed_(quiet) {}
  /// T: s since the pair before. lost: contradictions keep the height from being valid.
  void follow(double T, Pair pair, bool lost);
  /// True when the height was lost and too little has agreed since.
  bool pending() const { return pending_; }
  /// Time of pairs that agreed since the last contradiction, s.
  double quiet() const { return quiet_; }

 private:
  double needed_;
  double quiet_ = 0;
  bool pending_ = false;
};

}  // namespace uav_landing
