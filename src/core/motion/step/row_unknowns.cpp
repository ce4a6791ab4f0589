#include "motion/step/row_unknowns.h"

#include <algorithm>

namespace uav_landing {
namespace {

constexpr double kApart = 1e-3;  // s, difference of readout times for the derivatives

/// The same matches with a readout time that is longer by kApart, linearised at the same state.
const MotionRows& laterRows(const StereoRig& rig, const std::vector<TemporalMatch>& matches,
                            const MotionState& state, MotionMemory& memory) {
  memory.shifted = matches;
  for (TemporalMatch& match : memory.shifted) match.then += kApart * match.by_readout;
  MotionRows& later = memory.drawn;
  later.assign(rig, memory.shifted);
  later.linearise(state);
  return later;
}

SumsByTime sumsByReadout(const MotionRows& rows, const MotionRows& later, const Vector9d& step,
                         double factor) {
  SumsByTime sums = rows.sumsByTime(later, kApart, step);
  sums.with_motion /= factor;
  sums.information /= factor;
  sums.right /= factor;
  return sums;
}

std::vector<RowNode> rowNodes(const RowTimes& times, const std::vector<TemporalMatch>& matches,
                              const FittedRows& fitted, const MotionRows* later) {
  std::vector<double> shares;
  shares.reserve(matches.size());
  for (const TemporalMatch& match : matches)
    shares.push_back(times.at(match.now.x(), match.now.y()) / times.readoutTime());
  std::vector<RowNode> nodes = fitted.rows.rowNodes(shares, fitted.step, later, kApart);
  for (RowNode& node : nodes) {
    node.rotation /= fitted.factor;
    node.with_next /= fitted.factor;
    node.with_motion /= fitted.factor;
    node.with_time /= fitted.factor;
    node.score /= fitted.factor;
    node.squares /= fitted.factor;
  }
  return nodes;
}

TimeUnknown timeUnknown(const SumsByTime& by_time) {
  constexpr double kAnyReadout = 0.02;  // s
  return {by_time.with_motion, by_time.information + 1 / (kAnyReadout * kAnyReadout), by_time.right};
}

}  // namespace

RowUnknowns findRowUnknowns(const StereoRig& rig, const std::vector<TemporalMatch>& matches,
                            const FittedRows& fitted, const RowDoubt& doubt, MotionMemory& memory) {
  RowUnknowns found;
  found.has_time = std::any_of(matches.begin(), matches.end(),
                               [](const TemporalMatch& match) { return !match.by_readout.isZero(0); });
  const MotionRows* later = found.has_time ? &laterRows(rig, matches, fitted.linearised, memory) : nullptr;
  SumsByTime& by_time = found.by_time;
  if (later != nullptr) by_time = sumsByReadout(fitted.rows, *later, fitted.step, fitted.factor);
  if (doubt.shake.rows == nullptr || doubt.shake.memory == nullptr) return found;
  found.shake =
      findRowShake(rowNodes(*doubt.shake.rows, matches, fitted, later), fitted.motion,
                   later != nullptr ? timeUnknown(by_time) : TimeUnknown(), doubt.shake, memory.shapes);
  if (!found.shake.found()) return found;
  by_time.right -= by_time.with_motion.dot(found.shake.step) + found.shake.time_right;
  by_time.with_motion -= found.shake.time_with_motion;
  by_time.information -= found.shake.time_information;
  return found;
}

}  // namespace uav_landing
