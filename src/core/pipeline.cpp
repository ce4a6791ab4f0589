#include "uav_landing/pipeline.h"

#include "uav_landing/geometry/rig_check.h"

namespace uav_landing {
Expected<Pipeline> Pipeline::create(const CameraCalibration& left, const CameraCalibration& right,
                                    const Parameters& parameters) {
  const Expected<StereoRig> checked = makeStereoRig(left, right, parameters.rig);
  if (!checked) return tl::unexpected<Failure>(checked.error());
  const Expected<RigMasks> masks = loadRigMasks(parameters.rig);
  if (!masks) return tl::unexpected<Failure>(masks.error());
  Expected<RigModel> rig = makeRigModel(left, right, *masks, parameters.rig);
  if (!rig) return tl::unexpected<Failure>(rig.error());
  Expected<Rectifier> left_rectifier = Rectifier::create(left);
  if (!left_rectifier) return tl::unexpected<Failure>(left_rectifier.error());
  Expected<Rectifier> right_rectifier = Rectifier::create(right);
  if (!right_rectifier) return tl::unexpected<Failure>(right_rectifier.error());
  Pipeline pipeline(std::move(*rig), std::move(*left_rectifier), std::move(*right_rectifier), parameters);
  pipeline.warnings_ = rigWarnings(left, right, parameters.rig);
  return pipeline;
}

Pipeline::Pipeline(RigModel rig, Rectifier left, Rectifier right, const Parameters& parameters)
    : rig_(std::move(rig)),
      left_rectifier_(std::move(left)),
      right_rectifier_(std::move(right)),
      stereo_(rig_, parameters.stereo_depth),
      approach_(rig_, parameters.approach_angle, parameters.runway),
      kalman_(rig_.rig, parameters.kalman_height, parameters.runway) {}

const Pipeline::Output& Pipeline::process(double stamp, const cv::Mat& left, const cv::Mat& right,
                                          double skew, const AttitudePrior& imu) {
  output_.parts.clear();
  output_.stages.clear();
  if (const Failure failure = rectify(left, right)) {
    output_.stereo = {};
    output_.stereo.stamp = stamp;
    output_.stereo.failure = failure;
    output_.stereo.skew = skew;
    output_.approach = {};
    output_.approach.stamp = stamp;
    output_.approach.failure = failure;
  } else {
    output_.stereo = stereo_.process(stamp, output_.left, output_.right, skew);
    addTimings("stereo_depth", stereo_.timings());
    output_.approach = approach_.process(stamp, output_.left, output_.right, output_.stereo, imu);
    addTimings("approach_angle", approach_.timings());
  }
  output_.landing = kalman_.process(output_.stereo, output_.approach);
  addTimings("kalman_height", kalman_.timings());
  return output_;
}

Failure Pipeline::rectify(const cv::Mat& left, const cv::Mat& right) {
  Timings timings;
  Failure failure;
  {
    const ScopedTimer timer(timings, "rectify");
    failure = left_rectifier_.rectify(left, output_.left);
    if (failure) {
      failure.detail = "left " + failure.detail;
    } else if ((failure = right_rectifier_.rectify(right, output_.right))) {
      failure.detail = "right " + failure.detail;
    }
  }
  addTimings("rectify", timings);
  return failure;
}

void Pipeline::addTimings(const char* stage, const Timings& parts) {
  for (const auto& [part, ms] : parts.parts()) output_.parts.add(part.c_str(), ms);
  output_.stages.add(stage, parts.total());
}

}  // namespace uav_landing
