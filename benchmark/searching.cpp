#include "searching.h"

#include <algorithm>
#include <cmath>

#include "uav_landing/pipeline.h"

namespace uav_landing {
namespace benchmark {
namespace {

constexpr int kFlights = 5;  // other work on the machine disturbs one flight, but not all
constexpr int kSteadyPairs = 40;
constexpr size_t kUntilSteady = 10;  // pairs

// Smallest CPU time of each pair over several flights of a new chain, the first pair included.
Expected<Times> leastTimes(const Sequence& sequence, const Parameters& parameters) {
  Times least;
  least.ms.assign(sequence.pairs.size(), INFINITY);
  for (int flight = 0; flight < kFlights; ++flight) {
    Expected<Pipeline> chain = Pipeline::create(sequence.left, sequence.right, parameters);
    if (!chain) return tl::make_unexpected(chain.error());
    for (size_t i = 0; i < sequence.pairs.size(); ++i) {
      const Sequence::Pair& pair = sequence.pairs[i];
      const double start = cpuMilliseconds();
      chain->process(pair.stamp, pair.left, pair.right);
      least.ms[i] = std::min(least.ms[i], cpuMilliseconds() - start);
    }
  }
  return least;
}

}  // namespace

Expected<SearchingTimes> measureSearching(const Sequence& sequence, const std::string& steady,
                                          const Parameters& parameters) {
  SearchingTimes result;
  result.sequence = sequence.name;
  result.size = sequence.left.imageSize();
  const Expected<Sequence> reference = simulatedSequence(steady, result.size, kSteadyPairs);
  if (!reference) return tl::make_unexpected(reference.error());
  if (reference->pairs.size() <= kUntilSteady)
    return tl::make_unexpected(
        Failure{Reason::kInputInvalid, steady + " has too few pairs to become steady"});
  if (sequence.pairs.empty())
    return tl::make_unexpected(Failure{Reason::kInputInvalid, sequence.name + " has no pairs"});
  const Expected<Times> followed = leastTimes(*reference, parameters);
  if (!followed) return tl::make_unexpected(followed.error());
  result.steady = Times{{followed->ms.begin() + kUntilSteady, followed->ms.end()}}.median();
  const Expected<Times> pairs = leastTimes(sequence, parameters);
  if (!pairs) return tl::make_unexpected(pairs.error());
  result.pairs = *pairs;
  return result;
}

}  // namespace benchmark
}  // namespace uav_landing
