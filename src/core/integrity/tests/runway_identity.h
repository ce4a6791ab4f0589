#pragma once

#include "integrity/memory/vanishing_memory.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Probability that the direction that is taken for the runway's belongs to something else: a street, a
/// field, a shore.
///
/// Each pair has a margin: the log of how much likelier its lines are with this runway than with any other
/// (RunwayChoice). Pairs in a row see almost the same lines, so their margins are averaged and not added. The
/// direction has to stay the same from pair to pair. A direction that jumps belongs to something else. If
/// several pairs in a row show it, it is followed, and has to prove itself from the beginning.
class RunwayIdentity {
 public:
  /// Pairs in a row that must agree.
  static constexpr int kConfirmations = 3;

  /// What a pair says of the runway.
  struct Seen {
    VanishingMemory::Direction direction;  ///< not finite when no runway is in view
    double margin;                         ///< 0 when no runway is known to be there
    /// The margin contains what the path of flight says. Margins before the first such one are forgotten.
    bool path_known;
  };
  /// Call it after each pair. normal: of the ground, unit. turn: since the pair before.
  void follow(double stamp, const Seen& seen, const Eigen::Vector3d& normal,
              const ApproachAngleResult::Motion& turn);
  /// A pair about which nothing is known.
  void skip(double stamp);
  /// Probability that the direction of the last pair is not the runway's, 0 to 1.
  double otherProbability() const { return other_probability_; }

 private:
  void average(double seconds, double margin, bool path_known);
  double advance(double stamp);

  VanishingMemory memory_;
  double stamp_ = kUnknown;
  double margin_ = 0;  // mean of the last pairs
  int pairs_ = 0;      // pairs in a row that agree
  int margins_ = 0;    // number of margins in the mean
  int leaps_ = 0;      // jumps in a row
  bool path_known_ = false;
  double other_probability_ = 1;
};

}  // namespace uav_landing
