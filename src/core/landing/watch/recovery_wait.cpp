#include "landing/watch/recovery_wait.h"

#include <algorithm>

#include "base/text.h"

namespace uav_landing {

Failure RecoveryWait::follow(double T, const PairVerdict& pair, const PairTests& tests,
                             const TrackVerdict& post) {
  const bool sinks = tests.failed(IntegrityTest::kSinkRate);
  const bool rejected = pair.leftOut() || post.rejection;
  // A pair that passes, but is rejected because others failed, contradicts nothing.
  const bool contradicted = (rejected && !pair.confirming) || sinks;
  Recovery::Pair kind = Recovery::Pair::kSilent;
  if (contradicted)
    kind = Recovery::Pair::kContradicts;
  else if ((pair.confirming || post.status == Status::kTracking) &&
           !tests.failed(IntegrityTest::kVanishingPoint))  // else the fault is still there
    kind = Recovery::Pair::kAgrees;
  // A height that is missing without a contradiction is no fault. First heights that contradict each other
  // are one, because nothing says which of them is wrong.
  const bool disputed = contradicted && !post.confirmed;
  recovery_.follow(std::min(T, max_age_), kind, post.outdated || disputed || sinks);
  if (!recovery_.pending()) return {};
  return {Reason::kInconsistent, text("recovering: the tests have passed for ", rounded(recovery_.quiet()),
                                      " s, ", needed_, " s required")};
}

}  // namespace uav_landing
