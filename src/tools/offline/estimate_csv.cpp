#include "offline/estimate_csv.h"

#include <cmath>
#include <stdexcept>

#include "csv_row.h"
#include "datasets/decimal_time.h"

namespace uav_landing {
namespace {

constexpr double kDegrees = 180 / M_PI;

const char* const kHeader =
    "stamp_s,valid,height_m,height_stddev_m,raw_height_m,vertical_speed_m_s,approach_angle_deg,"
    "approach_angle_stddev_deg,pitch_deg,roll_deg,yaw_deg,x_m,y_m,foe_u_px,foe_v_px,status,compute_ms,"
    "height_valid,angle_valid,raw_approach_angle_deg,height_protection_level_m,reason,x_stddev_m,y_stddev_m,"
    "runway_width_m,width_height_m,width_height_stddev_m,rig_rx_deg,rig_ry_deg,rig_rz_deg,rig_rx_stddev_deg,"
    "rig_ry_stddev_deg,rig_rz_stddev_deg,height_alert_limit_m,protection_source,failed_tests,"
    "height_above_runway_m,height_above_runway_stddev_m,speed_m_s,speed_stddev_m_s,yaw_stddev_deg,yaw_known,"
    "yaw_reason,other_runway_probability,estimated_readout_time_s,estimated_readout_time_stddev_s,"
    "height_above_runway_known,height_above_runway_protection_level_m,height_above_runway_limit_m,"
    "height_origin,runway_reason,y_protection_level_m";

}  // namespace

EstimateCsv::EstimateCsv(const std::string& path) : pending_(path), file_(pending_.temporary()) {
  if (!file_) throw std::runtime_error(path + ": cannot be written");
  file_ << kHeader << '\n';
}

void EstimateCsv::take(const ProcessedPair& pair) {
  const LandingResult& landing = pair.output.landing;
  CsvRow row(file_);
  row.text(toDecimal(pair.stamp)).flag(landing.valid());
  row.number(landing.height).number(std::sqrt(landing.height_variance)).number(landing.raw_height);
  row.number(landing.vertical_speed);
  row.number(landing.approach_angle * kDegrees).number(std::sqrt(landing.approach_angle_variance) * kDegrees);
  row.number(landing.pitch * kDegrees).number(landing.roll * kDegrees).number(landing.yaw * kDegrees);
  row.number(landing.x).number(landing.y);
  row.number(landing.foe.x()).number(landing.foe.y());
  row.text(toString(landing.status)).number(pair.output.stages.total());
  row.flag(landing.height_valid).flag(landing.angle_valid);
  row.number(landing.raw_approach_angle * kDegrees);
  row.number(landing.height_protection_level);
  row.text(toString(landing.failure.reason));
  row.number(std::sqrt(landing.x_variance)).number(std::sqrt(landing.y_variance));
  row.number(landing.runway_width);
  row.number(landing.width_height).number(std::sqrt(landing.width_height_variance));
  for (int i = 0; i < 3; ++i) row.number(landing.rig_rotation.w[i] * kDegrees);
  for (int i = 0; i < 3; ++i) row.number(std::sqrt(landing.rig_rotation.covariance(i, i)) * kDegrees);
  row.number(landing.height_alert_limit).text(landing.protection_source).text(failedTests(landing.tests));
  row.number(landing.height_above_runway).number(std::sqrt(landing.height_above_runway_variance));
  row.number(landing.speed()).number(std::sqrt(landing.speedVariance()));
  row.number(std::sqrt(landing.yaw_variance) * kDegrees).flag(std::isfinite(landing.yaw));
  row.text(toString(landing.yaw_failure.reason)).number(landing.other_runway_probability);
  const ReadoutEstimate& readout = pair.output.approach.readout;
  const bool estimated = readout.known();
  row.number(estimated ? readout.time : kUnknown).number(estimated ? std::sqrt(readout.variance) : kUnknown);
  row.flag(landing.height_above_runway_known);
  row.number(landing.height_above_runway_protection_level).number(landing.height_above_runway_limit);
  row.text(toString(landing.height_origin)).text(toString(landing.runway_failure.reason));
  row.number(landing.y_protection_level);
  file_ << '\n';
}

void EstimateCsv::finish() {
  file_.close();
  if (!file_) throw std::runtime_error(pending_.path() + ": could not be written completely");
  pending_.commit();
}

}  // namespace uav_landing
