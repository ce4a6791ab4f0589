#include "landing/height/height_measurement.h"

#include <cmath>

#include "stereo/plane/region_planes.h"

namespace uav_landing {
namespace {

// Other edges within this share of the width may be mistaken for the runway's.
constexpr double kWidthTolerance = 0.02;

/// Weighted mean of the height and the one from a known width, if they agree.
void fuseWidth(const WidthHeight::Estimate& seen, MeasuredHeight& measured) {
  constexpr double kAgreement = 3;  // standard deviations
  const double difference = measured.width_height - measured.height;
  // A height from the width does not depend on the baseline. So the baseline's error is part of the
  // difference.
  const double by_baseline = measured.errors.baselineVariance(measured.height);
  const double sum = seen.variance + measured.variance + by_baseline;
  if (difference * difference > kAgreement * kAgreement * sum) return;
  const double model = measured.errors.modelVariance(measured.height);
  const double own = measured.variance - model + by_baseline;
  const double gain = own / (own + seen.variance), left = 1 - gain;
  measured.height += gain * difference;
  measured.errors.width = gain * gain * seen.common;
  measured.errors.baseline *= left;
  measured.variance = own * seen.variance / (own + seen.variance) + model - left * left * by_baseline;
}

}  // namespace

HeightMeasurement::HeightMeasurement(const StereoRig& rig, const KalmanHeightParameters& parameters,
                                     const RunwayParameters& runway, double baseline_stddev)
    : rig_(rig),
      parameters_(parameters),
      baseline_stddev_(baseline_stddev),
      width_(runway.width, runway.largestInset()),
      stamps_(parameters.max_deceleration) {}

MeasuredHeight HeightMeasurement::propose(const PairInput& in, const Ground& ground,
                                          const MeasuredHeight& by_ground, const HeightPrior& prior) {
  MeasuredHeight measured = by_ground;
  measured.errors.baseline = baseline_stddev_;
  if (!in.repeated()) followStamps(in, prior, measured);
  measured.stereo_height = measured.height;
  measured.stereo_variance = measured.variance;
  if (!in.approach.runway.failure) useWidth(in.approach.runway, ground, prior, measured);
  leaveOutSources(in, ground, measured);
  return measured;
}

void HeightMeasurement::commit(const PairInput& in, const Ground& ground, const MeasuredHeight& measured,
                               bool accepted) {
  if (!measured.teaches_width || !accepted) return;
  const ApproachAngleResult::Runway& runway = in.approach.runway;
  width_.learn(runway.width, runway.width_variance, measured.height - ground.surface.bend, measured.variance);
}

// Adds the change of the height between the stamp and the true time of the images to the variance.
void HeightMeasurement::followStamps(const PairInput& in, const HeightPrior& prior,
                                     MeasuredHeight& measured) {
  const std::optional<CameraStep> way = cameraStep(in.step(), prior.heightOr(measured.height));
  way ? stamps_.follow(*way) : stamps_.skip();
  const double duration = in.step().duration;
  if (!prior.known() || !(duration > 0)) return;
  // A duration contains the errors of two stamps.
  const double stamp_variance = 0.5 * stamps_.ofDuration() * duration * duration;
  measured.variance += std::pow(prior.filter.state()[1], 2) * stamp_variance;
}

// The width gives a second height. It is used when stereo has none or agrees with it.
void HeightMeasurement::useWidth(const ApproachAngleResult::Runway& runway, const Ground& ground,
                                 const HeightPrior& prior, MeasuredHeight& measured) {
  const double bend = ground.surface.bend;
  std::optional<WidthHeight::Estimate> seen = width_.height(runway.width, runway.width_variance);
  const bool by_stereo = !measured.failure && !ground.tilted;
  bool same = true;
  if (seen && prior.known() && prior.confirmed()) {
    // An error of the width itself does not tell whether the edges are still the same.
    const CommonVariance common = prior.filter.commonVariance();
    // A learned width has the error of the baseline, as the heights have.
    const double by_baseline = width_.independent() ? common.baseline : 0;
    same = width_.isSame(runway.width, runway.width_variance, prior.filter.state()[0] - bend,
                         prior.filter.ownCovariance()(0, 0) + common.lasting + common.bend + by_baseline);
  }
  // A known width is still reported, because the heights may be wrong instead.
  if (!same && !width_.independent()) seen.reset();
  if (seen) {
    measured.width_height = seen->height + bend;
    measured.width_height_variance = seen->variance + measured.errors.modelVariance(seen->height);
  }
  measured.teaches_width = by_stereo && prior.confirmed();
  if (!seen || !same || !parameters_.fuse_width_height) return;
  // If the ground was rejected for its tilt, the width was seen on the same ground.
  if (!by_stereo && !ground.tilted && prior.confirmed()) {
    measured.failure = {};
    measured.height = measured.width_height;
    measured.variance = measured.width_height_variance;
    measured.errors.width = seen->common;
    if (width_.independent()) measured.errors.baseline = 0;
    measured.by_width = true;
  } else if (by_stereo && width_.independent()) {
    fuseWidth(*seen, measured);
  }
}

void HeightMeasurement::leaveOutSources(const PairInput& in, const Ground& ground,
                                        MeasuredHeight& measured) const {
  if (!parameters_.integrity_monitor || measured.failure || ground.tilted) return;
  SolutionSeparation::Measurement everything{measured.height, measured.variance, measured.common()};
  // A height from the width does not use the stereo images, but it depends on which edges were seen.
  if (measured.by_width) everything.common.width += std::pow(kWidthTolerance * measured.height / 3, 2);
  measured.without.fill(everything);
  if (measured.by_width || !ground.plane.valid()) return;

  SolutionSeparation::Measurement& stereo_alone =
      measured.without[static_cast<int>(FaultySource::kVanishingPoint)];
  stereo_alone.height = measured.stereo_height + ground.alone.height() - ground.plane.height();
  stereo_alone.variance = ground.alone.heightVariance() + measured.errors.modelVariance(measured.height);
  stereo_alone.common = measured.common();
  stereo_alone.common.width = 0;
  stereo_alone.common.baseline = std::pow(baseline_stddev_ * stereo_alone.height, 2);
  stereo_alone.common.lasting +=
      GroundPlane{ground.alone.g, ground.alone_common}.heightVariance() - ground.rig_variance;
  // The remaining plane was not turned by the motion's normal either.
  if (parameters_.fuse_motion_normal)
    measured.without[static_cast<int>(FaultySource::kMotion)] = stereo_alone;
  leaveOutRegions(in, ground, measured);
}

void HeightMeasurement::leaveOutRegions(const PairInput& in, const Ground& ground,
                                        MeasuredHeight& measured) const {
  const std::optional<PlaneVector> plane = PlaneVector::of(in.stereo.plane.g);
  if (!plane || in.stereo.points.empty()) return;
  const ApproachAngleResult& approach = in.approach;
  const RegionPlanes regions = planesWithoutRegions(rig_, in.stereo.points, *plane);
  std::optional<GroundDirection> vanishing;
  if (parameters_.fuse_vanishing_point)
    vanishing = GroundDirection::of(approach.vanishing_direction, approach.vanishing_covariance);
  const auto withVanishingPoint = [&](const GroundPlane& plane) {
    if (!vanishing) return plane;
    return fuseDirection(plane, *vanishing, std::pow(parameters_.vanishing_point_gate, 2), nullptr);
  };
  const double base = withVanishingPoint(ground.alone).height();
  for (int i = 0; i < kImageRegions; ++i) {
    SolutionSeparation::Measurement& measurement =
        measured.without[static_cast<int>(faultySource(static_cast<ImageRegion>(i)))];
    const GroundPlane& fitted = regions.without[i];
    if (!fitted.valid()) {
      measurement = {};
      continue;
    }
    const GroundPlane plane = withVanishingPoint(
        {ground.alone.g + fitted.g - regions.all.g, fitted.covariance + ground.alone_common});
    measurement.height = measured.height + plane.height() - base;
    measurement.variance = plane.heightVariance() + measured.errors.modelVariance(measurement.height);
    measurement.common = measured.errors.common(measurement.height);
  }
}

}  // namespace uav_landing
