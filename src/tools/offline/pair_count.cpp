#include "offline/pair_count.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace uav_landing {

void PairCount::take(const ProcessedPair& pair) {
  const LandingResult& landing = pair.output.landing;
  ++pairs_;
  if (landing.valid())
    ++valid_;
  else
    ++reasons_[landing.failure ? toString(landing.failure.reason) : "no reason given"];
}

void PairCount::finish() {
  std::vector<std::pair<std::string, std::size_t>> reasons(reasons_.begin(), reasons_.end());
  std::stable_sort(reasons.begin(), reasons.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  out_ << pairs_ << (pairs_ == 1 ? " pair, " : " pairs, ") << valid_ << " valid";
  const char* before = ": ";
  for (const auto& [reason, count] : reasons) {
    out_ << before << reason << ' ' << count;
    before = ", ";
  }
  out_ << '\n';
}

}  // namespace uav_landing
