#pragma once

namespace uav_landing {

/// When a height is believed again that contradictions have taken away: a fault that lasts lets pairs pass by
/// chance, now and then many in a row, and after the reset timeout its own state is taken for the new one,
/// which then agrees with itself. Until nothing has contradicted for a while the fault is taken to last.
class Recovery {
 public:
  enum class Pair { kAgrees, kSilent, kContradicts };  ///< kSilent: measures nothing that could contradict

  /// quiet: s without a contradiction that are asked for; 0: none are.
  explicit Recovery(double quiet) : needed_(quiet) {}
  /// T: s since the pair before. lost: contradictions keep the height from being valid.
  void follow(double T, Pair pair, bool lost);
  /// The height was lost, and too little has agreed since.
  bool pending() const { return pending_; }
  /// Since the last contradiction, pairs that agreed, s.
  double quiet() const { return quiet_; }

 private:
  double needed_;
  double quiet_ = 0;
  bool pending_ = false;
};

}  // namespace uav_landing
