#include "kernels/image/line_shades.h"

#include <algorithm>
#include <limits>

#include "kernels/lanes/lanes.h"
#include "kernels/lanes/multiversion.h"

namespace uav_landing {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

}  // namespace

UAV_LANDING_MULTIVERSION void takeKnown(const LineGreys& line, KnownGreys& known) {
  const Lanes infinity = Lanes{} + kInfinity;
  Lanes darkest = infinity;
  IntLanes counts{};
  for (int c = 0; c < kLineSamples; c += kLanes) {
    Lanes grey;
    load(&line[c], grey);
    counts -= grey == grey;
    const Lanes kept = grey == grey ? grey : infinity;
    darkest = kept < darkest ? kept : darkest;
    store(kept, &known.greys.values[c]);
  }
  known.greys.count = kLineSamples;
  known.count = 0;
  known.darkest = darkest[0];
  for (int i = 0; i < kLanes; ++i) {
    known.count += counts[i];
    known.darkest = std::min(known.darkest, darkest[i]);
  }
}

UAV_LANDING_MULTIVERSION int countFrom(float light, const KnownGreys& known) {
  IntLanes counts{};
  for (int c = 0; c < kLineSamples; c += kLanes) {
    Lanes grey;
    load(&known.greys.values[c], grey);
    counts -= grey >= light;
  }
  int count = known.count - kLineSamples;  // minus the infinite ones
  for (int i = 0; i < kLanes; ++i) count += counts[i];
  return count;
}

UAV_LANDING_MULTIVERSION void findShades(const KnownGreys& known, float dark, float light,
                                         LineShades& shades) {
  const float contrast = light - dark;
  for (int c = 0; c < kLineSamples; c += kLanes) {
    Lanes grey;
    load(&known.greys.values[c], grey);
    const Lanes level = (grey - dark) / contrast;
    const IntLanes shade = (level < 0.35F) - (level > 0.65F) - (level == kInfinity);
    store(shade, &shades[c]);
  }
}

}  // namespace uav_landing
