#include "offline/pair_count.h"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

namespace uav_landing {
namespace {

/// ": not_yet 3, rejected 1", the most frequent first.
std::string listed(const std::map<std::string, std::size_t>& counts) {
  std::vector<std::pair<std::string, std::size_t>> sorted(counts.begin(), counts.end());
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  std::string text;
  for (const auto& [name, count] : sorted)
    text += (text.empty() ? ": " : ", ") + name + ' ' + std::to_string(count);
  return text;
}

}  // namespace

void PairCount::take(const ProcessedPair& pair) {
  tally_.add(pair);
  if (pair.output.approach.readout.known()) readout_ = pair.output.approach.readout;
}

void PairCount::finish() {
  if (!tally_.failed_tests.empty())
    out_ << "pairs on which a test failed" << listed(tally_.failed_tests) << '\n';
  if (const std::string verdict = verdictOf(tally_); !verdict.empty())
    out_ << "likely cause: " << verdict << '\n';
  if (const std::string advice = adviceOn(readout_); !advice.empty()) out_ << advice << '\n';
  out_ << tally_.pairs << (tally_.pairs == 1 ? " pair, " : " pairs, ") << tally_.valid << " valid"
       << listed(tally_.reasons) << '\n';
}

}  // namespace uav_landing
