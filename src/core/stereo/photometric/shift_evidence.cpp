#include "stereo/photometric/shift_evidence.h"

#include <algorithm>
#include <cmath>

namespace uav_landing {
namespace {

// Standard deviations.
constexpr double kCertain = 6;

}  // namespace

void ShiftEvidence::add(const ShiftEvidence& other) {
  blocks += other.blocks;
  score += other.score;
  score_variance += other.score_variance;
  energy += other.energy;
  signal += other.signal;
  signal_variance += other.signal_variance;
  usual += other.usual;
  moment_u += other.moment_u;
  moment_v += other.moment_v;
  down += other.down;
}

bool ShiftEvidence::isCertain() const { return signal > kCertain * std::sqrt(signal_variance); }

// The prior: a signal is positive, and strong ones are rare but possible (density 1 / (usual + signal)^2, its
// logarithm linear near the measurement). Among many blocks with next to nothing to see, noise makes some
// look strong. Without the prior these would get too much weight and claim to know too much.
double ShiftEvidence::likelySignal() const {
  const double stddev = std::sqrt(signal_variance);
  const double most_likely = signal - 2 * signal_variance / (usual + std::max(signal, 0.0));
  const double z = most_likely / stddev;
  if (z > kCertain) return most_likely;
  if (z < -kCertain) return -stddev / z;
  const double density = std::exp(-0.5 * z * z) / std::sqrt(2 * M_PI);
  return most_likely + stddev * density / (0.5 * std::erfc(-z / std::sqrt(2.0)));
}

}  // namespace uav_landing
