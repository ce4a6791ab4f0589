#include "faults/fault_choice.h"

#include <algorithm>
#include <set>
#include <stdexcept>

#include "simulator/ground/ground_profile.h"

namespace uav_landing {
namespace {

/// Paint needs flat ground, and images that belong to the same moment.
bool exclude(const Fault& a, const Fault& b) {
  const auto unpaintable = [](const Fault& fault) {
    SimulatorParameters changed;
    if (fault.build) fault.build(changed);
    if (fault.disturb) fault.disturb(changed, 1);
    return !GroundProfile(changed.profile).flat() || changed.image.readout_time != 0;
  };
  return (unpaintable(a) && paintsGround(&b)) || (unpaintable(b) && paintsGround(&a));
}

}  // namespace

std::string nameOf(const FaultCombination& faults) {
  std::string name;
  for (const Fault* fault : faults) name += (name.empty() ? "" : "+") + fault->name;
  return name;
}

bool paintsGround(const Fault* fault) { return fault->needs_scene && fault->spoil; }

FaultChoice::FaultChoice(const std::vector<std::string>& names, int drawn_pairs, bool simulated)
    : drawn_pairs_(drawn_pairs) {
  std::set<std::string> wanted;
  for (const std::string& name : names)
    name.find('+') == std::string::npos ? (void)wanted.insert(name) : addPair(name, simulated);
  std::set<std::string> unknown = wanted;
  for (const Fault& fault : allFaults()) {
    unknown.erase(fault.name);
    const bool asked = names.empty() || wanted.count(fault.name) > 0;
    if (asked && (!fault.needs_scene || simulated)) faults_.push_back(&fault);
  }
  if (!unknown.empty()) throw std::runtime_error("there is no fault " + *unknown.begin());
}

// "a+b", in the order of the places along the light's path.
void FaultChoice::addPair(const std::string& names, bool simulated) {
  FaultCombination pair;
  for (const Fault& fault : allFaults())
    if (("+" + names + "+").find("+" + fault.name + "+") != std::string::npos) pair.push_back(&fault);
  std::sort(pair.begin(), pair.end(), [](const Fault* a, const Fault* b) { return a->place < b->place; });
  if (pair.size() != 2) throw std::runtime_error(names + " is no pair of faults");
  const bool drawn = pair[0]->needs_scene || pair[1]->needs_scene;
  if (simulated || !drawn) asked_pairs_.push_back(pair);
}

std::vector<FaultCombination> FaultChoice::combinations(uint64_t seed) const {
  std::vector<FaultCombination> all = asked_pairs_;
  for (const Fault* fault : faults_) all.push_back({fault});
  cv::RNG random(seed * 77 + 5);
  // Only faults that begin in flight are drawn. Their variants from the first pair on are flown alone or on
  // request.
  std::vector<const Fault*> drawn = faults_;
  drawn.erase(
      std::remove_if(drawn.begin(), drawn.end(), [](const Fault* fault) { return fault->from_first; }),
      drawn.end());
  const int count = static_cast<int>(drawn.size());
  for (int i = 0; i < drawn_pairs_ && count > 2; ++i) {
    const Fault* first = drawn[static_cast<size_t>(random.uniform(1, count))];
    const Fault* second = drawn[static_cast<size_t>(random.uniform(1, count))];
    if (first == second || first->name == "none" || second->name == "none") continue;
    if (exclude(*first, *second)) continue;
    if (first->place > second->place) std::swap(first, second);
    all.push_back({first, second});
  }
  return all;
}

}  // namespace uav_landing
