#include "motion/step/readout_shift.h"

namespace uav_landing {
namespace {

constexpr double kApart = 1e-3;  // s, readout time for the difference quotients

// With a readout of 1 s, a camera that moves kApart times as fast has the same shifts as one with a readout
// of kApart at full speed. What its acceleration adds is in proportion to the square of the readout
// time. There is no inertial sensor within images whose readout time is estimated.
RowMotion slowed(const RowMotion& motion, double time) {
  return {kApart * motion.w, kApart * motion.v, kApart * time * motion.a};
}

}  // namespace

void shiftByReadout(const StereoRig& rig, const MotionOverGround& over_ground, double time,
                    std::vector<TemporalMatch>& matches) {
  const auto& [motion, normal, unit] = over_ground;
  if (unit.times == nullptr || unit.times->atOnce()) return;
  const StampMap now(rig.K(), *unit.times, slowed(unit.now, time), normal);
  const StampMap then(rig.K(), *unit.times, slowed(unit.then, time), motion.R.transpose() * normal);
  const double height_then = 1 + normal.dot(motion.t);
  for (TemporalMatch& match : matches) {
    match.then -= time * match.by_readout;
    const Eigen::Vector3d ray = rig.ray(match.now.x(), match.now.y());
    const double depth = match.on_plane ? normal.dot(ray) : match.inverse_depth;
    const double depth_then = height_then * depth / motion.seenThen(ray, depth).z();
    const Eigen::Vector2d off_now = now.toStamp(match.now, depth) - match.now;
    const Eigen::Vector2d off_then = then.toStamp(match.then, depth_then) - match.then;
    match.by_readout = (off_then - match.warp * off_now) / kApart;
    match.then += time * match.by_readout;
  }
}

}  // namespace uav_landing
