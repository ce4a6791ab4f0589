#include "far/outline_pose.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;
constexpr int kIterations = 12;
constexpr double kSettled = 1e-4;        // of a standard deviation
constexpr double kLevel = 10 * kDegree;  // 1 sigma of roll and pitch of a camera that flies an approach
constexpr double kUsualWidth = 35, kUsualLength = 1800;  // m
constexpr double kAnySize = 0.8;  // 1 sigma of the logarithm of a size that is not known
// Chart, horizon and stereo are six equations too many, so a misfit of some 6 is usual. Where it is larger,
// one of them is wrong, and errors are larger than they say (Birge 1932). A little less is on the safe side.
constexpr double kUsualMisfit = 5;
constexpr double kDoubtedChart = 3;   // standard deviations from which on a size counts less and less
constexpr double kHills = 0.01;       // of the distance: 1 sigma of the threshold off the plane before it
constexpr double kLargestStep = 0.3;  // of a distance, in one iteration

using State = Vector8d;  // position, roll, pitch, yaw, logarithms of width and length

RunwayPose poseOf(const State& s) { return {s.head<3>(), s[3], s[4], s[5]}; }
RunwaySize sizeOf(const State& s) { return {std::exp(s[6]), std::exp(s[7])}; }

tl::unexpected<Failure> noPose(const char* why) {
  return tl::make_unexpected(Failure{Reason::kNoRunway, why});
}

double stepOf(const State& state, int i) { return i < 3 ? 1e-5 * std::abs(state[0]) : 1e-6; }

/// A number that a state tells, with its derivative.
struct Told {
  double value;
  State slope;

  template <class At>
  Told(const State& state, const At& at) : value(at(state)) {
    for (int i = 0; i < 8; ++i) {
      State moved = state;
      const double step = stepOf(state, i);
      moved[i] += step;
      slope[i] = (at(moved) - value) / step;
    }
  }
};

/// The threshold T against a plane: g . T, which is 1 where it lies on it.
struct OnPlane : Told {
  double variance;  // of the value, by the plane and by hills

  OnPlane(const State& state, const GroundPlane& plane)
      : Told(state, [&](const State& s) { return plane.g.dot(poseOf(s).seen(Eigen::Vector3d::Zero())); }) {
    const Eigen::Vector3d threshold = poseOf(state).seen(Eigen::Vector3d::Zero());
    const double hills = kHills * threshold.norm() * plane.g.norm();
    variance = threshold.dot(plane.covariance * threshold) + hills * hills;
  }
};

/// Normal equations of the state, and the sum of the normalised squares.
struct Equations {
  Matrix8d information = Matrix8d::Zero();
  State gradient = State::Zero();
  double misfit = 0;

  void add(const State& slope, double missing, double variance) {
    misfit += missing * missing / variance;
    information += slope * slope.transpose() / variance;
    gradient += slope * missing / variance;
  }
  /// Of a component of the state itself.
  void addDirectly(int i, double missing, double stddev) { add(State::Unit(i), missing, stddev * stddev); }
};

/// What outline and knowledge say about a state.
class Fit {
 public:
  Fit(const SeenOutline& seen, const PoseKnowledge& known, const StereoRig& rig, const PoseElements& elements)
      : seen_(seen), known_(known), rig_(rig), elements_(elements), weight_(seen.covariance.inverse()) {}

  bool hasWidth() const { return elements_.width && known_.chart.width > 0; }
  bool hasLength() const { return elements_.length && known_.chart.length > 0; }
  bool hasPlane() const { return elements_.stereo && known_.plane.valid(); }
  bool hasNormal() const { return elements_.normal && known_.normal; }
  bool hasDisparity() const { return known_.disparity.has_value(); }

  std::optional<State> start() const {
    const Corners c = movedBy(seen_.reference, seen_.inward);
    const Eigen::Vector2d near = 0.5 * (c[0] + c[3]), far = 0.5 * (c[1] + c[2]);
    const double near_width = (c[3] - c[0]).norm(), far_width = (c[2] - c[1]).norm();
    const double taper = far_width / near_width, rise = near.y() - far.y();
    if (!(taper > 0.01 && taper < 0.99 && rise > 0)) return std::nullopt;
    RunwaySize size;
    if (hasWidth()) size.width = known_.chart.width;
    if (hasLength()) size.length = known_.chart.length;
    if (!hasWidth() && hasLength()) size.width = near_width * size.length * taper / (1 - taper) / rig_.fx;
    if (!hasWidth() && !hasLength()) {
      const std::optional<double> inverse_depth = inverseDepthAt(near);
      if (!inverse_depth || !(*inverse_depth > 0)) return std::nullopt;
      size.width = near_width / rig_.fx / *inverse_depth;
    }
    const double distance = rig_.fx * size.width / near_width;
    if (!hasLength()) size.length = distance * (1 - taper) / taper;
    const double beyond = distance + size.length;
    const double height = rise * distance * beyond / (rig_.fy * size.length);
    const double right = (near.x() - rig_.cx) / rig_.fx * distance;
    const double yaw = ((far.x() - rig_.cx) / rig_.fx * beyond - right) / size.length;
    const double pitch = std::atan((near.y() - rig_.cy) / rig_.fy) - std::atan(height / distance);
    State state;
    state << -distance, right - yaw * distance, height, 0, pitch, yaw, std::log(size.width),
        std::log(size.length);
    if (known_.normal) state[3] = rollOf(known_.normal->vector());
    if (hasNormal()) state[4] = pitchOf(known_.normal->vector());
    return state;
  }

  /// The equations at a state; none where the surface is not ahead.
  std::optional<Equations> linearise(const State& state) const {
    const auto corners = cornersOf(poseOf(state), sizeOf(state), rig_);
    if (!corners) return std::nullopt;
    const Vector8d missing = seen_.inward - movedInward(seen_.reference, *corners);
    Matrix8d slopes;
    for (int i = 0; i < 8; ++i) {
      State moved = state;
      const double step = stepOf(state, i);
      moved[i] += step;
      const auto there = cornersOf(poseOf(moved), sizeOf(moved), rig_);
      if (!there) return std::nullopt;
      slopes.col(i) = (seen_.inward - movedInward(seen_.reference, *there) - missing) / -step;
    }
    Equations equations;
    equations.information = slopes.transpose() * weight_ * slopes;
    equations.gradient = slopes.transpose() * weight_ * missing;
    equations.misfit = missing.dot(weight_ * missing);
    addKnowledge(state, equations);
    if (!equations.information.allFinite()) return std::nullopt;
    return equations;
  }

  /// Sets by how much the height follows what is known. Needs the covariance.
  void addInfluences(const State& state, OutlinePose& result) const {
    const auto bySize = [&](int i, const SizePrior& prior) {
      return result.covariance(2, i) / (prior.stddev * prior.stddev);
    };
    if (hasWidth()) result.height_by_width = bySize(6, widthPrior(state));
    if (hasLength()) result.height_by_length = bySize(7, lengthPrior(state));
    if (!hasDisparity()) return;
    const State gain = result.covariance * expectedDisparity(state).slope / known_.disparity->totalVariance();
    result.height_by_disparity = gain[2];
  }

 private:
  /// What is known of the logarithm of a size: by how much it is missed, and 1 sigma.
  struct SizePrior {
    double missing, stddev;
  };
  SizePrior widthPrior(const State& state) const {
    if (!hasWidth()) return {std::log(kUsualWidth) - state[6], kAnySize};
    return byChart(known_.chart.width, known_.width_stddev, state[6]);
  }
  SizePrior lengthPrior(const State& state) const {
    if (!hasLength()) return {std::log(kUsualLength) - state[7], kAnySize};
    return byChart(known_.chart.length, known_.length_stddev, state[7]);
  }
  // A chart may be wrong, and what shows may be paint within the edges. Stereo can tell.
  SizePrior byChart(double chart, double stddev, double logarithm) const {
    const double missing = std::log(chart) - logarithm, known = stddev / chart;
    const double far = hasDisparity() ? missing / (kDoubtedChart * known) : 0;
    return {missing, known * std::sqrt(1 + far * far)};
  }

  /// Of the threshold, by stereo.
  std::optional<double> inverseDepthAt(const Eigen::Vector2d& near) const {
    if (hasPlane()) return known_.plane.inverseDepth(rig_.ray(near.x(), near.y()));
    if (hasDisparity()) return known_.disparity->value / rig_.fb();
    return std::nullopt;
  }

  void addKnowledge(const State& state, Equations& equations) const {
    const SizePrior width = widthPrior(state), length = lengthPrior(state);
    equations.addDirectly(6, width.missing, width.stddev);
    equations.addDirectly(7, length.missing, length.stddev);
    equations.addDirectly(3, -state[3], kLevel);
    equations.addDirectly(4, -state[4], kLevel);
    if (hasNormal()) addNormal(state, equations);
    if (hasPlane()) addPlane(state, equations);
    if (hasDisparity()) addDisparity(state, equations);
  }

  void addNormal(const State& state, Equations& equations) const {
    const double roll = state[3], pitch = state[4];
    Eigen::Matrix<double, 3, 2> tips;  // derivatives of the normal by roll and pitch
    tips << std::cos(roll) * std::cos(pitch), -std::sin(roll) * std::sin(pitch),
        -std::sin(roll) * std::cos(pitch), -std::cos(roll) * std::sin(pitch), 0, -std::cos(pitch);
    const Eigen::Matrix2d scale = (tips.transpose() * tips).inverse();
    const Eigen::Matrix<double, 2, 3> angles = scale * tips.transpose();
    const Eigen::Matrix2d weight =
        Eigen::Matrix2d(angles * known_.normal->covariance() * angles.transpose()).inverse();
    const Eigen::Vector2d missing = angles * (known_.normal->vector() - normalFromPitchRoll(pitch, roll));
    equations.information.block<2, 2>(3, 3) += weight;
    equations.gradient.segment<2>(3) += weight * missing;
    equations.misfit += missing.dot(weight * missing);
  }

  void addPlane(const State& state, Equations& equations) const {
    const OnPlane threshold(state, known_.plane);
    equations.add(threshold.slope, 1 - threshold.value, threshold.variance);
  }

  Told expectedDisparity(const State& state) const {
    const Eigen::Vector2d& pixel = known_.disparity->pixel;
    return {state, [&](const State& s) { return planeOf(poseOf(s)).disparity(rig_, pixel.x(), pixel.y()); }};
  }

  void addDisparity(const State& state, Equations& equations) const {
    const Told expected = expectedDisparity(state);
    equations.add(expected.slope, known_.disparity->value - expected.value,
                  known_.disparity->totalVariance());
  }

  const SeenOutline& seen_;
  const PoseKnowledge& known_;
  const StereoRig& rig_;
  PoseElements elements_;
  Matrix8d weight_;
};

}  // namespace

Expected<OutlinePose> fitPose(const SeenOutline& seen, const PoseKnowledge& known, const StereoRig& rig,
                              const PoseElements& elements) {
  const Fit fit(seen, known, rig, elements);
  if (!fit.hasWidth() && !fit.hasLength() && !fit.hasPlane() && !fit.hasDisparity())
    return noPose("nothing tells the runway's scale");
  std::optional<State> state = fit.start();
  if (!state) return noPose("the outline is not that of a surface ahead");
  OutlinePose result;
  std::optional<Equations> equations;
  for (int i = 0; i < kIterations; ++i) {
    equations = fit.linearise(*state);
    if (!equations) return noPose("the outline is not that of a surface ahead");
    const State step = equations->information.ldlt().solve(equations->gradient);
    const double most = kLargestStep * std::abs((*state)[0]);
    const double share = std::max({step.head<3>().cwiseAbs().maxCoeff() / most,
                                   step.tail<5>().cwiseAbs().maxCoeff() / kLargestStep, 1.0});
    *state += step / share;
    if (step.dot(equations->information * step) < kSettled * kSettled) break;
  }
  result.pose = poseOf(*state);
  result.size = sizeOf(*state);
  result.covariance = equations->information.inverse();
  result.misfit = equations->misfit;
  fit.addInfluences(*state, result);
  if (fit.hasDisparity()) result.covariance *= std::max(1.0, result.misfit / kUsualMisfit);
  const bool possible = state->allFinite() && result.covariance.allFinite() && result.pose.position.z() > 0 &&
                        result.pose.position.x() < 0;
  if (!possible) return noPose("the outline is not that of a surface ahead");
  return result;
}

double offPlane(const OutlinePose& found, const GroundPlane& plane) {
  const RunwayPose& pose = found.pose;
  State state;
  state << pose.position, pose.roll, pose.pitch, pose.yaw, std::log(found.size.width),
      std::log(found.size.length);
  const OnPlane threshold(state, plane);
  const double variance = threshold.variance + threshold.slope.dot(found.covariance * threshold.slope);
  return (1 - threshold.value) / std::sqrt(variance);
}

}  // namespace uav_landing
