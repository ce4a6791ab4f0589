#include "stereo/photometric/shift_matching.h"

#include <cmath>

namespace uav_landing {
namespace {

// Share of the derivatives that must exceed noise.
constexpr double kLeastShare = 0.1;

}  // namespace

void ShiftMatching::add(const ShiftEvidence& evidence, bool alike, int u, int v) {
  if (evidence.isCertain()) return tell(evidence, alike);
  const Section here{v, u / width_};
  if (here != section_) endSection();
  section_ = here;
  weak_[alike].add(evidence);
  if (weak_[alike].isCertain()) tellWeak(alike);
}

void ShiftMatching::finish() { endSection(); }

void ShiftMatching::endSection() {
  for (const bool alike : {false, true}) tellWeak(alike);
}

void ShiftMatching::tellWeak(bool alike) {
  if (weak_[alike].blocks > 0) tell(weak_[alike], alike);
  weak_[alike] = {};
}

void ShiftMatching::tell(const ShiftEvidence& evidence, bool alike) {
  const double signal = evidence.likelySignal();
  if (!(signal >= kLeastShare * evidence.energy)) return;
  const double response = gain_ * signal;
  matches_.push_back({evidence.moment_u / evidence.energy, evidence.moment_v / evidence.energy,
                      evidence.score / response, std::sqrt(evidence.score_variance) / response,
                      evidence.down / signal, evidence.blocks, evidence.isCertain(), alike});
}

}  // namespace uav_landing
