#include "landing/watch/recovery_wait.h"

#include <algorithm>

#include "base/text.h"

namespace uav_landing {

Failure RecoveryWait::follow(double T, const PairVerdict& pair, const PairTests& tests,
                             const TrackVerdict& post) {
  const bool sinks = tests.failed(IntegrityTest::kSinkRate);
  const bool rejected = pair.leftOut() || post.rejection;
  // A pair that passes, but not as long as others failed, is left out and contradicts nothing.
  const bool contradicted = (rejected && !pair.confirming) || sinks;
  Recovery::Pair kind = Recovery::Pair::kSilent;
  if (contradicted)
    kind = Recovery::Pair::kContradicts;
  else if ((pair.confirming || post.status == Status::kTracking) &&
           !tests.failed(IntegrityTest::kVanishingPoint))  // says that what was contradicted is still wrong
    kind = Recovery::Pair::kAgrees;
  // What is missing without a contradiction is no fault. Nor does anything say which of the first heights is
  // wrong that contradict each other.
  const bool disputed = contradicted && !post.confirmed;
  recovery_.follow(std::min(T, max_age_), kind, post.outdated || disputed || sinks);
  if (!recovery_.pending()) return {};
  return {Reason::kInconsistent, text("recovering: the tests have passed for ", rounded(recovery_.quiet()),
                                      " s, ", needed_, " s required")};
}

}  // namespace uav_landing
