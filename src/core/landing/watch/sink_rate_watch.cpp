#include "landing/watch/sink_rate_watch.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "height/vertical_speed.h"

namespace uav_landing {

Failure SinkRateWatch::check(const PairInput& in, const Ground& ground, const Published& published,
                             const MotionDoubt& doubt, PairTests& tests) {
  const std::optional<HeightMemory::Expected> before = memory_.expected();
  const HeightFilter& filter = published.filter;
  const double scale = before ? before->height : filter.initialised() ? filter.state()[0] : kUnknown;
  // While normals contradict each other, the vertical part of the motion is not known.
  carry(in, ground, scale, doubt, !tests.failed(IntegrityTest::kTilt));
  const std::optional<HeightMemory::Expected> expected = memory_.expected();
  if (expected && filter.initialised())
    tests.add(
        IntegrityTest::kSinkRate, filter.state()[0] - expected->height,
        expected->variance + filter.ownCovariance()(0, 0) + published.errors.modelVariance(expected->height));
  const bool agrees = !tests.failed(IntegrityTest::kSinkRate);
  memory_.refresh(filter, agrees,
                  std::max(parameters_.alert_limit, parameters_.alert_limit_relative * scale));
  if (agrees) return {};
  return {Reason::kInconsistent, text(toString(IntegrityTest::kSinkRate), ": the height differs by ",
                                      rounded(filter.state()[0] - expected->height),
                                      " m from the earlier height carried on by the motion")};
}

void SinkRateWatch::carry(const PairInput& in, const Ground& ground, double scale, const MotionDoubt& doubt,
                          bool level_known) {
  VerticalSpeed speed;
  double velocity = kUnknown;
  const std::optional<GroundNormal> normal = ground.normalOr(in.normal());
  if (!in.step().failure && level_known && normal && std::isfinite(scale) && scale > 0) {
    const GroundPlane plane{normal->vector() / scale, Eigen::Matrix3d::Zero()};
    speed = withDurations(verticalSpeed(in.step(), plane, scale, {0, 0, parameters_.acceleration_stddev}),
                          doubt.duration_variance);
    velocity = in.step().translation_over_height.norm() * scale / in.step().duration;
    // A doubtful normal makes the vertical speed as wrong as the angle.
    speed.variance += velocity * velocity * doubt.angle_variance;
  }
  if (in.T > 0) memory_.carry(in.T, speed.speed, speed.variance, velocity);
}

}  // namespace uav_landing
