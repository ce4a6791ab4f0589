#pragma once

#include "integrity/vanishing_memory.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// How likely the direction that is taken for the runway's is that of something else: a street, a field, a
/// shore.
///
/// Each pair has a margin: the log of how much likelier its lines are with this runway than with any other
/// (RunwayChoice). Pairs in a row see much the same lines, so their margins are averaged and not added. The
/// direction has to stay the same from pair to pair. One that leaps belongs to something else until several
/// pairs in a row have shown it; it has to prove itself from the beginning then.
class RunwayIdentity {
 public:
  /// Pairs in a row that must agree.
  static constexpr int kConfirmations = 3;

  /// After each pair. seen: not finite where none is in view. margin: 0 where no runway is known to be there.
  /// path_known: the margin has what the path of flight says; those before the first such one are forgotten.
  /// normal: of the ground, unit. turn: since the pair before.
  void follow(double stamp, const VanishingMemory::Direction& seen, double margin, bool path_known,
              const Eigen::Vector3d& normal, const ApproachAngleResult::Motion& turn);
  /// A pair of which nothing is known.
  void skip(double stamp);
  /// Chance that the direction of the last pair is not the runway's, 0 to 1.
  double otherProbability() const { return other_probability_; }

 private:
  void follow(double seconds, double margin, bool path_known);
  double advance(double stamp);

  VanishingMemory memory_;
  double stamp_ = kUnknown;
  double margin_ = 0;  // mean of the last pairs
  int pairs_ = 0;      // that agree, in a row
  int margins_ = 0;    // in their mean
  int leaps_ = 0;      // in a row
  bool path_known_ = false;
  double other_probability_ = 1;
};

}  // namespace uav_landing
