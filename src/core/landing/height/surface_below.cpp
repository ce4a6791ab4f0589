#include "landing/height/surface_below.h"

#include <algorithm>
#include <cmath>

#include "estimation/aircraft.h"
#include "geometry/rotation.h"

namespace uav_landing {
namespace {

// 1 sigma of pitch and roll since the previous pair when only the ground's normals give them, rad.
constexpr double kTurnByNormals = 0.1 * M_PI / 180;
// 1 sigma of the difference between the step's climb and the height's change, as a share of the step's
// length. The ground slopes.
constexpr double kSlope = 0.05;

/// Whether the step gives the rotation. A camera that hardly moves may still turn, but then nothing confirms
/// an unusual turn.
bool knowsTurn(const ApproachAngleResult::Motion& step, double T) {
  return step.rotation.allFinite() &&
         (!step.failure || step.rotation.norm() <= aircraft::kUnusualTurnRate * T);
}

}  // namespace

/// The step from the previous pair to this one.
struct SurfaceBelow::Step {
  double T;       // s
  double height;  // above the plane ahead, which the motion refers to, m
  bool turn_known;
  Eigen::Matrix3d R;  // rotation, as far as it is known
  bool believed;      // whether the pair's normal is believed
  std::optional<Eigen::Vector3d> normal_before;
  const HeightFilter& flight;
};

void SurfaceBelow::follow(const PairInput& in, const Ground& ground, const MeasuredHeight& measured,
                          bool left_out, const TrackVerdict& post) {
  if (in.repeated()) return memory_.wait();
  height_ = post.filter.initialised() ? post.filter.state()[0] : measured.height;
  const double T = stamp_ ? in.stamp() - *stamp_ : 0;
  stamp_ = in.stamp();
  const bool believed = !left_out && !post.rejection && ground.normal && ground.attitude_settled;
  const bool turn_known = knowsTurn(in.step(), T);
  const Eigen::Matrix3d R = turn_known ? rotationMatrix(in.step().rotation) : Eigen::Matrix3d::Identity();
  const Step step{T, height_ - ground.surface.bend, turn_known, R, believed, last_normal_, post.filter};
  if (believed)
    last_normal_ = ground.normal->vector();
  else if (last_normal_)
    last_normal_ = R * *last_normal_;
  carry(in, ground, step);
  if (!believed || measured.failure || measured.by_width) return;
  const GroundPlane plane{ground.normal->vector() / ground.plane.height(), ground.plane.covariance};
  memory_.look(rig_, in.stereo.points, plane, PlaneVector(in.stereo.plane.g));
}

void SurfaceBelow::carry(const PairInput& in, const Ground& ground, const Step& step) {
  if (step.T > 0 && step.turn_known && !ground.turn_doubted && agreesWithFlight(in.step(), step)) {
    if (step.believed) memory_.settleTurn(step.R.transpose() * *last_normal_, kTurnByNormals);
    memory_.move(step.R, step.height * in.step().translation_over_height, step.T);
    return;
  }
  const bool doubted = step.turn_known && ground.turn_doubted;
  const double turn_stddev = doubted ? in.step().rotation.norm() : aircraft::kTurnRate * step.T;
  memory_.coast(doubted ? step.R : Eigen::Matrix3d::Identity(), turn_stddev, step.T, step.normal_before,
                doubted);
  if (step.believed) memory_.settleTurn(*last_normal_, kTurnByNormals);
}

// Whether a motion can be the camera's way since the previous pair. A single wrong step would lift all
// remembered ground.
bool SurfaceBelow::agreesWithFlight(const ApproachAngleResult::Motion& motion, const Step& step) const {
  const Eigen::Vector3d& t = motion.translation_over_height;
  const double T = step.T, height = step.height;
  if (!t.allFinite() || !(height > 0)) return false;
  if (!(std::abs(T - motion.duration) <= AttitudeFilter::kStampRounding)) return false;
  if (!step.flight.initialised() || !last_normal_) return true;
  const Eigen::Vector3d& n = *last_normal_;
  const Eigen::Matrix3d covariance = motion.covariance.bottomRightCorner<3, 3>();
  const double off = height * n.dot(t) + T * step.flight.state()[1];
  const double flight_variance =
      std::pow(kSlope, 2) * t.squaredNorm() + T * T * step.flight.covariance()(1, 1) / (height * height);
  // An uncertain step must not carry the ground. So its variance does not widen the gate beyond that of the
  // flight so far.
  const double own_variance = std::min(n.dot(covariance * n), flight_variance);
  const double variance = height * height * (own_variance + flight_variance);
  return off * off <= std::pow(gate_, 2) * variance;
}

std::optional<Eigen::Vector3d> SurfaceBelow::normal(const PairInput& in, const Ground& ground) const {
  const std::optional<GroundNormal> seen = ground.normalOr(in.normal());
  return seen ? seen->vector() : last_normal_;
}

std::optional<GroundMemory::Below> SurfaceBelow::below(double height, const Eigen::Vector3d& normal) const {
  std::optional<GroundMemory::Below> below = memory_.below(normal);
  // The remembered ground refers to the last pair without a repeated image, so the change of height since
  // then is added.
  if (below && std::isfinite(height_)) below->height += height - height_;
  return below;
}

}  // namespace uav_landing
