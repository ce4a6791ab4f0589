#include "offline/estimate_bag.h"

#include <stdexcept>

#include "conversions.h"
#include "rig_frames.h"

namespace uav_landing {
namespace {

double millisecondsOf(const Timings& stages, const std::string& name) {
  for (const auto& [stage, ms] : stages.parts())
    if (stage == name) return ms;
  return 0;
}

}  // namespace

EstimateBag::EstimateBag(const std::string& path) : pending_(path) {
  try {
    bag_.open(pending_.temporary(), rosbag::bagmode::Write);
  } catch (const rosbag::BagException&) {
    throw std::runtime_error(path + ": cannot be written");
  }
}

void EstimateBag::take(const ProcessedPair& pair) {
  if (pair.unusable) return;
  std_msgs::Header image;
  image.stamp = pair.stamp;
  image.frame_id = pair.left_frame;
  std_msgs::Header runway = image;
  runway.frame_id = "runway";
  const Pipeline::Output& output = pair.output;
  bag_.write("/uav_landing/stereo_depth", pair.stamp,
             toMessage(output.stereo, image, millisecondsOf(output.stages, "stereo_depth")));
  bag_.write("/uav_landing/approach_angle", pair.stamp,
             toMessage(output.approach, image, millisecondsOf(output.stages, "approach_angle")));
  bag_.write(
      "/uav_landing/landing_estimate", pair.stamp,
      toMessage(output.landing, runway, rectifiedFrame(pair.left_frame), pair.skew, output.stages.total()));
}

void EstimateBag::finish() {
  bag_.close();
  pending_.commit();
}

}  // namespace uav_landing
